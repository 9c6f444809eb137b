"""The route sketch: what the controller saw happen, in words that hold no magnitude (eq. 4)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from c2nav_engine.contract.question import Picture
from c2nav_engine.geometry import Pose, wrap_rad

STRAIGHT_RAD = math.radians(22.5)
"""Net yaw of a cycle below which it went straight [C]."""
TURN_RAD = math.radians(67.5)
"""Net yaw below which a cycle turned left or right [C]."""
SHARP_RAD = math.radians(135.0)
"""Net yaw below which a turn is sharp; beyond, the cycle turned back [C]."""
TRACE_LENGTH = 4
"""Thumbnails and single entries that a prompt carries [C]."""
FEW_STEPS = 3
"""Forward steps up to which a stretch is "a few" [C]."""
SEVERAL_STEPS = 9
"""Forward steps up to which a stretch is "several"; beyond it is "many" [C]."""


@dataclass(frozen=True, slots=True)
class SketchEntry:
    """One cycle's entry of the route sketch (paper, eq. 4).

    Attributes:
        cycle: Navigation cycle.
        leg: Leg it belongs to.
        displacement_m: (right, forward) from the leg's start, in the leg's start frame.
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


def turning_word(net_yaw_rad: float) -> str:
    """Ordinal turning evidence of a cycle's net yaw (left positive)."""
    size_rad = abs(wrap_rad(net_yaw_rad))
    side = "left" if net_yaw_rad > 0.0 else "right"
    if size_rad < STRAIGHT_RAD:
        return "straight"
    if size_rad < TURN_RAD:
        return side
    return f"sharp {side}" if size_rad < SHARP_RAD else "back"


def in_leg_frame(start: Pose, pose: Pose) -> tuple[float, float]:
    """Displacement (right, forward) of a pose in the frame of a leg's start."""
    dx = pose.position_m[0] - start.position_m[0]
    dz = pose.position_m[2] - start.position_m[2]
    fx, _, fz = start.forward
    return (dz * fx - dx * fz, dx * fx + dz * fz)


def amount_word(forward_steps: int) -> str:
    """How far, without a number."""
    if forward_steps <= FEW_STEPS:
        return "a few steps"
    return "several steps" if forward_steps <= SEVERAL_STEPS else "many steps"


def movement_words(turning: str, forward_steps: int, *, reoriented: bool = False) -> str:
    """One cycle in words."""
    turned = {
        "straight": "",
        "back": "turned back",
        "left": "turned left",
        "right": "turned right",
        "sharp left": "turned sharply left",
        "sharp right": "turned sharply right",
    }[turning]
    if reoriented:
        return f"looked around and {turned}" if turned else "looked around"
    moved = f"moved {amount_word(forward_steps)}" if forward_steps else ""
    return " and ".join(part for part in (turned, moved) if part) or "stayed in place"


class RouteSketch:
    """The episode's entries, oldest first, and their rendering for prompts."""

    def __init__(self) -> None:
        self.entries: list[SketchEntry] = []
        self._forward_steps: list[int] = []

    def append(self, entry: SketchEntry, *, forward_steps: int) -> None:
        """Take in one cycle."""
        self.entries.append(entry)
        self._forward_steps.append(forward_steps)

    def cue(self, word: str) -> SketchEntry:
        """Fill in the last entry's journey-consistency cue; returns the entry as it now is."""
        self.entries[-1] = replace(self.entries[-1], cue=word)
        return self.entries[-1]

    @property
    def thumbnails(self) -> tuple[Picture, ...]:
        """The latest small views, oldest first."""
        pictures = [entry.thumbnail for entry in self.entries if entry.thumbnail is not None]
        return tuple(pictures[-TRACE_LENGTH:])

    def render(self, leg: int) -> str:
        """The sketch as words: legs done, the way so far in this leg, the latest moves."""
        lines: list[str] = []
        for done in range(leg):
            lines.append(f"Leg done: {self._summary(done)}.")
        lines.append(f"This leg so far: {self._summary(leg)}.")
        place = self._place(leg)
        if place:
            lines.append(f"From where this leg began, the robot is now {place}.")
        latest = [entry.words for entry in self.entries if entry.leg == leg][-TRACE_LENGTH:]
        if latest:
            lines.append(f"Latest moves, oldest first: {'; '.join(latest)}.")
        return "\n".join(lines)

    def _summary(self, leg: int) -> str:
        mine = [
            (entry, steps)
            for entry, steps in zip(self.entries, self._forward_steps, strict=True)
            if entry.leg == leg
        ]
        if not mine:
            return "just begun"
        total = sum(steps for _, steps in mine)
        parts = [f"moved {amount_word(total)}" if total else "not moved yet"]
        turned = [entry.turning for entry, _ in mine if entry.turning != "straight"]
        parts += [f"turned {_adverb(word)}" for word in _without_repeats(turned)[-TRACE_LENGTH:]]
        return ", ".join(parts)

    def _place(self, leg: int) -> str:
        mine = [entry for entry in self.entries if entry.leg == leg]
        if not mine:
            return ""
        right_m, forward_m = mine[-1].displacement_m
        words: list[str] = []
        if abs(forward_m) >= max(0.25, 0.4 * abs(right_m)):
            words.append("ahead" if forward_m > 0.0 else "behind")
        if abs(right_m) >= max(0.25, 0.4 * abs(forward_m)):
            words.append("to the right" if right_m > 0.0 else "to the left")
        return " and ".join(words)


def _adverb(turning: str) -> str:
    return turning.replace("sharp", "sharply")


def _without_repeats(words: list[str]) -> list[str]:
    return [word for index, word in enumerate(words) if index == 0 or words[index - 1] != word]
