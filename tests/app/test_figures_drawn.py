from __future__ import annotations

import itertools
import re
import shutil
import subprocess
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

from app.figures import style as signs
from app.figures.compare import first_parting
from app.figures.figure import FigureSpec, Kind, caption, draw, inches
from app.figures.ground import window_m
from app.figures.legs import legs_walked
from app.figures.plan import Plan, floor_rings, rings_of
from app.figures.sheet import Sheet, width_of, wrapped
from app.figures.strip import decoded, greyed
from app.session.story import Story
from c2nav_engine.errors import InternalError, UsageError
from c2nav_engine.runner.recorded import read_trace
from tests.helpers.exchanges import write_fake
from tests.helpers.plays import fork, recording, story

WIDTHS = (2.0, 3.5, 7.16)
ROOM = Plan(
    floor=(((-8.0, -2.0), (6.0, -2.0), (6.0, 2.0), (-8.0, 2.0)),),
    walls=(((-8.2, -2.2), (-8.0, -2.2), (-8.0, 2.2), (-8.2, 2.2)),),
)


@pytest.fixture(scope="module")
def every_slot(tmp_path_factory: pytest.TempPathFactory) -> Story:
    path = tmp_path_factory.mktemp("fake") / "a.mcap"
    write_fake(path, cycles=8, side_px=24)
    return story(read_trace(path))


class Watched:
    """What was put on sheets: words with sizes, and where boxes and words lie."""

    def __init__(self) -> None:
        self.words: list[tuple[str, float]] = []
        self.spots: list[tuple[Sheet, float, float]] = []


@pytest.fixture
def watched(monkeypatch: pytest.MonkeyPatch) -> Iterator[Watched]:
    seen = Watched()
    text, box, picture = Sheet.text, Sheet.box, Sheet.picture

    def watched_text(self: Sheet, words: str, at: Any, *, size_pt: float, **rest: Any) -> None:
        anchor = {"left": 0.0, "center": 0.5, "right": 1.0}[rest.get("anchor", "left")]
        width = width_of(words, size_pt, bold=rest.get("bold", False))
        seen.words.append((words, size_pt))
        seen.spots += [
            (self, at[0] - anchor * width, at[1]),
            (self, at[0] + (1.0 - anchor) * width, at[1]),
        ]
        text(self, words, at, size_pt=size_pt, **rest)

    def watched_box(self: Sheet, where: Any, **rest: Any) -> None:
        left, top, width, height = where
        seen.spots += [(self, left, top), (self, left + width, top + height)]
        box(self, where, **rest)

    def watched_picture(self: Sheet, rgb: Any, where: Any) -> None:
        left, top, width, height = where
        seen.spots += [(self, left, top), (self, left + width, top + height)]
        assert width / height == pytest.approx(rgb.shape[1] / rgb.shape[0])
        picture(self, rgb, where)

    monkeypatch.setattr(Sheet, "text", watched_text)
    monkeypatch.setattr(Sheet, "box", watched_box)
    monkeypatch.setattr(Sheet, "picture", watched_picture)
    yield seen


def figures(every_slot: Story) -> list[tuple[FigureSpec, Sequence[Story]]]:
    play, other = story(recording()), story(fork())
    numbers = tuple(range(0, len(every_slot.decisions), 3))
    return [
        *((FigureSpec(Kind.STRIP, numbers, width), (every_slot,)) for width in WIDTHS),
        *((FigureSpec(Kind.MAP, (0, 4, 9), width), (play,)) for width in WIDTHS),
        *((FigureSpec(Kind.CURVE, (0, 4, 9), width), (play,)) for width in WIDTHS),
        *((FigureSpec(Kind.COMPARE, (), width), (play, other)) for width in WIDTHS),
    ]


# ---------------------------------------------------------------- laws of every figure


def test_no_label_is_too_small_and_nothing_leaves_the_sheet(every_slot: Story, watched: Watched):
    for spec, stories in figures(every_slot):
        sheet = draw(spec, stories, ROOM)
        assert sheet.width_in == pytest.approx(spec.width_in)
    assert watched.words
    assert min(size for _, size in watched.words) >= signs.LEAST_PT
    for sheet, x, y in watched.spots:
        assert -0.02 <= x <= sheet.width_in + 0.02
        assert -0.02 <= y <= sheet.height_in + 0.02


def test_a_sheet_refuses_small_print():
    with pytest.raises(InternalError, match=r"at least 7\.0 pt, came 6\.9"):
        Sheet(2.0, 2.0).text("fine print", (0.1, 0.1), size_pt=6.9)


def test_every_strip_names_letter_rank_and_reason(every_slot: Story, watched: Watched):
    vetoed = [d for d in every_slot.decisions if any(c.veto for c in d.facts.candidates)]
    assert vetoed
    draw(FigureSpec(Kind.STRIP, (vetoed[0].number,), 7.16), (every_slot,))
    words = " ".join(text for text, _ in watched.words).replace("\u00a0", " ")
    decision = vetoed[0]
    assert f"Decision {decision.number}" in words
    for candidate in decision.facts.candidates:
        if candidate.veto:
            assert "✕" in words
            assert candidate.veto.split(", ")[0] in words
    for letter in decision.letters.values():
        assert (letter, 7.0) in watched.words


def test_marks_and_dashes_tell_in_grey_what_colour_tells():
    def grey(colour: str) -> float:
        rgb = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255.0
        linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
        return float(linear @ [0.2126, 0.7152, 0.0722])

    for colour in (signs.BLUE, signs.GREEN, signs.VERMILION, signs.INK, signs.QUIET, signs.WALL):
        assert 1.05 / (grey(colour) + 0.05) >= 3.0, colour
    for text in (signs.INK, signs.QUIET):
        for ground in (signs.WHITE, signs.FLOOR, signs.BAND):
            assert (grey(ground) + 0.05) / (grey(text) + 0.05) >= 4.5, (text, ground)
    assert len(set(signs.LEG_DASHES)) == len(signs.LEG_DASHES)


def test_vetoed_pictures_lose_colour_and_contrast_but_no_pixel():
    rng = np.random.default_rng(0)
    rgb = rng.integers(0, 256, (9, 7, 3), dtype=np.uint8)
    pale = greyed(rgb)
    assert pale.shape == rgb.shape
    assert (pale[:, :, 0] == pale[:, :, 1]).all()
    assert np.ptp(pale) <= 0.46 * 255


# ---------------------------------------------------------------- files


def pdf_of(tmp_path: Path, spec: FigureSpec, *stories: Story) -> Path:
    path = tmp_path / "f.pdf"
    draw(spec, stories, ROOM).save(path)
    return path


def poppler(*words: str) -> str:
    if shutil.which(words[0]) is None:
        pytest.skip(f"no {words[0]} on PATH (poppler-utils)")
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout


def test_the_text_of_a_pdf_is_text_in_embedded_fonts(every_slot: Story, tmp_path: Path):
    path = pdf_of(tmp_path, FigureSpec(Kind.STRIP, (0, 12), 7.16), every_slot)
    words = poppler("pdftotext", str(path), "-")
    assert "Decision 12" in words
    assert "leg 1:" in words
    fonts = poppler("pdffonts", str(path)).splitlines()[2:]
    assert fonts
    for font in fonts:
        assert "TrueType" in font
        assert re.search(r"yes +yes +yes", font)


def test_labels_of_a_pdf_are_at_least_seven_points_tall(every_slot: Story, tmp_path: Path):
    for kind, numbers in ((Kind.STRIP, (0, 6, 12)), (Kind.CURVE, (0,)), (Kind.MAP, (0, 3))):
        path = pdf_of(tmp_path, FigureSpec(kind, numbers, 3.5), every_slot)
        boxes = poppler("pdftotext", "-bbox", str(path), "-")
        tall = [
            float(low) - float(high)
            for high, low in re.findall(r'yMin="([\d.]+)"[^>]*yMax="([\d.]+)"', boxes)
        ]
        # The box of a line of DejaVu Sans is 1.164 times its size.
        assert tall
        assert min(tall) >= 7.0


def test_pictures_of_a_pdf_have_the_pixels_that_were_recorded(every_slot: Story, tmp_path: Path):
    decision = every_slot.decisions[0]
    path = pdf_of(tmp_path, FigureSpec(Kind.STRIP, (0,), 7.16), every_slot)
    poppler("pdfimages", "-png", str(path), str(tmp_path / "i"))
    found = [
        np.asarray(cv2.imread(str(each)))[:, :, ::-1] for each in sorted(tmp_path.glob("i-*.png"))
    ]
    pictures = [c.picture for c in decision.facts.candidates if c.feasible and c.picture]
    assert pictures
    for picture in pictures:
        rgb = decoded(picture.jpeg)
        # matplotlib stores pictures bottom up.
        assert any(np.array_equal(each[::-1], rgb) for each in found)


def test_an_svg_brings_its_words_and_its_fonts(tmp_path: Path):
    path = tmp_path / "f.svg"
    draw(FigureSpec(Kind.MAP, (0,), 3.5), (story(recording()),), ROOM).save(path)
    text = path.read_text("utf-8")
    assert re.search(r"<text[^>]*>start</text>", text)
    assert text.count("@font-face") == 2
    assert not re.search(r'(?:href|src)="(?!data:|#)', text)


@pytest.mark.parametrize("suffix", [".pdf", ".svg", ".png"])
def test_the_same_figure_has_the_same_bytes(suffix: str, tmp_path: Path):
    for name in ("a", "b"):
        sheet = draw(FigureSpec(Kind.CURVE, (3,), 3.5), (story(recording()),))
        sheet.save(tmp_path / f"{name}{suffix}")
    assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()


# ---------------------------------------------------------------- what is asked for


@pytest.mark.parametrize(
    ("text", "width_in"),
    [("7.16in", 7.16), ("88mm", 88 / 25.4), (" 8.8 cm ", 8.8 / 2.54), ("252pt", 252 / 72.27)],
)
def test_widths(text: str, width_in: float):
    assert inches(text) == pytest.approx(width_in)


@pytest.mark.parametrize("text", ["7.16", "wide", "-3in", "0.5in", "900in", "7,16in"])
def test_other_widths_are_refused(text: str):
    with pytest.raises(UsageError, match="expected a width"):
        inches(text)


@pytest.mark.parametrize(
    ("spec", "count", "words"),
    [
        (FigureSpec(Kind.STRIP), 1, "expected decisions to show"),
        (FigureSpec(Kind.STRIP, (99,)), 1, "from 0 to"),
        (FigureSpec(Kind.MAP, (-1,)), 1, "from 0 to"),
        (FigureSpec(Kind.MAP), 2, "expected 1 trace "),
        (FigureSpec(Kind.COMPARE), 1, "expected 2 traces"),
    ],
)
def test_what_cannot_be_drawn_is_refused(spec: FigureSpec, count: int, words: str):
    with pytest.raises(UsageError, match=words):
        draw(spec, [story(recording())] * count)


def test_a_caption_names_what_a_reader_must_know():
    licensed = story(recording(scene_licence="CC-BY-4.0, someone", privileged=True))
    words = caption(FigureSpec(Kind.STRIP, (0,)), [licensed])
    for part in (
        licensed.header.episode.instruction,
        licensed.header.variant,
        "knows the truth",
        "CC-BY-4.0, someone",
        "Decision 0",
    ):
        assert part in words


# ---------------------------------------------------------------- parts


def test_legs_are_walked_end_to_end(every_slot: Story):
    for told in (every_slot, story(recording()), story(fork())):
        legs = legs_walked(told)
        assert legs[0].first == 0
        assert legs[-1].last == told.track.last_step
        assert all(a.last == b.first for a, b in itertools.pairwise(legs))


def test_runs_part_where_another_answer_was_given():
    assert first_parting(story(recording()), story(recording())) is None
    assert first_parting(story(recording()), story(fork(7))) == 7


def area(ring: Sequence[tuple[float, float]]) -> float:
    x, z = np.array(ring).T
    return float(x @ np.roll(z, -1) - z @ np.roll(x, -1)) / 2.0


def floor_of(*squares: tuple[float, float, float, float]) -> np.ndarray:
    """Triangles of squares given as (x, z, side, height)."""
    triangles: list[list[tuple[float, float, float]]] = []
    for x, z, side, y in squares:
        a, b, c, d = (x, y, z), (x + side, y, z), (x + side, y, z + side), (x, y, z + side)
        triangles += [[a, b, c], [a, c, d]]
    return np.array(triangles)


def test_a_map_holds_the_whole_disc_of_the_goal(every_slot: Story):
    episode = every_slot.header.episode
    assert episode.goal_m is not None
    (x, _, z), reach = episode.goal_m, episode.goal_radius_m
    least_x, least_z, most_x, most_z = window_m([every_slot])
    assert least_x <= x - reach < x + reach <= most_x
    assert least_z <= z - reach < z + reach <= most_z


def test_a_floor_becomes_its_outline():
    (ring,) = floor_rings(floor_of((0.0, 0.0, 2.0, 0.0)), [0.0])
    assert abs(area(ring)) == pytest.approx(4.0, rel=0.05)
    assert len(ring) == 4


def test_a_hole_runs_against_the_outline_around_it():
    mask = np.zeros((80, 80), np.bool_)
    mask[10:70, 10:70] = True
    mask[30:50, 30:50] = False
    outer, hole = sorted((area(ring) for ring in rings_of(mask, (0.0, 0.0), 0.1)), key=abs)[::-1]
    assert outer * hole < 0.0
    assert abs(outer) == pytest.approx(36.0, rel=0.05)


def test_other_storeys_stay_out_of_the_plan():
    floors = floor_of((0.0, 0.0, 2.0, 0.0), (5.0, 0.0, 2.0, 2.8))
    (ring,) = floor_rings(floors, [0.0, 0.05])
    assert max(x for x, _ in ring) < 3.0


def test_words_wrap_within_their_width_and_keep_numbers_with_units():
    lines = wrapped("free 0.3 m, needs 0.5 m before the robot may go there", 0.7, 7.0)
    assert all(width_of(line, 7.0) <= 0.7 for line in lines)
    assert not any(line.endswith(("0.3", "0.5")) for line in lines)
    assert len(wrapped("word " * 50, 0.7, 7.0, most=2)) == 2
