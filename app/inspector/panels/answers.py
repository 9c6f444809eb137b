"""One table of all answers to a question: who said what, in which order it was shown."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from markupsafe import Markup

from app.inspector import markup as m
from app.session.decisions import Decision
from app.session.differing import reasked_differ, winner
from app.session.reasked import Reasked
from app.session.snapshot import Snapshot
from app.session.wording import is_fault, outcome_words
from c2nav_engine.contract.outcome import ORDERS_DISAGREE, Answered, Key
from c2nav_engine.contract.presentation import seeded_order
from c2nav_engine.contract.prompt import Query, Ranked

Shown = tuple[Key, ...]
"""Keys in the order in which they were shown: one column."""


@dataclass(frozen=True, slots=True)
class Row:
    """What one ranker or person said.

    Attributes:
        name: Who.
        said: Order shown → answer.
        outcome: What it comes to, in words.
        after: What stands behind an answer, by order: " after a reminder".
        against: Orders whose answer differs from what it is held against.
    """

    name: str | Markup
    said: Mapping[Shown, Answered]
    outcome: str
    after: Mapping[Shown, str]
    against: frozenset[Shown] = frozenset()


def answers_table(snapshot: Snapshot) -> Markup:
    """Rows are rankers and people, columns the presentation orders; cells name the views."""
    decision = snapshot.decision
    if decision is None or decision.question is None:
        return m.NOTHING
    recorded = seeded_order(decision.question)
    ranked = snapshot.shown
    rows = [] if ranked is None else [_ranker_row(ranked, decision)]
    rows += _reasked_rows(decision, snapshot.reasked_at(decision.number))
    if decision.override is not None:
        rows.append(_override_row(decision, recorded))
    title = m.heading("All answers to this question")
    if not rows:
        return m.join([title, m.note("Asking…" if snapshot.asking else "No answer yet")])
    letters = decision.letters
    orders = _orders(rows, recorded)
    heads = [" ".join(letters.get(key, "?") for key in shown) for shown in orders]
    cells = [
        [row.name, *(_cell(row, shown, letters) for shown in orders), row.outcome] for row in rows
    ]
    return m.join([title, m.wide(m.table(["ranker", *heads, "outcome"], cells))])


def _orders(rows: Iterable[Row], recorded: Shown) -> list[Shown]:
    """Every order that was shown to somebody, the recorded one first."""
    found = dict.fromkeys([recorded])
    for row in rows:
        found.update(dict.fromkeys(row.said))
    return list(found)


def _ranker_row(ranked: Ranked, decision: Decision) -> Row:
    last: dict[Shown, Query] = {
        tuple(key for _, key in query.prompt.labels): query for query in ranked.queries
    }
    first = next(iter(last.values()), None)
    majority = winner(ranked.outcome) or (winner(first.outcome) if first else None)
    return Row(
        name=f"{ranked.ranker} · privileged" if ranked.privileged else ranked.ranker,
        said={shown: query.outcome for shown, query in last.items()},
        outcome=outcome_words(ranked.outcome, decision.letters),
        after={shown: " after a reminder" for shown, q in last.items() if q.prompt.repair},
        against=frozenset(
            shown for shown, q in last.items() if winner(q.outcome) not in (majority, None)
        ),
    )


def _reasked_rows(decision: Decision, answers: tuple[Reasked, ...]) -> list[Row]:
    """One row per ranker and per way of lettering; what differs from the recording is marked."""
    groups: dict[tuple[str, bool], list[Reasked]] = {}
    for answer in answers:
        groups.setdefault((answer.ranker, answer.letters_kept), []).append(answer)
    return [_reasked_row(decision, group) for group in groups.values()]


def _reasked_row(decision: Decision, group: list[Reasked]) -> Row:
    first = group[0]
    winners = {winner(answer.outcome) for answer in group}
    agreed = len(winners) == 1
    return Row(
        name=f"{first.ranker} · asked again{', letters kept' if first.letters_kept else ''}",
        said={answer.shown: answer.outcome for answer in group},
        outcome=outcome_words(first.outcome, decision.letters) if agreed else ORDERS_DISAGREE,
        after={},
        against=frozenset(answer.shown for answer in reasked_differ(decision, group)),
    )


def _override_row(decision: Decision, recorded: Shown) -> Row:
    override = decision.override
    assert override is not None
    name = Markup('{} · <span class="c2-override">◆ override</span>').format(override.who)
    said = outcome_words(override.outcome, decision.letters)
    return Row(name, {recorded: override.outcome}, said, {})


def _cell(row: Row, shown: Shown, letters: Mapping[Key, str]) -> str | Markup:
    outcome = row.said.get(shown)
    if outcome is None:
        return ""
    words = outcome_words(outcome, letters) + row.after.get(shown, "")
    if shown not in row.against and not is_fault(outcome):
        return words
    return Markup('{} <span class="c2-fault">✕</span>').format(words)
