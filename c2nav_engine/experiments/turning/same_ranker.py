"""Who goes on after a changed answer: the ranker of the recording, or one that is named."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.rankers import RANKERS, seats_for
from c2nav_engine.runner.opening import SeatFor
from c2nav_engine.runner.record import Header


@dataclass(frozen=True, slots=True)
class Continuing:
    """A ranker that goes on.

    Attributes:
        name: As in the table of rankers.
        seat_for: Makes its seats.
        options: With which it was made.
        privileged: Whether it knows the truth.
    """

    name: str
    seat_for: SeatFor
    options: Mapping[str, str] = field(default_factory=dict[str, str])
    privileged: bool = False


def continuing(
    header: Header, ranker: str = "", options: Mapping[str, str] | None = None
) -> Continuing:
    """The named ranker, else the recording's own with its recorded options.

    Args:
        header: Of the recording.
        ranker: A name of the table of rankers; "" for the recording's own.
        options: None or empty takes the recorded ones, for the recording's own ranker.

    Raises:
        UsageError: A person recorded it and none is named, or an option does not fit.
    """
    own = next((name for name in RANKERS if header.ranker.startswith(name)), "")
    name = ranker or own
    if name in RANKERS and not RANKERS[name].interactive:
        kept = dict(options or (header.ranker_options if name == own else {}))
        return Continuing(name, seats_for(name, kept), kept, RANKERS[name].privileged)
    message = (
        f"expected a ranker to go on with, came {name or header.ranker!r}; name one with --ranker"
    )
    raise UsageError(message)
