"""A strip: the chosen decisions as cards with letter, rank and reason, leg by leg."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from jaxtyping import UInt8

from app.figures.sheet import Box, Sheet, width_of, wrapped
from app.figures.style import BLUE, FAR, INK, LINE, QUIET, VERMILION, WELL, WHITE, Style
from app.session.cards import ranks_of
from app.session.decisions import Decision
from app.session.story import Story
from app.session.wording import SIGNS, key_words, ordinal, outcome_words, slot_words
from c2nav_engine.contract.outcome import Ordering
from c2nav_engine.contract.question import Picture
from c2nav_engine.navigator.requests import Candidate

_LEAD = 1.25
"""Line height over text size."""

_WORDS_IN = 0.95
"""Least width of a card that prints the question's words for an alternative."""

_MARKS = re.compile(r"<leg>(.*?)</leg>", re.DOTALL)

_BADGES_IN = 0.24
"""Room for letter and rank on a card without a picture."""


@dataclass(frozen=True, slots=True)
class Card:
    """One alternative as it is printed.

    Attributes:
        letter: As the question named it; "–" for what was not offered.
        rank: From 1; None without one.
        lines: What stands below or beside.
        picture: What was shown, if anything.
        vetoed: Whether it was taken out before the question.
        columns: Width in cards.
        words: What the question says of it, printed where there is room.
    """

    letter: str
    rank: int | None
    lines: tuple[str, ...]
    picture: Picture | None
    vetoed: bool = False
    columns: int = 1
    words: str = ""


def draw_strip(
    story: Story, numbers: Sequence[int], *, width_in: float, style: Style | None = None
) -> Sheet:
    """The decisions with those numbers, in rows that fill the width."""
    style = style or Style()
    decisions = [story.decisions[number] for number in numbers]
    blocks = [_Block(story, decision, style) for decision in decisions]
    columns = max(block.columns for block in blocks)
    per_row = _per_row(len(blocks), columns, width_in=width_in, style=style)
    gaps_in = (per_row - 1) * style.block_gap_in + per_row * (columns - 1) * style.gap_in
    card_in = (width_in - gaps_in - 0.02) / (per_row * columns)
    rows = [blocks[start : start + per_row] for start in range(0, len(blocks), per_row)]
    for row in rows:
        lines = max(len(block.title(card_in)) for block in row)
        for block in row:
            block.title_lines = lines
    heights_in = [max(block.height_in(card_in) for block in row) for row in rows]
    sheet = Sheet(width_in, sum(heights_in) + (len(rows) - 1) * style.block_gap_in + 0.03)
    top = 0.01
    step_in = columns * card_in + (columns - 1) * style.gap_in + style.block_gap_in
    for row, height_in in zip(rows, heights_in, strict=True):
        for place, block in enumerate(row):
            block.draw(sheet, (0.01 + place * step_in, top), card_in)
        top += height_in + style.block_gap_in
    return sheet


def _per_row(count: int, columns: int, *, width_in: float, style: Style) -> int:
    """Decisions in a row, so that no card is too narrow and no row much emptier than another."""
    block_in = columns * style.card_in + (columns - 1) * style.gap_in
    most = max(1, int((width_in + style.block_gap_in) / (block_in + style.block_gap_in)))
    return math.ceil(count / math.ceil(count / most))


class _Block:
    """One decision: a title, its cards, its answer."""

    def __init__(self, story: Story, decision: Decision, style: Style) -> None:
        self._story = story
        self._decision = decision
        self._style = style
        self._cards = list(_cards(decision))
        self._lead_in = style.small_pt * _LEAD / 72.0
        self.title_lines = 1

    @property
    def columns(self) -> int:
        return max(2, min(3, sum(card.columns for card in self._cards)))

    def _width_in(self, card_in: float) -> float:
        return self.columns * card_in + (self.columns - 1) * self._style.gap_in

    def _rows(self) -> Iterator[list[Card]]:
        row: list[Card] = []
        for card in self._cards:
            if row and sum(each.columns for each in row) + card.columns > self.columns:
                yield row
                row = []
            row.append(card)
        yield row

    def title(self, card_in: float) -> list[str]:
        decision, legs = self._decision, self._story.header.legs
        words = f"leg {decision.facts.leg + 1}: “{legs[decision.facts.leg]}”"
        return wrapped(words, self._width_in(card_in), self._style.small_pt, most=2)

    def _answer(self, card_in: float) -> list[str]:
        words = answer_words(self._decision)
        return wrapped(words, self._width_in(card_in), self._style.small_pt, most=2)

    def _card_height_in(self, card: Card, card_in: float) -> float:
        width_in = card.columns * card_in + (card.columns - 1) * self._style.gap_in
        picture = card.picture
        shown = _BADGES_IN
        if picture is not None:
            shown = width_in * picture.height_px / picture.width_px
        lines = sum(len(self._wrap(line, width_in)) for line in _lines(card, width_in))
        return shown + lines * self._lead_in + 0.1

    def _wrap(self, line: str, width_in: float) -> list[str]:
        return wrapped(line, width_in - 0.08, self._style.small_pt, most=6)

    def height_in(self, card_in: float) -> float:
        """Height of the whole block at a card width."""
        cards = sum(
            max(self._card_height_in(card, card_in) for card in row) + self._style.gap_in
            for row in self._rows()
        )
        lines = 1.15 + self.title_lines + len(self._answer(card_in))
        return cards + lines * self._lead_in + 0.08

    def draw(self, sheet: Sheet, at: tuple[float, float], card_in: float) -> None:
        """Draw with the top left corner there."""
        left, top = at
        style, decision = self._style, self._decision
        name = f"{SIGNS[decision.lane]} Decision {decision.number}"
        top += self._lead_in
        sheet.text(name, (left, top), size_pt=style.body_pt, bold=True)
        after_in = width_of(f"{name}  ", style.body_pt, bold=True)
        slot = f"{slot_words(decision.slot)}, step {decision.step}"
        if after_in + width_of(slot, style.small_pt) <= self._width_in(card_in):
            sheet.text(slot, (left + after_in, top), size_pt=style.small_pt, colour=QUIET)
        top += 0.15 * self._lead_in
        for number, line in enumerate(self.title(card_in), 1):
            down = top + number * self._lead_in
            sheet.text(line, (left, down), size_pt=style.small_pt, colour=QUIET)
        top += self.title_lines * self._lead_in + 0.06
        for row in self._rows():
            height_in = max(self._card_height_in(card, card_in) for card in row)
            x = left
            for card in row:
                width_in = card.columns * card_in + (card.columns - 1) * style.gap_in
                self._draw_card(sheet, card, (x, top, width_in, height_in))
                x += width_in + style.gap_in
            top += height_in + style.gap_in
        for line in self._answer(card_in):
            top += self._lead_in
            sheet.text(line, (left, top - 0.02), size_pt=style.small_pt)

    def _draw_card(self, sheet: Sheet, card: Card, box: Box) -> None:
        left, top, width, _ = box
        first = card.rank == 1
        sheet.box(box, face=WHITE)
        beneath = top + _BADGES_IN
        if card.picture is not None:
            shown = width * card.picture.height_px / card.picture.width_px
            self._draw_picture(sheet, card, (left, top, width, shown))
            beneath = top + shown
        edge = BLUE if first else (FAR if card.vetoed else LINE)
        dash = (3.0, 2.0) if card.vetoed else ()
        weight = 1.8 if first else (0.9 if card.rank == 2 else 0.6)
        sheet.box(box, edge=INK if card.rank == 2 else edge, width_pt=weight, dash=dash)
        self._badges(sheet, card, box)
        for line in _lines(card, width):
            for part in self._wrap(line, width):
                beneath += self._lead_in
                self._caption(sheet, part, (left + 0.04, beneath + 0.01))

    def _caption(self, sheet: Sheet, words: str, at: tuple[float, float]) -> None:
        size_pt = self._style.small_pt
        if not words.startswith("✕"):
            sheet.text(words, at, size_pt=size_pt)
            return
        sheet.text("✕", at, size_pt=size_pt, colour=VERMILION, bold=True)
        after_in = width_of("✕ ", size_pt, bold=True)
        sheet.text(words[1:].strip(), (at[0] + after_in, at[1]), size_pt=size_pt)

    def _draw_picture(self, sheet: Sheet, card: Card, box: Box) -> None:
        picture = card.picture
        if picture is None or not picture.jpeg:
            sheet.box(box, face=WELL)
            words = wrapped("picture not in this trace", box[2] - 0.1, self._style.small_pt)
            for line, part in enumerate(words):
                at = (box[0] + box[2] / 2, box[1] + box[3] / 2 + line * self._lead_in)
                sheet.text(part, at, size_pt=self._style.small_pt, colour=QUIET, anchor="center")
            return
        rgb = decoded(picture.jpeg)
        sheet.picture(greyed(rgb) if card.vetoed else rgb, box)

    def _badges(self, sheet: Sheet, card: Card, box: Box) -> None:
        if not card.letter:
            return
        left, top, width, _ = box
        size_pt, radius_in = self._style.small_pt, 0.085
        middle = (left + 0.04 + radius_in, top + 0.04 + radius_in)
        sheet.disc(middle, radius_in, face=WHITE, edge=FAR, width_pt=0.6)
        below = size_pt * 0.36 / 72.0
        sheet.text(
            card.letter, (middle[0], middle[1] + below), size_pt=size_pt, bold=True, anchor="center"
        )
        if card.rank is None:
            return
        words = ordinal(card.rank)
        tag_in = width_of(words, size_pt, bold=True) + 0.06
        tag = (left + width - tag_in - 0.04, top + 0.04, tag_in, 2 * radius_in)
        sheet.box(tag, face=WHITE, edge=FAR, width_pt=0.6)
        at = (tag[0] + tag_in / 2, middle[1] + below)
        sheet.text(words, at, size_pt=size_pt, bold=True, anchor="center")


def _cards(decision: Decision) -> Iterator[Card]:
    """The pictures all alternatives share, then the alternatives."""
    outcome = decision.outcome
    if outcome is None and decision.elected is not None:
        outcome = Ordering(((decision.elected,),))
    ranks = ranks_of(outcome)
    shared = decision.question.context[-1:] if decision.question else ()
    for _, picture in shared:
        yield Card("", None, ("current view",), picture)
    for candidate in decision.facts.candidates:
        card = _card(decision, candidate, ranks.get(candidate.key))
        # Two wide pictures stand below each other; the six sectors of a glance make a grid.
        yield replace(card, columns=1) if len(decision.facts.candidates) > 2 else card


def _card(decision: Decision, candidate: Candidate, rank: int | None) -> Card:
    alternatives = decision.question.alternatives if decision.question else ()
    alternative = next((a for a in alternatives if a.key == candidate.key), None)
    picture = candidate.picture or (alternative.picture if alternative else None)
    lines = [key_words(candidate.key)]
    if candidate.free_m is not None and candidate.feasible:
        lines.append(f"free {candidate.free_m:.1f} m")
    if not candidate.feasible:
        lines += f"✕ {candidate.veto}".split(", ")
    wide = picture is not None and picture.width_px > 1.5 * picture.height_px
    letter = decision.letters.get(candidate.key, "–")
    words = "" if picture or not alternative else _MARKS.sub("“\\1”", alternative.text)
    return Card(
        letter,
        rank,
        tuple(lines),
        picture,
        not candidate.feasible,
        columns=3 if wide else 1,
        words=words,
    )


def _lines(card: Card, width_in: float) -> tuple[str, ...]:
    return (*card.lines, card.words) if card.words and width_in >= _WORDS_IN else card.lines


def answer_words(decision: Decision) -> str:
    """The committed answer and how often it was asked, in letters."""
    if decision.question is None:
        return "not asked: one view left" if decision.elected else "not asked: no view left"
    words = outcome_words(decision.outcome, decision.letters)
    if decision.override is not None:
        return f"◆ {decision.override.who}: {words}"
    count = len({q.prompt.order for q in decision.ranked.queries}) if decision.ranked else 0
    orders = "" if count < 2 else f" ({count} presentation orders)"
    return f"{words}{orders}"


def decoded(jpeg: bytes) -> UInt8[np.ndarray, "rows columns 3"]:
    """A picture's own pixels."""
    bgr = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)
    return np.ascontiguousarray(np.asarray(bgr)[:, :, ::-1])


def greyed(rgb: UInt8[np.ndarray, "rows columns 3"]) -> UInt8[np.ndarray, "rows columns 3"]:
    """Pale and colourless: what was not offered, as the page shows it."""
    grey = rgb @ np.array([0.299, 0.587, 0.114])
    pale = np.clip((grey - 127.5) * 0.45 + 172.0, 0.0, 255.0).astype(np.uint8)
    return np.repeat(pale[:, :, None], 3, axis=2)
