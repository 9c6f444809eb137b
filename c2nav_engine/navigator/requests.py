"""What the core asks of its shell, and what it is sent back.

The navigation cycle is a generator of these requests. It performs no I/O: the live runner, a
replay, a person in the browser and every unit test answer the same values.
"""

from __future__ import annotations

import enum
from collections.abc import Mapping
from dataclasses import dataclass, field

from c2nav_engine.contract.outcome import Key
from c2nav_engine.contract.question import Picture, Question, Slot
from c2nav_engine.geometry import Pose


class Action(enum.StrEnum):
    """Low-level actions of VLN-CE."""

    STOP = "STOP"
    FORWARD = "MOVE_FORWARD"
    LEFT = "TURN_LEFT"
    RIGHT = "TURN_RIGHT"


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
class DepthStats:
    """What the controller keeps of one depth picture.

    Attributes:
        median_m: Median of the valid depths; 0.0 without any.
        holes: Fraction of pixels without a return, in [0, 1].
    """

    median_m: float
    holes: float


@dataclass(frozen=True, slots=True)
class View:
    """One camera's reading.

    Attributes:
        key: "left", "front", "right" or "ring0" … "ring11".
        offset_rad: Left of the heading at the time.
        picture: The encoded RGB.
        free_m: How far a body of this size can travel that way, from recent depth alone.
        depth: Statistics of its depth picture.
    """

    key: str
    offset_rad: float
    picture: Picture
    free_m: float
    depth: DepthStats


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
class Step:
    """One executed low-level action.

    Attributes:
        action: What was executed.
        odometry: Believed pose afterwards.
        moved_m: Believed horizontal displacement of this step.
        collided: Whether the move fell short of the intended one by more than 1e-5 m.
    """

    action: Action
    odometry: Pose
    moved_m: float
    collided: bool


@dataclass(frozen=True, slots=True)
class Moved:
    """Answer to `Move`: what was achieved, possibly fewer steps than asked.

    Attributes:
        steps: Executed actions in order.
        exhausted: The step budget is used up; the episode is over.
    """

    steps: tuple[Step, ...]
    exhausted: bool = False


# ---------------------------------------------------------------- records


@dataclass(frozen=True, slots=True)
class Candidate:
    """An alternative as the controller sees it, vetoed ones included.

    Attributes:
        key: As in the question.
        feasible: Whether it was offered.
        veto: Why not ("" when offered), in plain words with numbers: for people, never a model.
        free_m: Free space that way; None where that means nothing.
        offset_rad: Direction left of the heading; None where that means nothing.
        picture: What it shows.
    """

    key: Key
    feasible: bool
    veto: str = ""
    free_m: float | None = None
    offset_rad: float | None = None
    picture: Picture | None = None


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
class SketchEntry:
    """One cycle's entry of the route sketch (paper, eq. 4).

    Attributes:
        cycle: Navigation cycle.
        leg: Leg it belongs to.
        displacement_m: (right, forward) in the leg's start frame.
        elapsed_steps: Low-level steps of the cycle.
        turning: "straight", "left", "right", "sharp left", "sharp right", "back".
        words: Controller-written words of the entry.
        cue: "current", "next" or "ambiguous".
        thumbnail: The front view, small.
    """

    cycle: int
    leg: int
    displacement_m: tuple[float, float]
    elapsed_steps: int
    turning: str
    words: str
    cue: str
    thumbnail: Picture | None


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
