from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from app.cli import main
from app.figures.figure import FigureSpec, Kind
from app.figures.plan import Plan
from app.figures.recipe import Run, read_recipe, write_figure
from c2nav_engine.errors import UsageError
from tests.helpers.exchanges import write_fake
from tests.helpers.plays import recording, story

PLAN = Plan(floor=(((-8.0, -2.0), (6.0, -2.0), (6.0, 2.0), (-8.0, 2.0)),))


@pytest.fixture(scope="module")
def trace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("fake") / "a.mcap"
    write_fake(path, cycles=8, side_px=24)
    return path


def code(*words: str) -> int:
    with pytest.raises(SystemExit) as stopped:
        main(words)
    assert isinstance(stopped.value.code, int)
    return stopped.value.code


@pytest.mark.parametrize("suffix", ["pdf", "svg", "png"])
@pytest.mark.parametrize("kind", [Kind.STRIP, Kind.CURVE])
def test_a_recipe_gives_the_same_bytes(kind: Kind, suffix: str, trace: Path, tmp_path: Path):
    figure = tmp_path / f"f.{suffix}"
    words = ("figure", str(trace), "--kind", kind.value, "--decisions", "0,2", "--out", str(figure))
    assert code(*words) == 0
    first = figure.read_bytes()
    figure.unlink()
    assert code("figure", "--recipe", str(figure.with_suffix(".json"))) == 0
    assert figure.read_bytes() == first
    assert figure.with_suffix(".txt").read_text("utf-8")


def test_a_map_is_drawn_again_without_its_scene(tmp_path: Path):
    told = recording()
    spec = FigureSpec(Kind.MAP, (0, 4), 3.5)
    runs = [Run(tmp_path / "a.mcap", told.sha256, story(told))]
    first = write_figure(spec, runs, tmp_path / "f.pdf", plan=PLAN)
    recipe = read_recipe(first.recipe)
    assert recipe.spec == spec
    assert recipe.plan == PLAN
    again = write_figure(recipe.spec, runs, tmp_path / "again.pdf", plan=recipe.plan)
    assert again.sha256 == first.sha256 == recipe.figure_sha256


def edited(recipe: Path, **changes: Any) -> Path:
    plain = json.loads(recipe.read_text("utf-8"))
    recipe.write_text(json.dumps({**plain, **changes}), encoding="utf-8")
    return recipe


@pytest.fixture
def recipe(trace: Path, tmp_path: Path) -> Path:
    figure = tmp_path / "f.pdf"
    assert code("figure", str(trace), "--decisions", "0", "--out", str(figure)) == 0
    return figure.with_suffix(".json")


def test_another_figure_is_told_from_the_recorded_one(
    recipe: Path, capsys: pytest.CaptureFixture[str]
):
    assert code("figure", "--recipe", str(edited(recipe, width_in=5.0)), "--json") == 1
    streams = capsys.readouterr()
    assert json.loads(streams.out.splitlines()[-1])["identical"] is False
    assert "differs from the recorded one" in streams.err


def test_a_recipe_of_another_recording_is_refused(
    recipe: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    other = tmp_path / "other.mcap"
    write_fake(other, cycles=4, side_px=16)
    traces = [{"file": "other.mcap", "sha256": "f" * 64}]
    assert code("figure", "--recipe", str(edited(recipe, traces=traces))) == 2
    assert "another recording" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"kind": "pie"}, "kind"),
        ({"colour": "red"}, "colour"),
        ({"c2nav_figure": 99}, "version 1"),
        ({"width_in": "wide"}, "width_in"),
    ],
)
def test_what_is_no_recipe_is_refused_by_field(recipe: Path, changes: Any, words: str):
    with pytest.raises(UsageError, match=words):
        read_recipe(edited(recipe, **changes))


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("figure",), "expected TRACE and --out"),
        (("figure", "--recipe", "nowhere.json"), "expected a recipe at nowhere.json"),
    ],
)
def test_bad_usage_says_what_to_do(
    words: tuple[str, ...], said: str, capsys: pytest.CaptureFixture[str]
):
    assert code(*words) == 2
    assert said in capsys.readouterr().err


def test_an_unknown_format_is_refused(
    trace: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    out = tmp_path / "f.gif"
    assert code("figure", str(trace), "--decisions", "0", "--out", str(out)) == 2
    assert ".pdf, .svg, .png" in capsys.readouterr().err
