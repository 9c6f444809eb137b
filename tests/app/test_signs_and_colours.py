"""Meanings that can stand side by side stay apart for people who see fewer colours."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

import numpy as np
import pytest

CSS = (Path(__file__).parents[2] / "web_assets" / "app.css").read_text(encoding="utf-8")

# Viénot, Brettel and Mollon 1999, on linear RGB.
SIGHTS = {
    "full": np.eye(3),
    "protanopia": np.array(
        [[0.11238, 0.88762, 0.0], [0.11238, 0.88762, 0.0], [0.00401, -0.00401, 1.0]]
    ),
    "deuteranopia": np.array(
        [[0.29275, 0.70725, 0.0], [0.29275, 0.70725, 0.0], [-0.02234, 0.02234, 1.0]]
    ),
}
MEANINGS = ("blue", "green", "vermilion")


def tokens(dark: bool) -> dict[str, str]:
    light, rest = CSS.split(':root:root[data-mantine-color-scheme="dark"] {', maxsplit=1)
    found = dict(re.findall(r"--c2-([a-z-]+): (#[0-9a-f]{6});", light))
    if dark:
        found |= dict(re.findall(r"--c2-([a-z-]+): (#[0-9a-f]{6});", rest.split("}")[0]))
    return found


def linear(colour: str) -> np.ndarray:
    rgb = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255.0
    return np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)


def lab(rgb_linear: np.ndarray) -> np.ndarray:
    xyz = np.array(
        [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
    ) @ rgb_linear.clip(0.0, 1.0)
    ratio = xyz / np.array([0.9505, 1.0, 1.089])
    f = np.where(ratio > 0.008856, np.cbrt(ratio), 7.787 * ratio + 16.0 / 116.0)
    return np.array([116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])])


def contrast(a: str, b: str) -> float:
    weights = np.array([0.2126, 0.7152, 0.0722])
    light, dark = sorted((float(weights @ linear(a)), float(weights @ linear(b))), reverse=True)
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("sight", SIGHTS)
@pytest.mark.parametrize("pair", list(itertools.combinations((*MEANINGS, "quiet"), 2)))
def test_meanings_stay_apart(sight: str, pair: tuple[str, str]):
    seen = [lab(SIGHTS[sight] @ linear(tokens(dark=False)[name])) for name in pair]
    assert np.linalg.norm(seen[0] - seen[1]) >= 25.0


def test_the_three_colours_are_the_agreed_ones():
    found = tokens(dark=False)
    agreed = {"blue": "#0072b2", "green": "#009e73", "vermilion": "#d55e00"}
    assert {name: found[name] for name in MEANINGS} == agreed


@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("text", ["ink", "quiet", "blue-text", "green-text", "vermilion-text"])
@pytest.mark.parametrize("ground", ["card", "chip", "code", "active"])
def test_text_is_legible(dark: bool, text: str, ground: str):
    found = tokens(dark)
    assert contrast(found[text], found[ground]) >= 4.5


@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("mark", [*MEANINGS, "far"])
def test_marks_are_visible(dark: bool, mark: str):
    found = tokens(dark)
    assert contrast(found[mark], found["card"]) >= 3.0
