"""The cases page: every episode of every run, filtered by one line, gathered into sets."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

from app.pages.index import curation
from app.pages.index.finding import Case, Found
from app.pages.index.query import SORTS, Query, term, terms, toggled
from app.pages.library import Library
from app.pages.page import framed
from c2nav_engine.errors import InputError
from c2nav_engine.experiments.tags.endings import RULES as ENDING_RULES
from c2nav_engine.experiments.tags.endings import Ending
from c2nav_engine.experiments.tags.rules import TAGS

_COLUMNS = (("run", "run"), ("variant", "variant"), ("ranker", "ranker"), ("scene_id", "scene"))


@dataclass(frozen=True, slots=True)
class Facet:
    """One term that a click adds to the line, or takes out of it.

    Attributes:
        words: What it is called.
        rule: What it means; "" where the words say it.
        count: Episodes that it would leave; None where that is not counted.
        unknown: Of how many it cannot be told.
        query: The line after a click.
        on: Whether the line has it.
    """

    words: str
    rule: str
    count: int | None
    unknown: int
    query: str
    on: bool


def cases_page(library: Library, query: Query, *, page: int = 1, menu: Sequence[str]) -> str:
    """The page; a line that is not understood is said on it, above all episodes."""
    problem = ""
    try:
        found = library.finder.find(query, page=page)
    except InputError as error:
        problem = str(error)
        found = library.finder.find(Query())
    store = library.store
    chosen = next(
        (each for each in curation.sets(store) if f"set:{each.name}" in _named(query)), None
    )
    return framed(
        "cases.html.j2",
        here="cases",
        menu=menu,
        query=query,
        problem=problem,
        found=found,
        groups=[group for group in _groups(library, query, found) if group[1]],
        views=curation.views(store),
        sets=curation.sets(store),
        chosen=chosen,
        captions=_captions(library, chosen.name) if chosen else {},
        marks=[tag for tag, _ in curation.marks(store)],
        sorts=SORTS,
        unread=library.progress,
        looked=library.looked,
        entry=partial(_entry, library),
    )


def _groups(library: Library, query: Query, found: Found) -> Iterator[tuple[str, list[Facet]]]:
    """Headings with their facets."""
    counts = found.counts
    yield (
        "Ending",
        [
            _facet(
                query,
                term("ending", e.value),
                e.value,
                rule=ENDING_RULES[e],
                count=counts.endings[e],
            )
            for e in Ending
            if counts.endings[e] or term("ending", e.value) in terms(query.text)
        ],
    )
    yield (
        "Automatic tags",
        [
            _facet(
                query,
                term("tag", name),
                tag.words,
                rule=tag.meaning,
                count=counts.tags[name][0],
                unknown=counts.tags[name][1],
            )
            for name, tag in TAGS.items()
        ],
    )
    yield (
        "Manual tags",
        [
            _facet(query, term("tag", name), name, count=count)
            for name, count in curation.marks(library.store)
        ],
    )
    for column, field in _COLUMNS:
        values = library.finder.choices(column)
        if len(values) > 1:
            yield (
                field.capitalize(),
                [
                    _facet(query, term(field, value), value, count=count)
                    for value, count in values[:12]
                ],
            )


def _facet(
    query: Query,
    one: str,
    words: str,
    *,
    rule: str = "",
    count: int | None = None,
    unknown: int = 0,
) -> Facet:
    on = one in terms(query.text)
    return Facet(words, rule, count, unknown, toggled(query.text, one), on)


def _entry(library: Library, case: Case) -> str:
    """What the inspector calls the trace of a case."""
    return str(library.trace(case))


def _named(query: Query) -> Sequence[str]:
    """The terms of a line without their quotes."""
    return [each.replace('"', "") for each in terms(query.text)]


def _captions(library: Library, name: str) -> dict[str, str]:
    return {sha256: caption for _, sha256, caption in curation.members(library.store, name)}
