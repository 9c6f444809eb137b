"""The route ladder: an instruction as ordered legs, every word kept (paper, "Problem Formulation").

The deterministic English parser is the default. A leg is a clause that a picture can be compared
with: a clause that is only a turn, or only "go straight", joins the next [C], because the
transition contrast of two legs of which one names nothing to be seen has no evidence.
"""

from __future__ import annotations

from dataclasses import dataclass

from c2nav_engine.contract.route_clauses import Clause, Word, clauses_of, words_of
from c2nav_engine.errors import EpisodeError

ENGLISH = "english"
WHOLE = "whole"


@dataclass(frozen=True, slots=True)
class RouteLadder:
    """The ordered legs g₁ … g_K of one instruction, K ≥ 1.

    Attributes:
        legs: Verbatim pieces of the instruction, in its order, which together hold every word.
        parser: Who cut it: "english", "model", "whole", or "english (fallback: why)".
        spans: Character range [start, end) of each leg in the instruction.
    """

    legs: tuple[str, ...]
    parser: str
    spans: tuple[tuple[int, int], ...]


def parse_english(instruction: str) -> RouteLadder:
    """Cut English text into legs by clauses; raises `EpisodeError` for a text without words.

    Text order is route order: "After X, do Y" holds X before Y as written.
    """
    words = _words_or_error(instruction)
    return ladder_of(instruction, _join(clauses_of(words)), parser=ENGLISH)


def whole(instruction: str) -> RouteLadder:
    """The ladder of variants without legs: the whole instruction is the only one (K = 1)."""
    return ladder_of(instruction, [list(_words_or_error(instruction))], parser=WHOLE)


def leg_spans(instruction: str, legs: tuple[str, ...]) -> tuple[tuple[int, int], ...]:
    """Where verbatim legs stand in their instruction, for a ladder that a trace kept."""
    spans: list[tuple[int, int]] = []
    end = 0
    for leg in legs:
        start = instruction.find(leg, end)
        if start < 0:
            message = f"expected a leg that stands in the instruction after {end}, came {leg!r}"
            raise EpisodeError(message)
        end = start + len(leg)
        spans.append((start, end))
    return tuple(spans)


def ladder_of(instruction: str, legs: list[list[Word]], *, parser: str) -> RouteLadder:
    """A ladder from words grouped into legs; each group must hold at least one word."""
    spans = tuple((words[0].start, words[-1].end) for words in legs)
    texts = tuple(instruction[start:end] for start, end in spans)
    return RouteLadder(texts, parser, spans)


def _words_or_error(instruction: str) -> tuple[Word, ...]:
    words = words_of(instruction)
    if not words:
        message = f"expected an instruction with words, came {instruction!r}; check the episode"
        raise EpisodeError(message)
    return words


def _join(clauses: tuple[Clause, ...]) -> list[list[Word]]:
    """Legs from clauses: what cannot stand alone leans on the next clause or on the one before."""
    legs: list[list[Word]] = []
    waiting: tuple[Word, ...] = ()
    for clause in clauses:
        if legs and not waiting and _leans_back(clause):
            legs[-1].extend(clause.words)
            continue
        gathered = Clause(waiting + clause.words, introduces=False)
        if gathered.has_landmark and gathered.has_verb:
            legs.append(list(gathered.words))
            waiting = ()
        else:
            waiting = gathered.words
    if waiting and legs:
        legs[-1].extend(waiting)
    elif waiting:
        legs.append(list(waiting))
    return legs


def _leans_back(clause: Clause) -> bool:
    """A description of what was reached, or a clause that means nothing by itself."""
    if clause.has_landmark:
        return not clause.has_verb and not clause.introduces
    return clause.points_back
