"""`c2nav bench`: the speed ratios of this machine, each measured side by side in one run."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro
from rich.console import Console
from rich.table import Table

from app.commands.options import JsonOpt, ScenesOpt
from app.commands.output import print_json
from c2nav_engine.errors import C2NavError, MissingExtra, UsageError

HOUSE = Path("house") / "aws_small_house_yup.glb"
"""The furnished house below a scenes folder."""

Measured = Mapping[str, float | None]


@dataclass(frozen=True, slots=True)
class Bench:
    """One benchmark module and the keys that it measures.

    Attributes:
        keys: Names in the table.
        measure: Scenes folder → values by key; raises `MissingExtra` where something is missing.
        only_named: Whether it takes minutes of its own and so is left out of "all of them".
    """

    keys: tuple[str, ...]
    measure: Callable[[Path | None], Measured]
    only_named: bool = False


def _rendering(key: str, *, needs_file: bool = False) -> Callable[[Path | None], Measured]:
    def measure(scenes: Path | None) -> Measured:
        module = importlib.import_module("benchmarks.rendering")
        if key == "view_cost_10m_over_100k":
            return {key: module.view_cost_10m_over_100k()}
        house = scenes / HOUSE if scenes else None
        if house is None or not house.is_file():
            if needs_file:
                message = f"{key} needs a scene file: name the scenes folder with --scenes"
                raise MissingExtra(message)
            house = _largest_built_in()
        return {key: getattr(module, key)(house)}

    return measure


def _largest_built_in() -> object:
    from c2nav_engine.world.builtin import builtin_scene, builtin_source

    ids = sorted({episode.scene_id for episode in builtin_source().episodes})
    return max((builtin_scene(scene_id) for scene_id in ids), key=lambda s: len(s.triangles))


def _module(name: str, function: str = "measure") -> Callable[[Path | None], Measured]:
    def measure(scenes: Path | None) -> Measured:
        try:
            module = importlib.import_module(f"benchmarks.{name}")
        except ModuleNotFoundError as error:
            message = f"benchmarks.{name} cannot run here: {error}"
            raise MissingExtra(message) from error
        return getattr(module, function)(scenes)

    return measure


BENCHES: Mapping[str, Bench] = {
    "fan": Bench(("fan_over_casts",), _rendering("fan_over_casts")),
    "ring": Bench(("ring_over_casts",), _rendering("ring_over_casts")),
    "pyrender": Bench(("pyrender_over_fan",), _rendering("pyrender_over_fan", needs_file=True)),
    "filament": Bench(("filament_over_fan",), _rendering("filament_over_fan", needs_file=True)),
    "cycle": Bench(("cycle_over_render", "trace_over_cycle"), _module("cycle")),
    "traces": Bench(
        ("decision_bytes_share", "decision_seek_ms", "trace_open_ms"), _module("traces")
    ),
    "large": Bench(("view_cost_10m_over_100k",), _rendering("view_cost_10m_over_100k")),
    "workers": Bench(("workers2_over_1",), _module("batch")),
    "lanes": Bench(("lanes8_over_1",), _module("batch", "measure_lanes")),
    "cases": Bench(
        ("cases_filter_2000_ms", "cases_filter_100000_ms"), _module("cases"), only_named=True
    ),
    "step": Bench(
        (
            "step_click_to_picture_p50_ms",
            "step_click_to_picture_p95_ms",
            "step_at_once_p50_ms",
            "step_at_once_p95_ms",
            "step_server_processor_ms",
        ),
        _module("page", "measure_step"),
    ),
    "page": Bench(
        (
            "scrub_settled_ms",
            "scrub_ends_right",
            "scrub_decisions",
            "scrub_server_processor_ms",
            "place_asked_ms",
            "place_server_processor_ms",
            "trace_usable_s",
            "trace_server_processor_s",
            "large_usable_s",
            "large_shown_s",
            "large_server_processor_s",
            "large_server_peak_mb",
            "memory_growth_mb",
            "memory_steps",
        ),
        _module("page", "measure_rest"),
        only_named=True,
    ),
}
"""Benchmarks by the name that the command line takes."""


def bench(
    names: Annotated[
        tuple[str, ...],
        tyro.conf.Positional,
        tyro.conf.arg(metavar="NAME…", help="All but `cases` and `page`, which take minutes."),
    ] = (),
    scenes: ScenesOpt = None,
    json: JsonOpt = False,
) -> int:
    """Measure ratios on the furnished house (--scenes) or on the largest built-in house."""
    unknown = [name for name in names if name not in BENCHES]
    if unknown:
        message = f"expected benchmarks among {', '.join(BENCHES)}; came {', '.join(unknown)}"
        raise UsageError(message)
    found: dict[str, float | None] = {}
    usual = tuple(name for name, each in BENCHES.items() if not each.only_named)
    for name in names or usual:
        found.update(_measured(BENCHES[name], scenes or _shared_scenes()))
    if json:
        print_json(found)
        return 0
    table = Table(box=None, header_style="bold")
    table.add_column("ratio")
    table.add_column("value", justify="right")
    for key, value in found.items():
        table.add_row(key, "–" if value is None else f"{value:.3g}")
    Console().print(table)
    return 0


def _shared_scenes() -> Path | None:
    """The scenes folder beside a checkout, where there is one."""
    beside = Path.cwd().parent / "shared" / "scenes"
    return beside if (beside / HOUSE).is_file() else None


def _measured(one: Bench, scenes: Path | None) -> Measured:
    """Values by key; null with a reason on standard error where something is missing."""
    try:
        values = one.measure(scenes)
    except (MissingExtra, C2NavError) as error:
        sys.stderr.write(f"{', '.join(one.keys)}: {error}\n")
        values = dict.fromkeys(one.keys)
    return {key: values.get(key) for key in one.keys}
