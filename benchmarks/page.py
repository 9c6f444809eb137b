"""What the page takes: from click to pictures, scrubbing, asking a place, opening, memory.

    python -m benchmarks.page [SCENES] [--only step,trace] [--steps 1000] [--json]

The server runs as a user would start it, before a headless Chromium with software WebGL on the
same cores. Processor time is the server's own; on a machine that others use too, wall-clock times
are upper bounds and processor times are not.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from benchmarks.scenes import rough_house, write_glb
from benchmarks.served import Served, chromium, opened, served
from c2nav_engine.episodes.episode import Episode
from c2nav_engine.episodes.files import EpisodeFile
from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.experiments.rankers import seats_for
from c2nav_engine.geometry import Pose
from c2nav_engine.runner.episode_run import run_to_end
from c2nav_engine.runner.opening import OpenSpec, Workbench
from c2nav_engine.runner.recording import TraceWriter
from c2nav_engine.runner.source import Source, open_source
from c2nav_engine.runner.worlds import Worlds, WorldsConfig

RECORDED_STEPS = 720
"""Low-level steps of the recording that is scrubbed, asked and opened: some 300 decisions."""

MOVES = 300
"""Of the pointer, in one scrub over it."""

SCRUBS = 5
"""The page goes back to the start before each. Each ends at a decision that none before it passed,
so that no picture of it is in the browser's cache."""

FURTHER = 5
"""Decisions by which each scrub ends behind the one before."""

WARM_UP = 20
"""Steps before anything is counted: caches fill, code is compiled."""

LARGE_TRIANGLES = 1_000_000

Figures = dict[str, float]


@dataclass(frozen=True, slots=True)
class Plan:
    """What is measured on what.

    Attributes:
        browser: A running Chromium.
        folder: For recordings and what the server writes.
        scenes: The folder of scenes with the furnished house; the built-in houses without it.
        clicks: Steps that are timed.
        steps: Steps over which memory is watched.
    """

    browser: Any
    folder: Path
    scenes: Path | None
    clicks: int = 100
    steps: int = 1000

    @property
    def source(self) -> str:
        """What `inspect` and `run` are given."""
        if self.scenes is None:
            return "builtin"
        return str((self.scenes.parent / "data" / "furnished_house_8.json.gz").resolve())

    @property
    def words(self) -> list[str]:
        """The source's options."""
        return [] if self.scenes is None else ["--scenes", str(self.scenes.resolve())]


# ---------------------------------------------------------------- stepping


def step(plan: Plan) -> Figures:
    """A click on Step until the next decision's pictures stand in the strip.

    A person clicks on a page at rest. "At once" is the worst case, as with a key held down: the
    next click comes while the map of the last step is still being drawn, on the same cores.
    """
    words = [plan.source, *plan.words, "--ranker", "scripted"]
    with (
        served(words, cwd=plan.folder) as server,
        opened(plan.browser, server.url) as page,
    ):
        _clicks(page, WARM_UP)
        rested_ms = _clicks(page, plan.clicks, rested=True)
        before_s = server.processor_s()
        at_once_ms = _clicks(page, plan.clicks)
        spent_s = server.processor_s() - before_s
    return {
        "step_click_to_picture_p50_ms": float(np.percentile(rested_ms, 50)),
        "step_click_to_picture_p95_ms": float(np.percentile(rested_ms, 95)),
        "step_at_once_p50_ms": float(np.percentile(at_once_ms, 50)),
        "step_at_once_p95_ms": float(np.percentile(at_once_ms, 95)),
        "step_server_processor_ms": 1e3 * spent_s / len(at_once_ms),
    }


# −1 where the episode was over, or ended with this step.
_CLICK = """
async () => {
  const label = (one) => one.textContent.trim() === "Step";
  const button = [...document.querySelectorAll("[data-command]")].find(label);
  const before = c2nav.state.decision.number;
  const over = () => !c2nav.state.branch.running;
  const there = () => over() || (c2nav.state.decision.number > before && c2bench.filled());
  if (over()) return -1;
  const taken = await c2bench.timed(() => button.click(), there);
  return over() ? -1 : taken;
}
"""


def _clicks(page: Any, count: int, *, rested: bool = False) -> list[float]:
    """Milliseconds of so many steps; the next episode is opened where one ends."""
    ready = "!c2nav.state.asking" + (" && c2bench.rested()" if rested else "")
    times_ms: list[float] = []
    while len(times_ms) < count:
        page.wait_for_function(ready)
        taken_ms = page.evaluate(_CLICK)
        if taken_ms < 0:
            _open_next(page)
        else:
            times_ms.append(taken_ms)
    return times_ms


def _open_next(page: Any) -> None:
    was = page.evaluate("c2nav.state.episode.id")
    page.evaluate("id => c2nav.send('open', {entry: id})", str(int(was) % 8 + 1))
    page.wait_for_function("was => c2nav.state.episode.id !== was && c2bench.filled()", arg=was)


def memory(plan: Plan) -> Figures:
    """How the server's memory grows while a page follows step after step."""
    words = [plan.source, *plan.words, "--ranker", "scripted"]
    with (
        served(words, cwd=plan.folder) as server,
        opened(plan.browser, server.url) as page,
    ):
        # One whole round of episodes first: each scene, once loaded, stays.
        for _ in range(2):
            _clicks(page, WARM_UP)
            _open_next(page)
        before_mb = server.memory_mb()
        _clicks(page, plan.steps)
        grown_mb = server.memory_mb() - before_mb
    return {"memory_growth_mb": grown_mb, "memory_steps": float(plan.steps)}


# ---------------------------------------------------------------- a recording


def recording(plan: Plan) -> Path:
    """A recording of some 300 decisions, made once a run."""
    path = plan.folder / "long.mcap"
    if not path.is_file():
        source = open_source(plan.source, scenes=plan.scenes)
        record(source, path, max_steps=RECORDED_STEPS)
    return path


def record(source: Source, path: Path, *, max_steps: int) -> None:
    """Record so many steps of the source's first episode with a scripted ranker."""
    profile = replace(VLNCE, max_steps=max_steps)
    bench = Workbench(
        source=source,
        worlds=Worlds(source, WorldsConfig(profile)),
        profile=profile,
        seat_for=seats_for("scripted"),
        recorder_for=TraceWriter,
    )
    run_to_end(bench.open(OpenSpec(source.file.episodes[0].episode_id, trace=path)))


@contextmanager
def _replayed(plan: Plan) -> Generator[tuple[Served, Any]]:
    words = [str(recording(plan)), *plan.words]
    with (
        served(words, cwd=plan.folder) as server,
        opened(plan.browser, server.url) as page,
    ):
        yield server, page


def trace(plan: Plan) -> Figures:
    """`inspect TRACE` until strip, pictures and timeline stand, from the start of the process."""
    path = recording(plan)
    with (
        served([str(path), *plan.words], cwd=plan.folder) as server,
        opened(plan.browser, server.url),
    ):
        usable_s = time.perf_counter() - server.begun_s
        spent_s = server.processor_s()
    return {"trace_usable_s": usable_s, "trace_server_processor_s": spent_s}


_SCRUB = """
async ([moves, further]) => {
  const bar = document.querySelector("timeline-bar");
  const box = bar.getBoundingClientRect();
  const marks = c2nav.state.timeline.marks;
  const target = marks[marks.length - 1 - (marks.length >> 3) + further];
  const fire = (node, type, step) => node.dispatchEvent(new PointerEvent(type, {
    bubbles: true, clientX: box.left + bar.x(step), clientY: box.top + 60, button: 0, pointerId: 1,
  }));
  fire(bar.shadowRoot.querySelector("svg"), "pointerdown", 0);
  for (let move = 1; move < moves; move++) {
    fire(window, "pointermove", Math.round((target.step * move) / moves));
    await new Promise((next) => setTimeout(next, 4));
  }
  const there = () => c2nav.state.place.step === target.step && c2bench.filled();
  const last = () => { fire(window, "pointermove", target.step); fire(window, "pointerup", 0); };
  const taken = await c2bench.timed(last, there);
  await new Promise((next) => setTimeout(next, 500));
  return [taken, Number(there())];
}
"""


def scrub(plan: Plan) -> Figures:
    """Dragging over the recording: from the last move until its decision stands on the page."""
    scrubs: list[tuple[float, int]] = []
    with _replayed(plan) as (server, page):
        page.wait_for_function("'/scene/section' in (window.__viserSceneTree?.getState() ?? {})")
        before_s = server.processor_s()
        for number in range(SCRUBS):
            scrubs.append(page.evaluate(_SCRUB, [MOVES, FURTHER * number]))
            page.evaluate("c2nav.send('go', {step: 0})")
            page.wait_for_function("c2nav.state.place.step === 0 && c2bench.filled()")
        decisions = page.evaluate("c2nav.state.timeline.marks.length")
        spent_s = server.processor_s() - before_s
    return {
        "scrub_settled_ms": float(np.median([settled_ms for settled_ms, _ in scrubs])),
        "scrub_ends_right": min(right for _, right in scrubs),
        "scrub_decisions": decisions,
        "scrub_server_processor_ms": 1e3 * spent_s / SCRUBS,
    }


_PLACE = """
() => c2bench.timed(
  () => c2nav.send("place", { goal: true }),
  () => c2nav.state.timeline.place && !c2nav.state.working,
)
"""


def place(plan: Plan) -> Figures:
    """Where the goal was in view, over all looks of the recording; the scene is ready before."""
    with _replayed(plan) as (server, page):
        page.wait_for_function("'/scene/part0' in (window.__viserSceneTree?.getState() ?? {})")
        page.evaluate(_PLACE)
        times_ms: list[float] = []
        before_s = server.processor_s()
        for _ in range(5):
            page.evaluate("c2nav.send('forget_place')")
            page.wait_for_function("!c2nav.state.timeline.place")
            times_ms.append(page.evaluate(_PLACE))
        spent_s = server.processor_s() - before_s
    return {
        "place_asked_ms": float(np.median(times_ms)),
        "place_server_processor_ms": 1e3 * spent_s / len(times_ms),
    }


# ---------------------------------------------------------------- a large scene


def large(plan: Plan) -> Figures:
    """A scan of a million triangles: until the last part of it stands in the map."""
    folder = plan.folder / "large"
    folder.mkdir()
    write_glb(folder / "scan.glb", rough_house(LARGE_TRIANGLES))
    path = plan.folder / "large.mcap"
    file = EpisodeFile("large", (_across(),), sha256="", headings="", extra={})
    record(Source(file, folder, {}, "reference path"), path, max_steps=12)
    with (
        served([str(path), "--scenes", str(folder)], cwd=plan.folder) as server,
        opened(plan.browser, server.url) as page,
    ):
        before_s = time.perf_counter()
        usable_s = before_s - server.begun_s
        page.wait_for_function("'/scene/section' in (window.__viserSceneTree?.getState() ?? {})")
        shown_s = time.perf_counter() - server.begun_s
        return {
            "large_usable_s": usable_s,
            "large_shown_s": shown_s,
            "large_server_processor_s": server.processor_s(),
            "large_server_peak_mb": server.peak_mb(),
        }


def _across() -> Episode:
    start, goal = (2.5, 0.0, 2.5), (2.5, 0.0, 17.5)
    return Episode(
        episode_id="1",
        trajectory_id="1",
        scene_id="scan.glb",
        start=Pose(start, np.pi),
        instruction="Walk through the rooms and stop in the last one.",
        goal_m=goal,
        geodesic_m=15.0,
        reference_path_m=(start, goal),
    )


# ---------------------------------------------------------------- all of it

PARTS: dict[str, Callable[[Plan], Figures]] = {
    "trace": trace,
    "step": step,
    "scrub": scrub,
    "place": place,
    "large": large,
    "memory": memory,
}

BARS = {
    "step_click_to_picture_p50_ms": 150.0,
    "step_click_to_picture_p95_ms": 300.0,
    "scrub_settled_ms": 200.0,
    "place_asked_ms": 200.0,
    "trace_usable_s": 4.0,
    "large_shown_s": 5.0,
    "large_server_peak_mb": 1500.0,
    "memory_growth_mb": 50.0,
}
"""What each figure should stay below on two cores that nobody else uses."""


def measure(
    scenes: Path | None = None, *, parts: Sequence[str] = tuple(PARTS), steps: int = 1000
) -> Figures:
    """Every figure by name.

    Args:
        scenes: The folder of scenes with the furnished house; the built-in houses without it.
        parts: Which parts of the table.
        steps: Steps over which memory is watched.
    """
    found: Figures = {}
    with tempfile.TemporaryDirectory() as folder, chromium() as browser:
        plan = Plan(browser, Path(folder), scenes, steps=steps)
        for part in parts:
            found |= PARTS[part](plan)
    return found


def measure_step(scenes: Path | None = None) -> Figures:
    """The step alone, which takes a minute."""
    return measure(scenes, parts=("step",))


def measure_rest(scenes: Path | None = None) -> Figures:
    """Everything but the step, which takes many minutes."""
    return measure(scenes, parts=tuple(part for part in PARTS if part != "step"))


def main() -> None:
    reader = argparse.ArgumentParser(description=__doc__)
    reader.add_argument("scenes", type=Path, nargs="?")
    reader.add_argument("--only", default=",".join(PARTS), help="parts of the table")
    reader.add_argument("--steps", type=int, default=1000, help="for the growth of memory")
    reader.add_argument("--json", action="store_true", help="one JSON object instead of a table")
    given = reader.parse_args()
    figures = measure(given.scenes, parts=given.only.split(","), steps=given.steps)
    if given.json:
        print(json.dumps(figures))
        return
    table = Table("figure", "value", "bar", title="the page on this machine")
    for name, value in figures.items():
        table.add_row(name, f"{value:.4g}", f"{BARS[name]:g}" if name in BARS else "")
    Console().print(table)


if __name__ == "__main__":
    main()
