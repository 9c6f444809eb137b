"""What the core asks of its shell, and what it is sent back.

The navigation cycle is a generator of these requests. It performs no I/O: the live runner, a
replay, a person in the browser and every unit test answer the same values.
"""

from __future__ import annotations

import enum
from collections.abc import Mapping
from dataclasses import dataclass, field

from c2nav_engine.contract.outcome import Answered, Key
from c2nav_engine.contract.question import Picture, Question, Slot
from c2nav_engine.controller.sensed import Action, Candidate, DepthStats, Step, View
from c2nav_engine.faculties.remembering.sketch import SketchEntry
from c2nav_engine.geometry import Pose

__all__ = [
    "Action",
    "Ask",
    "Candidate",
    "DepthStats",
    "Event",
    "Facts",
    "LadderState",
    "Look",
    "Marker",
    "Move",
    "Moved",
    "Note",
    "Record",
    "Request",
    "Response",
    "Rig",
    "Seen",
    "SketchEntry",
    "SketchState",
    "Step",
    "Stop",
    "Unasked",
    "View",
]


class Rig(enum.StrEnum):
    """Which cameras of the fixed sensor ring are read."""

    FRONT = "front"
    """The view ahead."""
    FAN = "fan"
    """Left, front, right at −offset … +offset (keys "left", "front", "right")."""
    RING = "ring"
    """Twelve views at 30°, counter-clockwise from the front, and six sectors of two."""


# ---------------------------------------------------------------- requests


@dataclass(frozen=True, slots=True)
class Look:
    """Read cameras; costs no action. Answered by `Seen`."""

    rig: Rig


@dataclass(frozen=True, slots=True)
class Ask:
    """Put a question. Answered by an `Answered` outcome (`contract.outcome`)."""

    question: Question
    facts: Facts


@dataclass(frozen=True, slots=True)
class Move:
    """Execute actions in order; forward runs end early at a collision. Answered by `Moved`."""

    actions: tuple[Action, ...]
    purpose: str
    """"elect", "glance", "direct", "walk-back": what the trace calls this motion."""


@dataclass(frozen=True, slots=True)
class Note:
    """Tell the shell something worth recording. Answered by None."""

    record: Record


@dataclass(frozen=True, slots=True)
class Stop:
    """Call STOP (the only stop there is). The generator ends after it. Answered by None."""


Request = Look | Ask | Move | Note | Stop

# ---------------------------------------------------------------- replies


@dataclass(frozen=True, slots=True)
class Seen:
    """Answer to `Look`.

    Attributes:
        views: In rig order (left, front, right; ring0 … ring11; or front alone).
        sectors: For `Rig.RING`, six joined pictures: sector k joins ring 2k (at 60k°) and 2k + 1,
            the one further left standing left. Empty otherwise.
        thumbnail: Small copy of the front view for the sketch; None where no front was read.
        odometry: Believed pose at the time of looking.
    """

    views: tuple[View, ...]
    odometry: Pose
    sectors: tuple[Picture, ...] = ()
    thumbnail: Picture | None = None


@dataclass(frozen=True, slots=True)
class Moved:
    """Answer to `Move`: what was achieved, possibly fewer steps than asked.

    Attributes:
        steps: Executed actions in order.
        exhausted: The step budget is used up; the episode is over.
    """

    steps: tuple[Step, ...]
    exhausted: bool = False


Response = Seen | Moved | Answered | None
"""What the core is sent: for `Look`, `Move`, `Ask`, and `Note` or `Stop`."""

# ---------------------------------------------------------------- records


@dataclass(frozen=True, slots=True)
class Facts:
    """What the controller knew when it asked; for the record and the inspector.

    Attributes:
        slot: The decision slot.
        cycle: Navigation cycle, from 0.
        leg: Active leg, from 0.
        candidates: Offered and vetoed alternatives in canonical order.
        odometry: Believed pose.
        travelled_m: In the episode, by odometry.
        leg_travelled_m: In the leg, by odometry.
        contested: Whether this election asks cyclic orders, with why ("" when not).
        notes: Further plain facts, name → words.
    """

    slot: Slot
    cycle: int
    leg: int
    candidates: tuple[Candidate, ...]
    odometry: Pose
    travelled_m: float
    leg_travelled_m: float
    contested: str = ""
    notes: Mapping[str, str] = field(default_factory=dict[str, str])


@dataclass(frozen=True, slots=True)
class Unasked:
    """A decision that needed no question: one survivor, or none.

    Attributes:
        facts: As for a question.
        elected: The only survivor, or None when nothing was offered.
    """

    facts: Facts
    elected: Key | None


@dataclass(frozen=True, slots=True)
class SketchState:
    """The sketch after a cycle, with what Remembering holds.

    Attributes:
        entry: The cycle's new entry.
        rendering: The nonmetric text that prompts carry.
        support: Transition supports in a row.
        leg: Active leg after this cycle.
        advanced: Whether this cycle advanced the leg.
        gate_open: Whether the progress gate was open.
    """

    entry: SketchEntry
    rendering: str
    support: int
    leg: int
    advanced: bool
    gate_open: bool


@dataclass(frozen=True, slots=True)
class Marker:
    """A Walk-Back marker: a rejected candidate place worth a second look."""

    odometry: Pose
    score: int
    cycle: int
    path_m: float


@dataclass(frozen=True, slots=True)
class LadderState:
    """Arriving's evidence and what followed.

    Attributes:
        cycle: Navigation cycle.
        ground: −1, 0, +1.
        journey: −1, 0, +1.
        lookback: −1, 0, +1.
        verdict: "hold", "inspect" or "stop" by the table, after the last reading.
        vetoes: Physical vetoes that turned a stop into a hold.
        budget: Look-backs left for this candidate place.
        markers: Walk-Back markers now held.
        event: "", "marker left", "walk-back", "gave up", "re-evaluated", "stop vetoed".
    """

    cycle: int
    ground: int
    journey: int
    lookback: int
    verdict: str
    vetoes: tuple[str, ...]
    budget: int
    markers: tuple[Marker, ...]
    event: str = ""


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened between decisions: "fallback", "glance", "walk-back", "stalled".

    Attributes:
        name: What.
        detail: Plain words.
        cycle: When.
    """

    name: str
    detail: str
    cycle: int


Record = Unasked | SketchState | LadderState | Event
