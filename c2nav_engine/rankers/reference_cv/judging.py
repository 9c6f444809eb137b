"""Scores from words and pixels, slot by slot. All weights are plain priors [C], none is fitted.

The order of the evidence: a coloured landmark of the active leg, then the leg's turn words, then
open floor and a preference for going on ahead.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from c2nav_engine.rankers.reference_cv.pixels import Pixels, Spot, likeness
from c2nav_engine.rankers.reference_cv.words import (
    FAINT,
    Landmark,
    LegWords,
    amount_in_leg,
    read_leg,
    turns_made,
)

NEAR_REACH = 0.70
"""[C] A thing that stands on the floor and reaches this far down a level picture is some three
metres away or less, for the cameras of both body profiles; here it only means "near"."""
NEAR_SHARE = 0.008
"""[C] Smaller spots are not trusted to be the thing itself."""
NEAR_HANGING_SHARE = 0.015
"""[C] A thing on a wall is near when it is at least so large."""
HANGING_REACH = 0.6
"""[C] Things on walls end above the camera or little below it."""
LOW_TOP = 0.42
"""[C] Things lower than the camera end below the horizon, but for some tolerance."""
TALL_REACH = 0.6
"""[C] Tall things go down well below the horizon."""
SOLID_FILL = 0.4
"""[C] Furniture fills its outline; foliage does not."""
LARGEST_SHARE = 0.5
"""[C] A patch over half the picture is a wall or a floor, not a thing."""
FEW, SEVERAL, MANY = 1, 2, 3
"""The sketch's words for how far a leg went."""
AMOUNT_SUPPORT = {0: 0.1, FEW: -0.5, SEVERAL: -0.2, MANY: 0.25}
"""[C] What the way made in a leg says for the next one: it is asked past the progress gate only,
so nothing said (no sketch) leans onward."""
SAME_ROOM = 0.35
"""[C] Likeness of two views above which they are taken to show one room."""
ROOM_CHANGE = 0.8
"""[C] Weight of a change of room."""


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
        3.0 * sum(_attraction(view, landmark) for landmark in leg.landmarks)
        + _side_prior(side, leg, sketch)
        + view.depth_of_view
        for view, side in zip(views, sides, strict=True)
    ]


def next_leg_support(
    now: Pixels, earlier: Sequence[Pixels], *, legs: tuple[LegWords, LegWords], sketch: str
) -> float:
    """Evidence for the next leg minus evidence for this one; 0 when nothing speaks.

    A long way made in this leg, its landmark reached, surroundings unlike the earlier ones where
    it leads into another room, and the next leg's landmark in view speak for the next one; this
    leg's landmark in view but still far speaks for this one.
    """
    this, following = legs
    support = AMOUNT_SUPPORT[amount_in_leg(sketch)]
    if this.leaves_room and earlier:
        least = min(likeness(view, now) for view in earlier)
        support += ROOM_CHANGE * (SAME_ROOM - least)
    if this.target is not None:
        seen = _visibility(now, this.target)
        support += 0.4 if is_near(now, this.target) else -0.4 * seen
    if following.target is not None:
        support += 0.5 * _visibility(now, following.target)
    return support


def is_near(view: Pixels, landmark: Landmark) -> bool:
    """Whether the landmark's colour is there, large enough, and where such a thing can be."""
    spot = seen_spot(view, landmark)
    if landmark.hanging:
        return spot.share >= NEAR_HANGING_SHARE
    return spot.share >= NEAR_SHARE and spot.reach >= NEAR_REACH


def seen_spot(view: Pixels, landmark: Landmark) -> Spot:
    """The landmark's patch, or none when its place or shape is not that of such a thing."""
    spot = view.spot(landmark.colour)
    misplaced = (
        (landmark.hanging and spot.reach > HANGING_REACH)
        or (landmark.low and spot.top < LOW_TOP)
        or (landmark.tall and (spot.top > LOW_TOP or spot.reach < TALL_REACH))
    )
    is_surface = spot.share > LARGEST_SHARE
    return Spot() if misplaced or is_surface or spot.fill < SOLID_FILL else spot


def arrived_here(now: Pixels, leg: LegWords, *, sketch: str) -> bool:
    """Whether the last leg's thing is near; without one, whether the leg has gone some way.

    A last leg is short: it only leads up to what was in view when it began.
    """
    if leg.target is not None:
        return is_near(now, leg.target)
    return amount_in_leg(sketch) >= SEVERAL


def journey_covered(now: Pixels, leg: LegWords, *, sketch: str) -> bool:
    """Whether the record speaks for the whole route: the last leg went on, to its end."""
    amount = amount_in_leg(sketch)
    if leg.target is not None:
        return amount >= FEW and is_near(now, leg.target)
    return amount >= SEVERAL


def destination_score(view: Pixels, leg: LegWords) -> float:
    """How much a view shows of the destination; 0 when the leg names nothing to look for."""
    return 0.0 if leg.target is None else _visibility(view, leg.target)


def action_scores(now: Pixels, *, leg: LegWords, sketch: str) -> dict[str, float]:
    """Direct action: where in the current view the leg's landmark or turn word points."""
    scores = {
        "forward": _side_prior("ahead", leg, sketch) + now.depth_of_view - 3.0,
        "left": _side_prior("to the left", leg, sketch),
        "right": _side_prior("to the right", leg, sketch),
    }
    if leg.target is not None:
        across = seen_spot(now, leg.target).across
        pointed = "forward" if abs(across) < 0.5 else "left" if across < 0.0 else "right"
        scores[pointed] += 1.5 * _visibility(now, leg.target)
    return scores


def words_of_leg(legs: Sequence[str], index: int) -> LegWords:
    """The words of one leg, the last for any index beyond."""
    return read_leg(legs[min(index, len(legs) - 1)])


def _attraction(view: Pixels, landmark: Landmark) -> float:
    central = 1.0 - 0.4 * abs(seen_spot(view, landmark).across)
    return landmark.weight * central * _visibility(view, landmark)


def _visibility(view: Pixels, landmark: Landmark) -> float:
    """0 (not seen) to 1, by size; colours that walls have too count a quarter."""
    trust = 0.25 if landmark.colour in FAINT else 1.0
    return trust * min(1.0, math.sqrt(seen_spot(view, landmark).share / 0.05))


def _side_prior(side: str, leg: LegWords, sketch: str) -> float:
    """What words alone say for a side: going on ahead, the leg's turn, the side it leaves on."""
    prior = 0.2 if side == "ahead" else 0.0
    if side.startswith("behind"):
        prior -= 0.5
    amount = amount_in_leg(sketch)
    if leg.exit_side and leg.exit_side in side and amount >= SEVERAL:
        prior += 0.3
    turn = leg.turn
    due = turn is not None and (turn.opening or amount >= MANY)
    if turn is None or not due or turns_made(sketch, turn.side) >= turn.cycles:
        return prior
    if turn.side == "around":
        return prior + (0.0 if side == "ahead" else 0.5)
    # Without a sketch nothing says whether the turn was made, so its word counts for less.
    return prior + (0.6 if sketch else 0.2) * (turn.side in side)
