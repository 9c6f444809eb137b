"""One table of all answers to a question: who said what, in which order it was shown."""

from __future__ import annotations

from collections.abc import Mapping

from markupsafe import Markup

from app.inspector import markup as m
from app.session.decisions import Decision
from app.session.differing import winner
from app.session.snapshot import Snapshot
from app.session.wording import is_fault, outcome_words
from c2nav_engine.contract.outcome import Key
from c2nav_engine.contract.prompt import Query, Ranked


def answers_table(snapshot: Snapshot) -> Markup:
    """Rows are rankers and people, columns the presentation orders; cells name the views."""
    decision = snapshot.decision
    if decision is None or decision.question is None:
        return m.NOTHING
    ranked = snapshot.shown
    orders = _orders(ranked, decision)
    rows: list[list[str | Markup]] = []
    if ranked is not None:
        rows.append(_ranker_row(ranked, decision, orders))
    if decision.override is not None:
        rows.append(_override_row(decision, orders))
    if not rows:
        return m.join([m.heading("All answers to this question"), m.note(_waiting(snapshot))])
    return m.join(
        [
            m.heading("All answers to this question"),
            m.table(["ranker", *orders.values(), "outcome"], rows),
        ]
    )


def _waiting(snapshot: Snapshot) -> str:
    return "Asking…" if snapshot.asking else "No answer yet"


def _orders(ranked: Ranked | None, decision: Decision) -> dict[int, str]:
    """Order index → the letters in the order in which they were shown."""
    letters = decision.letters
    if ranked is None or not ranked.queries:
        return {0: " ".join(sorted(letters.values()))}
    return {
        query.prompt.order: " ".join(letters.get(key, "?") for _, key in query.prompt.labels)
        for query in ranked.queries
    }


def _ranker_row(ranked: Ranked, decision: Decision, orders: dict[int, str]) -> list[str | Markup]:
    last: dict[int, Query] = {query.prompt.order: query for query in ranked.queries}
    majority = winner(ranked.outcome) or (winner(last[0].outcome) if 0 in last else None)
    cells = [_cell(last.get(order), decision.letters, majority) for order in orders]
    name = f"{ranked.ranker} · privileged" if ranked.privileged else ranked.ranker
    return [name, *cells, outcome_words(ranked.outcome, decision.letters)]


def _cell(query: Query | None, letters: Mapping[Key, str], majority: Key | None) -> str | Markup:
    if query is None:
        return ""
    words = outcome_words(query.outcome, letters)
    if query.prompt.repair:
        words += " after a reminder"
    differs = winner(query.outcome) not in (majority, None) or is_fault(query.outcome)
    if not differs:
        return words
    return Markup('{} <span class="c2-fault">✕</span>').format(words)


def _override_row(decision: Decision, orders: dict[int, str]) -> list[str | Markup]:
    override = decision.override
    if override is None:
        return []
    said = outcome_words(override.outcome, decision.letters)
    blanks: list[str | Markup] = [""] * (len(orders) - 1)
    name = Markup('{} · <span class="c2-override">◆ override</span>').format(override.who)
    return [name, said, *blanks, said]
