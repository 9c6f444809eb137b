"""Where the legs of a route were walked."""

from __future__ import annotations

from dataclasses import dataclass

from app.session.story import Story


@dataclass(frozen=True, slots=True)
class LegWalked:
    """A leg as far as it was walked: steps from `first` to `last`, both ends included.

    Attributes:
        leg: From 0.
        first: Low-level actions before it began.
        last: Low-level actions when it ended, or when the episode did.
    """

    leg: int
    first: int
    last: int


def legs_walked(story: Story) -> tuple[LegWalked, ...]:
    """Every leg that was entered, in order; a leg ends where the next one begins."""
    starts: list[tuple[int, int]] = []
    for decision in story.decisions:
        if not starts or starts[-1][0] != decision.facts.leg:
            starts.append((decision.facts.leg, decision.step))
    starts = starts or [(0, 0)]
    starts[0] = (starts[0][0], 0)
    ends = [first for _, first in starts[1:]] + [story.track.last_step]
    return tuple(
        LegWalked(leg, first, last) for (leg, first), last in zip(starts, ends, strict=True)
    )
