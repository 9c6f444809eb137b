"""A figure from runs: which kind, of which decisions, how wide, and the words beside it."""

from __future__ import annotations

import enum
import re
from collections.abc import Sequence
from dataclasses import dataclass

from app.figures.compare import draw_compare, run_words
from app.figures.curve import draw_curve
from app.figures.legs import legs_walked
from app.figures.map import draw_map
from app.figures.plan import Plan
from app.figures.sheet import Sheet
from app.figures.strip import answer_words, draw_strip
from app.session.branches import ended_words
from app.session.story import Story
from app.session.wording import slot_words
from c2nav_engine.errors import UsageError

_WIDTH = re.compile(r"\s*(\d+(?:\.\d+)?)\s*(in|mm|cm|pt)\s*")
_INCHES = {"in": 1.0, "mm": 1.0 / 25.4, "cm": 1.0 / 2.54, "pt": 1.0 / 72.27}

NARROWEST_IN, WIDEST_IN = 2.0, 24.0


class Kind(enum.StrEnum):
    """What a figure shows."""

    STRIP = "strip"
    """The chosen decisions as cards."""
    MAP = "map"
    """The way walked by leg, from above."""
    CURVE = "curve"
    """Distance to the goal over steps."""
    COMPARE = "compare"
    """Two runs of one episode, map and curve."""


@dataclass(frozen=True, slots=True)
class FigureSpec:
    """Everything that decides what is drawn, apart from the runs and their surroundings.

    Attributes:
        kind: What it shows.
        decisions: Numbers of the decisions it speaks of; () for none in particular.
        width_in: Printed width.
    """

    kind: Kind
    decisions: tuple[int, ...] = ()
    width_in: float = 7.16


def inches(text: str) -> float:
    """A printed width as in `7.16in`, `88mm`, `8.8cm`, `252pt` (TeX points)."""
    found = _WIDTH.fullmatch(text)
    if found is None:
        message = f"expected a width as 7.16in, 88mm, 8.8cm or 252pt, came {text!r}"
        raise UsageError(message)
    width_in = float(found[1]) * _INCHES[found[2]]
    if not NARROWEST_IN <= width_in <= WIDEST_IN:
        message = f"expected a width from {NARROWEST_IN:g} to {WIDEST_IN:g} inches, came {text!r}"
        raise UsageError(message)
    return width_in


def draw(spec: FigureSpec, stories: Sequence[Story], plan: Plan | None = None) -> Sheet:
    """Draw the figure; raises `UsageError` for decisions or runs that are not there."""
    _check(spec, stories)
    width_in, numbers = spec.width_in, spec.decisions
    if spec.kind is Kind.STRIP:
        return draw_strip(stories[0], numbers, width_in=width_in)
    if spec.kind is Kind.MAP:
        return draw_map(stories[0], numbers, width_in=width_in, plan=plan)
    if spec.kind is Kind.CURVE:
        return draw_curve(stories[0], numbers, width_in=width_in)
    return draw_compare((stories[0], stories[1]), numbers, width_in=width_in, plan=plan)


def _check(spec: FigureSpec, stories: Sequence[Story]) -> None:
    wanted = 2 if spec.kind is Kind.COMPARE else 1
    if len(stories) != wanted:
        message = (
            f"expected {wanted} trace{'s' if wanted > 1 else ''} for a {spec.kind.value}, "
            f"came {len(stories)}"
        )
        raise UsageError(message)
    if spec.kind is Kind.STRIP and not spec.decisions:
        message = "expected decisions to show, came none; name some as --decisions 3,9,14"
        raise UsageError(message)
    count = min(len(story.decisions) for story in stories)
    for number in spec.decisions:
        if not 0 <= number < count:
            message = f"expected decisions from 0 to {count - 1}, came {number}"
            raise UsageError(message)


def caption(spec: FigureSpec, stories: Sequence[Story], plan: Plan | None = None) -> str:
    """What stands below the figure, ready to be edited: facts, signs, provenance."""
    first = stories[0]
    header = first.header
    lines = [
        f"Episode {header.episode.episode_id} ({header.episode.scene_id}), "
        f"profile {header.profile.name}.",
        f"Instruction: “{header.episode.instruction}”",
    ]
    if spec.kind is Kind.COMPARE:
        lines += [f"{run_words(name, story)}." for name, story in zip("AB", stories, strict=False)]
    else:
        ended = f", {ended_words(first.footer)}" if first.footer else ""
        privileged = " (knows the truth)" if header.privileged else ""
        lines.append(
            f"Variant {header.variant}, ranker {header.ranker}{privileged}, "
            f"seed {header.seed}{ended}."
        )
    lines += _told(spec, first, plan or Plan())
    if header.scene_licence:
        lines.append(f"Pictures: {header.scene_licence}.")
    return "\n".join(lines) + "\n"


def _told(spec: FigureSpec, story: Story, plan: Plan) -> list[str]:
    """The signs of this kind, in words."""
    chosen = [story.decisions[number] for number in spec.decisions]
    if spec.kind is Kind.STRIP:
        told = [
            f"Decision {d.number} ({slot_words(d.slot)}, leg {d.facts.leg + 1}): {answer_words(d)}."
            for d in chosen
        ]
        return [*told, "Thick frame: elected. Dashed frame, ✕: vetoed before the question."]
    radius_m = story.header.episode.goal_radius_m
    curve = f"Band: within {radius_m:g} m of the goal (success)."
    if spec.kind is Kind.CURVE:
        return [
            f"Distance to the goal along the floor. {curve}",
            "● Seeing, ▲ Transition, ■ Arriving.",
        ]
    legs = ", ".join(str(leg.leg + 1) for leg in legs_walked(story))
    ground = "Grey: walkable floor; dark: walls." if not plan.empty else "Trajectory alone."
    told = [
        f"Seen from above. {ground}",
        f"Dotted: reference path. Dashed circle: {radius_m:g} m around the goal.",
    ]
    if spec.kind is Kind.MAP:
        return [*told, f"Line styles: legs {legs}. Dots: Seeing."]
    return [*told, curve, "The numbered decision is the first at which the runs differ."]
