"""What the physical side senses and executes: views, depth facts, actions, candidates."""

from __future__ import annotations

import enum
from dataclasses import dataclass

from c2nav_engine.contract.outcome import Key
from c2nav_engine.contract.question import Picture
from c2nav_engine.geometry import Pose


class Action(enum.StrEnum):
    """Low-level actions of VLN-CE."""

    STOP = "STOP"
    FORWARD = "MOVE_FORWARD"
    LEFT = "TURN_LEFT"
    RIGHT = "TURN_RIGHT"


@dataclass(frozen=True, slots=True)
class DepthStats:
    """What the controller keeps of one depth picture, over the pixels that were sensed.

    Attributes:
        median_m: Median of the valid depths; 0.0 without any.
        holes: Fraction of depths without a return, in [0, 1].
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
