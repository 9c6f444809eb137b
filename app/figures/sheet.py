"""A sheet of paper to draw on, in inches from its top left corner: the one user of matplotlib."""

from __future__ import annotations

import importlib
import io
import re
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any, Literal

import numpy as np
from jaxtyping import UInt8

from app.figures.style import INK, LEAST_PT, Dash
from app.figures.svg_font import with_fonts
from c2nav_engine.errors import InternalError, UsageError

Spot = tuple[float, float]
"""(right, down) in inches."""

Box = tuple[float, float, float, float]
"""(left, top, width, height) in inches."""

Anchor = Literal["left", "center", "right"]

FONT = "DejaVu Sans"
"""Ships with matplotlib, so that every machine sets the same words."""

FORMATS = (".pdf", ".svg", ".png")

PNG_DPI = 300

_UNIT = re.compile(r"(\d) m\b")

_SETTINGS = {
    "pdf.fonttype": 42,  # TrueType: text stays text, searchable and editable
    "svg.fonttype": "none",
    "svg.hashsalt": "c2nav",
    "image.composite_image": False,
    "font.family": FONT,
    "path.simplify": False,
    "text.parse_math": False,  # an instruction may hold a dollar sign
}
_NO_DATES: dict[str, dict[str, str | None]] = {
    ".pdf": {"CreationDate": None, "Creator": "c2nav", "Producer": None},
    ".svg": {"Date": None, "Creator": "c2nav"},
    ".png": {"Software": "c2nav"},
}


def _mpl(name: str = "") -> Any:
    """A part of matplotlib, whose types are partial."""
    return importlib.import_module(f"matplotlib.{name}" if name else "matplotlib")


def matplotlib_version() -> str:
    """For recipes: another version may set other bytes."""
    return str(_mpl().__version__)


class Sheet:
    """Everything lies where it was put: no layout engine moves a label.

    Text smaller than 7 pt is refused, so no figure can hold any.
    """

    def __init__(self, width_in: float, height_in: float) -> None:
        """An empty white sheet."""
        self.width_in = width_in
        self.height_in = height_in
        self._figure: Any = _mpl("figure").Figure(figsize=(width_in, height_in), facecolor="white")
        self._axes: Any = self._figure.add_axes((0.0, 0.0, 1.0, 1.0))
        self._axes.set_axis_off()
        self._frame()
        self._order = 1

    def _frame(self) -> None:
        self._axes.set_xlim(0.0, self.width_in)
        self._axes.set_ylim(self.height_in, 0.0)

    def _next(self) -> int:
        """What is drawn later lies on top."""
        self._order += 1
        return self._order

    def text(
        self,
        words: str,
        at: Spot,
        *,
        size_pt: float,
        colour: str = INK,
        bold: bool = False,
        anchor: Anchor = "left",
        halo: bool = False,
    ) -> None:
        """One line of words; `at` is on its baseline. A halo keeps it legible over lines."""
        if size_pt < LEAST_PT:
            message = f"expected labels of at least {LEAST_PT} pt, came {size_pt} for {words!r}"
            raise InternalError(message)
        effects = [_mpl("patheffects").withStroke(linewidth=2.2, foreground="white")]
        if halo:
            # The halo is a copy below: a stroked outline of the text itself would not be text.
            self._put_text(words, at, size_pt, colour, bold, anchor, effects)
        self._put_text(words, at, size_pt, colour, bold, anchor, None)

    def _put_text(self, words: str, at: Spot, *rest: Any) -> None:
        size_pt, colour, bold, anchor, effects = rest
        self._axes.text(
            *at,
            words,
            fontsize=size_pt,
            color=colour,
            fontweight="bold" if bold else "normal",
            fontfamily=FONT,
            ha=anchor,
            va="baseline",
            zorder=self._next(),
            path_effects=effects,
            parse_math=False,
        )

    def box(
        self,
        box: Box,
        *,
        edge: str = "none",
        face: str = "none",
        width_pt: float = 0.6,
        dash: Dash = (),
    ) -> None:
        """A rectangle."""
        left, top, width, height = box
        patch = _mpl("patches").Rectangle(
            (left, top),
            width,
            height,
            facecolor=face,
            edgecolor=edge,
            linewidth=width_pt,
            linestyle=(0, dash) if dash else "solid",
            joinstyle="miter",
            zorder=self._next(),
        )
        self._axes.add_patch(patch)

    def picture(self, rgb: UInt8[np.ndarray, "rows columns 3"], box: Box) -> None:
        """A picture in its own pixels: vector formats embed every one of them, resampled never."""
        left, top, width, height = box
        self._axes.imshow(
            rgb,
            extent=(left, left + width, top + height, top),
            interpolation="none",
            aspect="auto",
            zorder=self._next(),
        )
        self._frame()

    def line(
        self,
        points: Sequence[Spot],
        *,
        colour: str = INK,
        width_pt: float = 0.6,
        dash: Dash = (),
    ) -> None:
        """A polyline with round joins."""
        line = _mpl("lines").Line2D(
            [point[0] for point in points],
            [point[1] for point in points],
            color=colour,
            linewidth=width_pt,
            linestyle=(0, dash) if dash else "solid",
            dash_capstyle="butt",
            solid_capstyle="round",
            solid_joinstyle="round",
            zorder=self._next(),
        )
        self._axes.add_line(line)

    def rings(
        self,
        rings: Sequence[Sequence[Spot]],
        *,
        face: str = "none",
        edge: str = "none",
        width_pt: float = 0.4,
    ) -> None:
        """Closed outlines as one shape; a hole runs against the outline around it."""
        if not rings:
            return
        path_type = _mpl("path").Path
        corners: list[Spot] = []
        codes: list[int] = []
        for ring in rings:
            corners += [*ring, ring[0]]
            codes += [path_type.MOVETO, *[path_type.LINETO] * (len(ring) - 1), path_type.CLOSEPOLY]
        patch = _mpl("patches").PathPatch(
            path_type(corners, codes),
            facecolor=face,
            edgecolor=edge,
            linewidth=width_pt,
            zorder=self._next(),
        )
        self._axes.add_patch(patch)

    def disc(
        self,
        at: Spot,
        radius_in: float,
        *,
        face: str = "none",
        edge: str = "none",
        width_pt: float = 0.8,
        dash: Dash = (),
    ) -> None:
        """A circle."""
        patch = _mpl("patches").Circle(
            at,
            radius_in,
            facecolor=face,
            edgecolor=edge,
            linewidth=width_pt,
            linestyle=(0, dash) if dash else "solid",
            zorder=self._next(),
        )
        self._axes.add_patch(patch)

    def save(self, path: Path) -> None:
        """Write the sheet; the same sheet gives the same bytes."""
        suffix = path.suffix.lower()
        if suffix not in FORMATS:
            message = f"expected a figure as {', '.join(FORMATS)}, came {path.name!r}"
            raise UsageError(message)
        data = io.BytesIO()
        with _mpl().rc_context(_SETTINGS):
            self._figure.savefig(data, format=suffix[1:], dpi=PNG_DPI, metadata=_NO_DATES[suffix])
        body = data.getvalue()
        path.write_bytes(with_fonts(body.decode()).encode() if suffix == ".svg" else body)


@cache
def _setter() -> Any:
    return _mpl("textpath").TextToPath()


@cache
def width_of(words: str, size_pt: float, *, bold: bool = False) -> float:
    """Width of a line of words, inches."""
    font = _mpl("font_manager").FontProperties(
        family=FONT, size=size_pt, weight="bold" if bold else "normal"
    )
    width, _, _ = _setter().get_text_width_height_descent(words, font, ismath=False)
    return float(width) / 72.0


def wrapped(words: str, width_in: float, size_pt: float, *, most: int = 9) -> list[str]:
    """Words in lines no wider than that; what exceeds `most` lines ends in an ellipsis.

    A number stays with its unit.
    """
    lines: list[str] = []
    words = _UNIT.sub("\\1\u00a0m", words)
    for word in words.split(" "):
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and width_of(longer, size_pt) <= width_in:
            lines[-1] = longer
        else:
            lines.append(word)
    if len(lines) > most:
        lines = lines[:most]
        while lines[-1] and width_of(f"{lines[-1]} …", size_pt) > width_in and " " in lines[-1]:
            lines[-1] = lines[-1].rsplit(" ", 1)[0]
        lines[-1] += " …"
    return lines
