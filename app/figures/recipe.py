"""The recipe beside a figure: everything that is needed to draw it again, byte for byte."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, ValidationError

from app.figures.figure import FigureSpec, Kind, caption, draw
from app.figures.plan import Plan, Ring
from app.figures.sheet import matplotlib_version
from app.session.story import Story
from c2nav_engine.errors import UsageError

SCHEMA = 1


@dataclass(frozen=True, slots=True)
class Run:
    """A run that a figure draws.

    Attributes:
        path: Its trace.
        sha256: That trace's digest.
        story: The run, read.
    """

    path: Path
    sha256: str
    story: Story


class TraceRef(BaseModel):
    """A trace by name and content; the name is relative to the recipe."""

    model_config = ConfigDict(extra="forbid")

    file: str
    sha256: str


class Recipe(BaseModel):
    """As it stands in the file.

    Attributes:
        c2nav_figure: Schema version.
        kind: What the figure shows.
        decisions: Of which decisions.
        width_in: How wide.
        figure: File name of the figure.
        figure_sha256: Digest of its bytes.
        traces: What it was drawn from.
        made_with: Versions; others may set other bytes.
        floor: Outlines of the floor, metres, so that the scene need not be there again.
        walls: Outlines of walls.
    """

    model_config = ConfigDict(extra="forbid")

    c2nav_figure: int = SCHEMA
    kind: Kind
    decisions: tuple[int, ...]
    width_in: float
    figure: str
    figure_sha256: str
    traces: tuple[TraceRef, ...]
    made_with: dict[str, str]
    floor: tuple[Ring, ...] = ()
    walls: tuple[Ring, ...] = ()

    @property
    def spec(self) -> FigureSpec:
        """What to draw."""
        return FigureSpec(self.kind, self.decisions, self.width_in)

    @property
    def plan(self) -> Plan:
        """On which ground."""
        return Plan(self.floor, self.walls)


@dataclass(frozen=True, slots=True)
class Written:
    """What stands on disk after a figure was written."""

    figure: Path
    recipe: Path
    caption: Path
    sha256: str
    words: str = field(repr=False, default="")


def write_figure(
    spec: FigureSpec, runs: Sequence[Run], out: Path, *, plan: Plan | None = None
) -> Written:
    """Write FIG, FIG.json (recipe) and FIG.txt (caption) side by side.

    Raises:
        UsageError: The format, the decisions or the runs do not fit.
    """
    plan = plan or Plan()
    stories = [run.story for run in runs]
    sheet = draw(spec, stories, plan)
    out.parent.mkdir(parents=True, exist_ok=True)
    sheet.save(out)
    digest = hashlib.sha256(out.read_bytes()).hexdigest()
    recipe = Recipe(
        kind=spec.kind,
        decisions=spec.decisions,
        width_in=spec.width_in,
        figure=out.name,
        figure_sha256=digest,
        traces=tuple(
            TraceRef(file=_relative(run.path, out.parent), sha256=run.sha256) for run in runs
        ),
        made_with=_made_with(),
        floor=plan.floor,
        walls=plan.walls,
    )
    recipe_path, words_path = out.with_suffix(".json"), out.with_suffix(".txt")
    recipe_path.write_text(_text(recipe.model_dump(mode="json")), encoding="utf-8")
    words = caption(spec, stories, plan)
    words_path.write_text(words, encoding="utf-8")
    return Written(out, recipe_path, words_path, digest, words)


def read_recipe(path: Path) -> Recipe:
    """Read a recipe; raises `UsageError` naming what is wrong in it."""
    try:
        recipe = Recipe.model_validate_json(path.read_bytes())
    except OSError as error:
        message = f"expected a recipe at {path}, came {error.strerror}"
        raise UsageError(message) from error
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"]) or "the file"
        message = f"expected the recipe of a figure in {path}; {where}: {first['msg']}"
        raise UsageError(message) from error
    if recipe.c2nav_figure != SCHEMA:
        message = f"expected a recipe of version {SCHEMA}, came {recipe.c2nav_figure} in {path}"
        raise UsageError(message)
    return recipe


def traces_of(recipe: Recipe, path: Path) -> tuple[Path, ...]:
    """Where the traces of a recipe lie, seen from the recipe."""
    return tuple(path.parent / trace.file for trace in recipe.traces)


def check_runs(recipe: Recipe, runs: Sequence[Run]) -> None:
    """Raise `UsageError` unless these are the traces that the recipe names."""
    for trace, run in zip(recipe.traces, runs, strict=True):
        if run.sha256 != trace.sha256:
            message = (
                f"expected trace {trace.sha256[:12]} at {run.path}, came {run.sha256[:12]}: "
                "the recipe was made from another recording"
            )
            raise UsageError(message)


def _relative(path: Path, folder: Path) -> str:
    return Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()


def _made_with() -> dict[str, str]:
    try:
        own = version("c2nav")
    except PackageNotFoundError:
        own = ""
    return {"c2nav": own, "matplotlib": matplotlib_version()}


def _text(plain: Mapping[str, Any]) -> str:
    """One entry a line, each outline on its own."""
    lines: list[str] = []
    for name, value in plain.items():
        if name in ("floor", "walls") and value:
            rings = ",\n  ".join(json.dumps(ring) for ring in value)
            lines.append(f" {json.dumps(name)}: [\n  {rings}\n ]")
        else:
            lines.append(f" {json.dumps(name)}: {json.dumps(value, ensure_ascii=False)}")
    return "{\n" + ",\n".join(lines) + "\n}\n"
