"""The whole loop's configuration: the packages' own configs and the variant's switches."""

from __future__ import annotations

import enum
import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, cast

from c2nav_engine.controller.config import ControllerConfig, GateConfig
from c2nav_engine.errors import TraceError


class Direction(enum.StrEnum):
    """How the next direction is chosen."""

    ELECTION = "election"
    CARDINAL = "cardinal"
    """Spatial role inversion: a heading in degrees."""
    DIRECT = "direct"
    """Without Seeing: forward, left or right from the front view."""


class Advance(enum.StrEnum):
    """How the route advances to its next leg."""

    CONTRAST = "contrast"
    CARDINAL = "cardinal"
    """Transition role inversion: progress 0–100."""
    BLIND = "blind"
    """Without Transition: a leg ends a fixed number of cycles past its gate."""


class Terminal(enum.StrEnum):
    """How the robot comes to stop."""

    LADDER = "ladder"
    ABSOLUTE = "absolute"
    """Terminal role inversion: arrived, yes or no."""
    BASIC = "basic"
    """Without Arriving: ground in favour in two cycles in a row."""


@dataclass(frozen=True, slots=True)
class Variant:
    """What a preset switches; every field's default is `full`.

    Attributes:
        direction: How Seeing elects.
        legs: Whether the instruction is taken leg by leg (K = 1 otherwise).
        sketch: Whether prompts carry the route sketch and the journey is asked.
        advance: How Transition is decided.
        terminal: How Arriving decides.
        walkback: Whether markers are left and returned to.
        random_answers: Whether every answer is a seeded uniform order.
    """

    direction: Direction = Direction.ELECTION
    legs: bool = True
    sketch: bool = True
    advance: Advance = Advance.CONTRAST
    terminal: Terminal = Terminal.LADDER
    walkback: bool = True
    random_answers: bool = False


@dataclass(frozen=True, slots=True)
class LoopConfig:
    """Everything that decides how the loop behaves, given a body and answers."""

    variant: Variant = field(default_factory=Variant)
    controller: ControllerConfig = field(default_factory=ControllerConfig)
    gates: GateConfig = field(default_factory=GateConfig)

    def as_json(self) -> dict[str, object]:
        """Plain JSON values, for records."""
        return asdict(self)

    def sha256(self) -> str:
        """Hash of the plain values; equal configs under two preset names share it."""
        text = json.dumps(self.as_json(), sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()

    @staticmethod
    def from_json(values: Mapping[str, object]) -> LoopConfig:
        """Rebuild a recorded config; raises `TraceError` for values this version cannot read."""
        try:
            variant = _fields(values["variant"])
            return LoopConfig(
                variant=Variant(
                    direction=Direction(variant.pop("direction")),
                    advance=Advance(variant.pop("advance")),
                    terminal=Terminal(variant.pop("terminal")),
                    **variant,
                ),
                controller=ControllerConfig(**_fields(values["controller"])),
                gates=GateConfig(**_fields(values["gates"])),
            )
        except (KeyError, TypeError, ValueError) as error:
            message = (
                f"expected a loop config of this version, came {sorted(values)} ({error}); "
                "read the trace with the version that wrote it"
            )
            raise TraceError(message) from error


def _fields(values: object) -> dict[str, Any]:
    return dict(cast("Mapping[str, Any]", values))
