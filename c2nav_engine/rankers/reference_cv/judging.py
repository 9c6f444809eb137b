"""Scores from words and pixels, slot by slot. All weights are round priors [C].

They were set by looking at recorded questions of the even built-in episodes; none is fitted to a
house. The order of the evidence: a coloured landmark in view, then turn words, then many colours
in the distance and a preference for going on ahead.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from c2nav_engine.rankers.reference_cv.pixels import Pixels, Spot, likeness
from c2nav_engine.rankers.reference_cv.words import (
    FAINT,
    Landmark,
    LegWords,
    amount_in_leg,
    on_first_leg,
    read_leg,
    turns_made,
)

NEAR_REACH = 0.75
"""[C] A thing that stands on the floor and reaches this far down a level picture is a few steps
away, for the cameras of both body profiles; here it only means "near"."""
NEAR_SHARE = 0.01
"""[C] Smaller spots are not trusted to be the thing itself."""
NEAR_HANGING_SHARE = 0.015
"""[C] A thing on a wall or on furniture is near when it is at least so large."""
ATTRACTION = 3.0
"""[C] Weight of a landmark in full view; it outweighs every other evidence for a direction."""
VARIETY = 1.0
"""[C] Weight of the variety in the distance."""
USUAL_VARIETY = 3.8
"""[C] The mean over recorded views: what to compare with where there is one view only."""
AHEAD = 0.3
"""[C] What speaks for going on ahead; as much speaks against turning back."""
HANGING_REACH = 0.6
"""[C] Things on walls end above the camera or little below it."""
LOW_TOP = 0.42
"""[C] Things lower than the camera end below the horizon, but for some tolerance."""
TALL_REACH = 0.6
"""[C] Tall things go down well below the horizon."""
SOLID_FILL = 0.4
"""[C] Furniture fills its outline; foliage does not."""
EXIT_SIDE = 0.7
"""[C] Weight of the side on which the leg leaves, once some way was made."""
TURN_AT_ONCE = 1.5
"""[C] Weight of turning around, and of a turn that the instruction begins with: both are made
where the robot stands."""
SAME_WAY_ROUND = 0.5
"""[C] Weight of turning around the way it was begun."""
TURN_SOMEWHERE = 0.3
"""[C] Weight of a later turn, which is made where the way allows it."""
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
    views: Sequence[Pixels],
    sides: Sequence[str],
    *,
    legs: tuple[LegWords, LegWords | None],
    sketch: str,
) -> list[float]:
    """How well each view continues the leg.

    The next leg's landmark counts in full, also where that leg only goes past it: the leg in hand
    ends where the next one begins, and its landmark shows where that is.

    Args:
        views: What each shows.
        sides: Where each lies, in the words beside its label ("to the left").
        legs: Words of the active leg and of the one after it, if there is one.
        sketch: The sketch's words, which say whether the leg's turn was made.
    """
    leg, following = legs
    landmarks = list(leg.landmarks)
    if following is not None and following.target is not None:
        landmarks.append(replace(following.target, weight=1.0))
    return [
        ATTRACTION * sum(_attraction(view, landmark) for landmark in landmarks)
        + VARIETY * view.variety
        + _side_prior(side, leg, sketch)
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
    if landmark.hanging or landmark.raised:
        return spot.share >= NEAR_HANGING_SHARE
    return spot.share >= NEAR_SHARE and spot.reach >= NEAR_REACH


def seen_spot(view: Pixels, landmark: Landmark) -> Spot:
    """The largest patch of the landmark's colour that has the place and shape of such a thing."""
    fitting = (spot for spot in view.spots(landmark.colour) if _fits(spot, landmark))
    return next(fitting, Spot())


def _fits(spot: Spot, landmark: Landmark) -> bool:
    misplaced = (
        (landmark.hanging and spot.reach > HANGING_REACH)
        or (landmark.low and spot.top < LOW_TOP)
        or (landmark.tall and (spot.top > LOW_TOP or spot.reach < TALL_REACH))
    )
    is_surface = spot.share > LARGEST_SHARE
    return not misplaced and not is_surface and spot.fill >= SOLID_FILL


def arrived_here(now: Pixels, leg: LegWords, *, sketch: str) -> bool:
    """Whether the last leg's thing is near.

    A thing without a colour of its own must also come after a long way, and one that this ranker
    does not know is taken to be where a long way ends.
    """
    target = leg.target
    if target is not None and target.colour not in FAINT:
        return is_near(now, target)
    went_far = amount_in_leg(sketch) >= MANY
    return went_far and (target is None or is_near(now, target))


def destination_score(view: Pixels, leg: LegWords) -> float:
    """How much a view shows of the destination; 0 when the leg names nothing to look for."""
    return 0.0 if leg.target is None else _visibility(view, leg.target)


def action_scores(now: Pixels, *, leg: LegWords, sketch: str) -> dict[str, float]:
    """Direct action: where in the current view the leg's landmark or turn word points."""
    scores = {
        "forward": _side_prior("ahead", leg, sketch) + VARIETY * (now.variety - USUAL_VARIETY),
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


def words_after(legs: Sequence[str], index: int) -> LegWords | None:
    """The words of the leg after this one, or None after the last."""
    return read_leg(legs[index + 1]) if index + 1 < len(legs) else None


def _attraction(view: Pixels, landmark: Landmark) -> float:
    central = 1.0 - 0.4 * abs(seen_spot(view, landmark).across)
    return landmark.weight * central * _visibility(view, landmark)


def _visibility(view: Pixels, landmark: Landmark) -> float:
    """0 (not seen) to 1, by size; colours that walls have too count a quarter."""
    trust = 0.25 if landmark.colour in FAINT else 1.0
    return trust * min(1.0, math.sqrt(seen_spot(view, landmark).share / 0.05))


def _side_prior(side: str, leg: LegWords, sketch: str) -> float:
    """What words alone say for a side: going on ahead, the leg's turn, the side it leaves on."""
    prior = AHEAD if side == "ahead" else 0.0
    if side.startswith("behind"):
        prior -= AHEAD
    amount = amount_in_leg(sketch)
    if leg.exit_side and leg.exit_side in side and amount >= SEVERAL:
        prior += EXIT_SIDE
    turn = leg.turn
    due = turn is not None and (turn.opening or amount >= MANY)
    if turn is None or not due or turns_made(sketch, turn.side) >= turn.cycles:
        return prior
    if turn.side == "around":
        # Once begun, it goes on the same way round.
        begun = "left" if turns_made(sketch, "left") > 0 else "right"
        return prior + (0.0 if side == "ahead" else TURN_AT_ONCE + SAME_WAY_ROUND * (begun in side))
    at_once = turn.opening and on_first_leg(sketch)
    return prior + (TURN_AT_ONCE if at_once else TURN_SOMEWHERE) * (turn.side in side)
