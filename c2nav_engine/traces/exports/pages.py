"""Decisions and evidence as short Markdown pages."""

from __future__ import annotations

from c2nav_engine.traces.contract_messages import outcome_of
from c2nav_engine.traces.pb.decision_pb2 import Decision
from c2nav_engine.traces.pb.route_pb2 import Ladder
from c2nav_engine.traces.words import committed_words, outcome_words, prompt_words, winner_of


def decision_markdown(decision: Decision) -> str:
    """A decision as a page: candidates, answers, what was committed, and the prompt."""
    facts = decision.facts
    labels = {
        label.key: label.label for query in decision.ranked.queries[:1] for label in query.labels
    }
    winner = winner_of(decision)
    names = {
        each.key: f"**{each.key}**" if each.key == winner else each.key for each in facts.candidates
    }
    rows = [
        f"| {labels.get(each.key, '')} | {names[each.key]} | {each.veto or 'offered'} |"
        for each in facts.candidates
    ]
    lines = [
        f"## Decision {decision.decision} · {decision.slot}",
        f"leg {facts.leg + 1} · cycle {facts.cycle} · {facts.contested or 'not contested'}",
        "",
        f"**{committed_words(decision)}**",
        "",
        "| label | candidate | |",
        "|---|---|---|",
        *rows,
        "",
    ]
    for query in decision.ranked.queries:
        meant = outcome_words(outcome_of(query.outcome))
        said = f"`{query.text}`" if query.text else "no text"
        lines.append(f"- order {query.order}, attempt {query.repair + 1}: {said} → {meant}")
    prompt = prompt_words(decision)
    if prompt:
        lines += ["", "```text", prompt, "```"]
    return "\n".join(lines)


def ladder_markdown(ladder: Ladder) -> str:
    """Arriving's evidence and what followed from it."""
    evidence = {
        "ground": ladder.ground,
        "journey": ladder.journey,
        "look-back": ladder.lookback,
    }
    lines = [
        f"**{ladder.verdict}** · look-backs left: {ladder.budget} · markers: {len(ladder.markers)}",
        "",
        "| evidence | |",
        "|---|---|",
        *(f"| {name} | {value:+d} |" for name, value in evidence.items()),
        "",
        *(f"- {note}" for note in [*ladder.vetoes, ladder.event] if note),
    ]
    return "\n".join(lines)
