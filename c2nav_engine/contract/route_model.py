"""The route ladder by a language model, checked word by word, with the English parser behind it.

Paper, "Problem Formulation": a language-only step before the episode. Whatever the model says,
the ladder holds verbatim pieces of the instruction in its order; a model can only place the cuts.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import replace

from c2nav_engine.contract.route import ENGLISH, RouteLadder, ladder_of, parse_english
from c2nav_engine.contract.route_clauses import Clause, Word, words_of
from c2nav_engine.errors import RankerUnavailable

Complete = Callable[[str], str]
"""`complete(text) -> text`: one language-only completion."""

MODEL = "model"
ROUTE_TEMPLATE = """\
Cut this walking instruction into its route legs, in order: one leg for each stretch of the way
that ends at something visible. A turn without anything visible belongs to the leg after it.
Copy the words exactly as they stand. Keep every word, change none, add none.
Answer with the legs alone, each on a line of its own.

<instruction>{instruction}</instruction>
"""
"""What the model is sent; the instruction stands in a marked span."""

_BULLET = re.compile(r"^\s*(?:[-*•]\s+|\(?\d+[.):]\s+)")


def parse_with_model(instruction: str, complete: Complete) -> RouteLadder:
    """One completion, validated; anything but a cut of this very text falls back to English.

    The fallback's `parser` says why. Raises `EpisodeError` for a text without words and lets
    `RankerStopped` pass: without a server the whole run stops.
    """
    fallback = parse_english(instruction)
    try:
        answer = complete(ROUTE_TEMPLATE.format(instruction=instruction))
    except RankerUnavailable as error:
        return _recorded(fallback, f"no answer: {error}")
    legs, flaw = _cut(words_of(instruction), _lines(answer))
    if flaw:
        return _recorded(fallback, flaw)
    return ladder_of(instruction, legs, parser=MODEL)


def _recorded(ladder: RouteLadder, why: str) -> RouteLadder:
    return replace(ladder, parser=f"{ENGLISH} (fallback: {why})")


def _lines(answer: str) -> list[str]:
    """Legs as lines, with bullets and numbering taken off, or as a JSON list of strings."""
    text = answer.strip()
    text = re.sub(r"^```\w*\n|\n```$", "", text)
    if text.startswith("["):
        try:
            return [str(leg) for leg in json.loads(text)]
        except json.JSONDecodeError:
            pass
    return [_BULLET.sub("", line) for line in text.splitlines() if line.strip()]


def _cut(words: tuple[Word, ...], lines: list[str]) -> tuple[list[list[Word]], str]:
    """The instruction's own words grouped as the lines are; a flaw in words where they differ."""
    legs: list[list[Word]] = []
    taken = 0
    for line in lines:
        said = [word.text for word in words_of(line)]
        leg = list(words[taken : taken + len(said)])
        if [word.text for word in leg] != said:
            return [], f"leg {len(legs) + 1} is not the instruction's next words"
        if said:
            legs.append(leg)
        taken += len(said)
    if taken < len(words):
        return [], f"{len(words) - taken} words are missing"
    return legs, _empty_leg(legs)


def _empty_leg(legs: list[list[Word]]) -> str:
    for number, words in enumerate(legs, start=1):
        clause = Clause(tuple(words), introduces=False)
        if not (clause.has_landmark or clause.has_verb):
            return f"leg {number} holds neither verb nor landmark"
    return ""
