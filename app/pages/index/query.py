"""The one line that filters cases: `ending:"step limit" ne_m<5 -tag:oscillation kitchen`.

Terms are joined by "and". `field:value` compares words, `field>3` numbers; a leading `-` negates;
whatever is no field is looked for in the instruction. Values never reach SQL as text.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from app.pages.index.columns import COLUMNS, COUNTS, MEASURES, TEXTS, Value
from c2nav_engine.errors import InputError
from c2nav_engine.experiments.tags.rules import TAGS

_TERM = re.compile(
    r"""(?P<not>-?)(?:(?P<field>[a-z_][a-z_0-9]*)(?P<sign>:|<=|>=|<|>|=))?"""
    r"""(?:"(?P<quoted>[^"]*)"|(?P<plain>\S+))"""
)

SHORT: Mapping[str, str] = {
    "episode": "episode_id",
    "trajectory": "trajectory_id",
    "scene": "scene_id",
    "sha": "trace_sha256",
}
"""Words for columns with longer names."""

NUMBERS = (*COUNTS, *MEASURES)
OTHERS = ("tag", "unknown", "set")
"""Fields that are no columns: a tag that holds, an automatic tag that is unknown, a named set."""

SORTS = tuple(name for name in COLUMNS if name not in TAGS)
"""Columns to sort by."""


@dataclass(frozen=True, slots=True)
class Condition:
    """A piece of SQL with the values it names."""

    sql: str
    values: tuple[Value, ...] = ()


@dataclass(frozen=True, slots=True)
class Query:
    """Which episodes, in which order.

    Attributes:
        text: The line.
        sort: A column, with a leading "-" for the greatest first.
    """

    text: str = ""
    sort: str = "run"

    def where(self) -> Condition:
        """The filter; raises `InputError` that says which term is not understood."""
        found = [_condition(match) for match in _terms(self.text)]
        return Condition(
            " and ".join(each.sql for each in found) or "true",
            tuple(value for each in found for value in each.values),
        )

    def order(self) -> str:
        """Missing values last; equal ones by path, so that pages never overlap."""
        down, name = self.sort.startswith("-"), self.sort.removeprefix("-")
        if name not in SORTS:
            message = f"expected to sort by one of {', '.join(SORTS)}; came {name!r}"
            raise InputError(message)
        return f"{name} is null, {name} {'desc' if down else 'asc'}, path"


def terms(text: str) -> list[str]:
    """The terms of a line as they are written."""
    return [match[0] for match in _terms(text)]


def toggled(text: str, term: str) -> str:
    """The line with a term added, or without it where it had it."""
    kept = terms(text)
    return " ".join([each for each in kept if each != term] if term in kept else [*kept, term])


def term(field: str, value: str) -> str:
    """A term that asks for a value, quoted where it has to be."""
    return f'{field}:"{value}"' if re.search(r'[\s"]', value) or not value else f"{field}:{value}"


def _terms(text: str) -> list[re.Match[str]]:
    return list(_TERM.finditer(text))


def _condition(match: re.Match[str]) -> Condition:
    field, value = match["field"], match["quoted"] if match["plain"] is None else match["plain"]
    if field is None:
        found = _about(value)
    elif field in OTHERS:
        found = _OTHER[field](value, match["sign"])
    else:
        found = _column(SHORT.get(field, field), match["sign"], value)
    return Condition(f"not ifnull({found.sql}, 0)", found.values) if match["not"] else found


def _about(value: str) -> Condition:
    pattern = "%" + re.sub(r"([%_\\])", r"\\\1", value) + "%"
    return Condition(
        "id in (select id from words where instruction like ? escape '\\')", (pattern,)
    )


def _column(name: str, sign: str, value: str) -> Condition:
    if name in NUMBERS:
        return Condition(f"{name} {'=' if sign == ':' else sign} ?", (_number(name, value),))
    if name in TEXTS and sign in ":=":
        return Condition(f"{name} = ?", (value,))
    if name in TEXTS:
        message = f"expected {name}:WORDS, because {name} holds words; came {name}{sign}{value}"
        raise InputError(message)
    known = ", ".join((*SHORT, *TEXTS, *NUMBERS, *OTHERS))
    message = f'expected a field among {known}; came {name!r}: quote words, as in "{name}:…"'
    raise InputError(message)


def _number(name: str, value: str) -> float:
    try:
        return float(value)
    except ValueError:
        message = f"expected a number after {name}, came {value!r}"
        raise InputError(message) from None


def _tag(value: str, sign: str) -> Condition:
    """An automatic tag by its column, else a mark that a person set."""
    _colon("tag", sign)
    if value in TAGS:
        return Condition(f"{value} = 1")
    return Condition("trace_sha256 in (select trace_sha256 from marks where tag = ?)", (value,))


def _unknown(value: str, sign: str) -> Condition:
    _colon("unknown", sign)
    if value not in TAGS:
        message = f"expected an automatic tag ({', '.join(TAGS)}), came {value!r}"
        raise InputError(message)
    return Condition(f"{value} is null")


def _set(value: str, sign: str) -> Condition:
    _colon("set", sign)
    return Condition("trace_sha256 in (select trace_sha256 from members where name = ?)", (value,))


def _colon(field: str, sign: str) -> None:
    if sign not in ":=":
        message = f"expected {field}:NAME, came {field}{sign}"
        raise InputError(message)


_OTHER: Mapping[str, Callable[[str, str], Condition]] = {
    "tag": _tag,
    "unknown": _unknown,
    "set": _set,
}
