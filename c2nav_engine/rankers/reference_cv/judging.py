"""Scores from words and pixels, slot by slot. All weights are plain priors [C], none is fitted.

The order of the evidence: a coloured landmark of the active leg, then the leg's turn words, then
open floor and a preference for going on ahead.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from c2nav_engine.rankers.reference_cv.pixels import Pixels, Spot
from c2nav_engine.rankers.reference_cv.words import (
    FAINT,
    Landmark,
    LegWords,
    amount_in_leg,
    read_leg,
    turned_in_leg,
)

NEAR_REACH = 0.70
"""[C] A thing that stands on the floor and reaches this far down a level picture is some three
metres away or less, for the cameras of both body profiles; here it only means "near"."""
NEAR_SHARE = 0.02
"""[C] Smaller spots are not trusted to be the thing itself."""
BLOCKED = 0.35
"""[C] Openness under which something stands close ahead."""
ENOUGH_STEPS = 3
"""[C] "many steps" in the sketch's words: how far a leg without any visible end is followed."""


def direction_scores(
    views: Sequence[Pixels], sides: Sequence[str], *, leg: LegWords, sketch: str
) -> list[float]:
    """How well each view continues the leg.

    Args:
        views: What each shows.
        sides: Where each lies, in the words beside its label ("to the left").
        leg: The active leg's words.
        sketch: The sketch's words, which say whether the leg's turn was made.
    """
    return [
        2.0 * sum(_attraction(view, landmark) for landmark in leg.landmarks)
        + _turn_prior(side, leg.turn, sketch)
        + 0.8 * view.openness
        for view, side in zip(views, sides, strict=True)
    ]


def next_leg_support(
    now: Pixels, earlier: Sequence[Pixels], *, legs: tuple[LegWords, LegWords], sketch: str
) -> float:
    """Evidence for the next leg minus evidence for this one; 0 when nothing speaks.

    The next leg's landmark in view, this leg's landmark reached or passed, this leg's turn made,
    and, without any colour to look for, a long way in this leg speak for the next one.
    """
    this, following = legs
    support = 0.0
    if following.target is not None:
        support += _visibility(now.spot(following.target.colour), following.target)
    if this.target is not None:
        here = _visibility(now.spot(this.target.colour), this.target)
        before = max(
            (_visibility(view.spot(this.target.colour), this.target) for view in earlier),
            default=0.0,
        )
        passed = before - here
        support += 0.8 if is_near(now, this.target) else max(passed, 0.0) - 0.7 * here
    amount = amount_in_leg(sketch)
    if this.turn and sketch:
        support += 0.3 if turned_in_leg(sketch, this.turn) else -0.3
    return support + {0: 0.0, 1: -0.25, 2: 0.0, 3: 0.35}[amount]


def is_near(view: Pixels, landmark: Landmark) -> bool:
    """Whether the landmark's colour is there, large, and low in the picture."""
    spot = view.spot(landmark.colour)
    return spot.share >= NEAR_SHARE and spot.reach >= NEAR_REACH


def arrived_here(now: Pixels, leg: LegWords) -> bool:
    """Whether the last leg's thing is near; without one, whether something stands close ahead."""
    if leg.target is not None:
        return is_near(now, leg.target)
    return now.openness < BLOCKED


def journey_covered(now: Pixels, leg: LegWords, *, sketch: str) -> bool:
    """Whether the record speaks for the whole route: the last leg went far, or its end is near."""
    amount = amount_in_leg(sketch)
    if leg.target is not None:
        return amount >= 1 and is_near(now, leg.target)
    return amount >= ENOUGH_STEPS


def destination_score(view: Pixels, leg: LegWords) -> float:
    """How much a view shows of the destination; 0 when the leg names nothing to look for."""
    if leg.target is None:
        return 0.0
    spot = view.spot(leg.target.colour)
    return _visibility(spot, leg.target) + 0.5 * spot.reach * (spot.share > 0.0)


def action_scores(now: Pixels, *, leg: LegWords, sketch: str) -> dict[str, float]:
    """Direct action: where in the current view the leg's landmark or turn word points."""
    scores = {"forward": 0.35 + 0.8 * now.openness, "left": 0.3, "right": 0.3}
    for side in ("left", "right"):
        scores[side] += max(0.0, _turn_prior(f"to the {side}", leg.turn, sketch))
    if leg.target is not None:
        spot = now.spot(leg.target.colour)
        strength = 2.0 * _visibility(spot, leg.target)
        pointed = "forward" if abs(spot.across) < 0.5 else "left" if spot.across < 0 else "right"
        scores[pointed] += strength
    return scores


def words_of_leg(legs: Sequence[str], index: int) -> LegWords:
    """The words of one leg, the last for any index beyond."""
    return read_leg(legs[min(index, len(legs) - 1)])


def _attraction(view: Pixels, landmark: Landmark) -> float:
    spot = view.spot(landmark.colour)
    central = 1.0 - 0.4 * abs(spot.across)
    return landmark.weight * central * _visibility(spot, landmark)


def _visibility(spot: Spot, landmark: Landmark) -> float:
    """0 (not seen) to 1; a patch over half the picture is a wall or a floor, not a thing."""
    trust = 0.25 if landmark.colour in FAINT else 1.0
    if spot.share > 0.5:
        trust *= 0.3
    return trust * min(1.0, math.sqrt(spot.share / 0.08))


def _turn_prior(side: str, turn: str, sketch: str) -> float:
    ahead = 0.5 if side.startswith("ahead") else 0.0
    if side.startswith("behind"):
        ahead = 0.4 if turn == "around" else -0.4
    wanted = turn in {"left", "right"} and f"to the {turn}" in side
    if not wanted or (sketch and turned_in_leg(sketch, turn)):
        return ahead
    # Without a sketch nothing says whether the turn was made, so its word counts for less.
    return ahead + (0.7 if sketch else 0.2)
