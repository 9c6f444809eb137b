"""Draws a board as a picture: views above, map and words below."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from jaxtyping import UInt8
from matplotlib import font_manager
from PIL import Image, ImageDraw, ImageFont

from c2nav_engine.geometry import Point
from c2nav_engine.traces.attachments import Task
from c2nav_engine.traces.exports.board import Board, Tile

BACKGROUND = (18, 19, 22)
INK = (232, 232, 228)
FAINT = (140, 142, 148)
ELECTED = (84, 190, 128)
VETOED = (196, 88, 80)
TRAIL = (96, 164, 236)
GOAL = (236, 190, 84)
MARGIN = 16

Colour = tuple[int, int, int]
Line = tuple[str, Colour, int]
"""Words, their colour and their size in pixels."""


@dataclass(frozen=True, slots=True)
class Easel:
    """Where things stand on a frame, all in pixels.

    Attributes:
        width_px: Columns; even, as H.264 wants it.
        height_px: Rows; even.
        task: Instruction, goal and reference path.
        bounds_m: (least x, least z, greatest x, greatest z) that the map must show.
        steps: Steps of the whole episode.
        footer: A last line: run, ranker, licence.
    """

    width_px: int
    height_px: int
    task: Task
    bounds_m: tuple[float, float, float, float]
    steps: int
    footer: str

    def draw(self, board: Board) -> UInt8[np.ndarray, "rows columns 3"]:
        """The frame."""
        image = Image.new("RGB", (self.width_px, self.height_px), BACKGROUND)
        pen = ImageDraw.Draw(image)
        below = MARGIN + self._tiles(image, pen, board.tiles) + MARGIN
        map_px = min(self.height_px - below - 2 * MARGIN - 12, self.width_px * 2 // 5)
        self._map(pen, board, (MARGIN, below, MARGIN + map_px, below + map_px))
        self._words(pen, board, left=map_px + 3 * MARGIN, top=below)
        bottom = self.height_px - MARGIN - 4
        pen.text((MARGIN, bottom), self.footer, fill=FAINT, font=_font(11), anchor="ls")
        return np.asarray(image)

    # ------------------------------------------------------------ pictures

    def _tiles(self, image: Image.Image, pen: ImageDraw.ImageDraw, tiles: Sequence[Tile]) -> int:
        """Draw the pictures side by side; returns how far down they reach."""
        height = self._tile_px(3)[1]
        width = self._tile_px(max(3, len(tiles)))[0]
        for place, tile in enumerate(tiles):
            left, top = MARGIN + place * (width + MARGIN), MARGIN + 18
            title = f"{tile.title} ✓" if tile.elected else tile.title
            colour = VETOED if tile.veto else ELECTED if tile.elected else INK
            pen.text((left, MARGIN + 12), title, fill=colour, font=_font(13), anchor="ls")
            shown = _fitted(tile.jpeg, width, height)
            image.paste(shown, (left, top))
            box = (left - 2, top - 2, left + shown.width + 1, top + shown.height + 1)
            if tile.elected or tile.veto:
                pen.rectangle(box, outline=colour, width=3)
            if tile.veto:
                _paragraph(pen, tile.veto, (left, top + 8), width=width, colour=VETOED, size=11)
        return height + 18

    def _tile_px(self, count: int) -> tuple[int, int]:
        """Room of one of so many pictures; three views fill the width or half the height."""
        rgb = self.task.profile.rgb
        width = (self.width_px - MARGIN * (count + 1)) // count
        height = min(width * rgb.height_px // rgb.width_px, self.height_px // 2)
        return min(width, height * rgb.width_px // rgb.height_px), height

    # ------------------------------------------------------------ map

    def _map(self, pen: ImageDraw.ImageDraw, board: Board, box: tuple[int, int, int, int]) -> None:
        left, top, right, bottom = box
        pen.rectangle(box, outline=(52, 54, 60))
        x0, z0, x1, z1 = self.bounds_m
        scale = (right - left - 24) / max(x1 - x0, z1 - z0, 1.0)
        middle_x, middle_z = (x0 + x1) / 2.0, (z0 + z1) / 2.0

        def at(point_m: Point) -> tuple[float, float]:
            # Seen from above: right is +x, up on the page is −z.
            return (
                (left + right) / 2.0 + (point_m[0] - middle_x) * scale,
                (top + bottom) / 2.0 + (point_m[2] - middle_z) * scale,
            )

        episode = self.task.episode
        for point_m in episode.reference_path_m:
            _dot(pen, at(point_m), 2.0, FAINT)
        if episode.goal_m is not None:
            x, y = at(episode.goal_m)
            reach = episode.goal_radius_m * scale
            pen.ellipse((x - reach, y - reach, x + reach, y + reach), outline=GOAL)
            _dot(pen, (x, y), 3.0, GOAL)
        trail = [at(pose.position_m) for pose in board.trail]
        if len(trail) > 1:
            pen.line(trail, fill=TRAIL, width=2)
        if board.trail:
            pose = board.trail[-1]
            tip = at(pose.ahead(14.0 / scale))
            pen.line([at(pose.position_m), tip], fill=INK, width=3)
            _dot(pen, at(pose.position_m), 4.0, TRAIL)
        steps = f"step {board.step} of {self.steps}"
        pen.text((left + 8, bottom - 8), steps, fill=FAINT, font=_font(12), anchor="ls")
        pen.text(
            (right - 8, bottom - 8), "goal: for you only", fill=GOAL, font=_font(11), anchor="rs"
        )

    # ------------------------------------------------------------ words

    def _words(self, pen: ImageDraw.ImageDraw, board: Board, *, left: int, top: int) -> None:
        width = self.width_px - left - MARGIN
        for number, leg in enumerate(self.task.legs):
            colour = INK if number == board.leg else FAINT
            mark = "▸" if number == board.leg else " "
            text = f"{mark} {number + 1}. {leg}"
            top = _paragraph(pen, text, (left, top), width=width, colour=colour, size=13, lines=2)
        top += 10
        lines: list[Line] = [(board.heading, INK, 15), *((words, INK, 13) for words in board.words)]
        if board.ladder:
            lines.append((f"ladder {board.ladder}", GOAL, 13))
        for text, colour, size in lines:
            place = (left, top)
            top = 4 + _paragraph(pen, text, place, width=width, colour=colour, size=size, lines=3)


@cache
def _font(size: int) -> ImageFont.FreeTypeFont:
    # matplotlib ships this font, so every machine draws the same words.
    manager: Any = font_manager
    return ImageFont.truetype(manager.findfont("DejaVu Sans"), size)


def _fitted(jpeg: bytes, width: int, height: int) -> Image.Image:
    if not jpeg:
        return Image.new("RGB", (width, min(width, height)), (40, 41, 46))
    image = Image.open(io.BytesIO(jpeg)).convert("RGB")
    factor = min(width / image.width, height / image.height)
    size = (max(1, round(image.width * factor)), max(1, round(image.height * factor)))
    return image.resize(size, Image.Resampling.BILINEAR)


def _dot(
    pen: ImageDraw.ImageDraw, place: tuple[float, float], radius: float, colour: Colour
) -> None:
    x, y = place
    pen.ellipse((x - radius, y - radius, x + radius, y + radius), fill=colour)


def _paragraph(
    pen: ImageDraw.ImageDraw,
    text: str,
    place: tuple[int, int],
    *,
    width: int,
    colour: Colour,
    size: int,
    lines: int = 4,
) -> int:
    """Wrapped words; returns the row below them."""
    x, y = place
    font = _font(size)
    wrapped = _wrapped(text, font, width)
    if len(wrapped) > lines:
        wrapped = [*wrapped[: lines - 1], wrapped[lines - 1] + " …"]
    for line in wrapped:
        pen.text((x, y), line, fill=colour, font=font)
        y += size + 4
    return y


def _wrapped(text: str, font: ImageFont.FreeTypeFont, width: int) -> list[str]:
    lines: list[str] = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and font.getlength(longer) <= width:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines
