"""One request of the core with its answer: the unit that is recorded, replayed and shown.

A live run produces a list of exchanges, a trace reads back as the same list, and the inspector
draws nothing else. Live, playback and fork are one thing because of it.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from c2nav_engine.contract.outcome import Answered
from c2nav_engine.contract.prompt import Ranked
from c2nav_engine.geometry import Pose
from c2nav_engine.navigator.requests import Request, Response


@dataclass(frozen=True, slots=True)
class Override:
    """A person's answer put in place of the ranker's.

    Attributes:
        outcome: What was committed instead.
        who: Name or pseudonym.
        why: Free words, possibly empty.
        when_s: Wall clock, seconds since the epoch; kept out of the equality of traces.
    """

    outcome: Answered
    who: str
    why: str = ""
    when_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Truth:
    """What only the shell knows; never sent to the core.

    Attributes:
        poses: True poses: of the look (one), or after each executed step.
        goal_distances_m: Geodesic distance to the goal at each of these poses (`inf` when
            unreachable; empty without a goal).
        depth_png: 16-bit millimetre PNG of the front depth, for a look that read the front.
    """

    poses: tuple[Pose, ...]
    goal_distances_m: tuple[float, ...] = ()
    depth_png: bytes = b""


@dataclass(frozen=True, slots=True)
class Exchange:
    """A request, its answer, and what the shell knew beside it.

    Attributes:
        index: Position in the episode, from 0.
        step: Low-level actions executed before this request.
        decision: For `Ask` and for a `Note` of `Unasked`: the decision's number from 0, else None.
        request: What the core yielded.
        response: What it was sent.
        ranked: For `Ask`: the ranker's full record; None when a person answered without asking it.
        override: For `Ask`: the person's answer that was committed instead, if any.
        truth: For `Look` and `Move`.
        wall_s: Wall-clock facts by name; kept out of the equality of traces.
    """

    index: int
    step: int
    decision: int | None
    request: Request
    response: Response
    ranked: Ranked | None = None
    override: Override | None = None
    truth: Truth | None = None
    wall_s: dict[str, float] = field(default_factory=dict[str, float])
