"""What a navigation cycle costs beside its pictures, and what recording it costs.

    python -m benchmarks.cycle [SCENES]

One episode is run with a scripted ranker and a trace. The time inside the renderer and the time
inside the trace writer are taken apart from the whole, in the same run.
"""

from __future__ import annotations

import sys
import tempfile
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.experiments.rankers import seats_for
from c2nav_engine.runner.episode_run import run_to_end
from c2nav_engine.runner.opening import OpenSpec, Workbench
from c2nav_engine.runner.record import Footer, Header
from c2nav_engine.runner.recording import TraceWriter
from c2nav_engine.runner.source import Source, open_source
from c2nav_engine.runner.worlds import Worlds, WorldsConfig, embree
from c2nav_engine.world.scene import Scene

STEPS = 120
"""Low-level actions of the measured episode; the first cycle is left out as a warm-up."""


@dataclass
class Clock:
    """Seconds spent inside something, over many calls."""

    spent_s: float = 0.0

    def around(self, call: Any) -> Any:
        """The same callable, timed."""

        def timed(*args: Any, **named: Any) -> Any:
            start_s = time.perf_counter()
            try:
                return call(*args, **named)
            finally:
                self.spent_s += time.perf_counter() - start_s

        return timed


class TimedWriter:
    """A trace writer whose time is counted."""

    def __init__(self, path: Path, header: Header, clock: Clock) -> None:
        self._writer = TraceWriter(path, header)
        self.write = clock.around(self._writer.write)
        self._finish = clock.around(self._writer.finish)
        self.attach = self._writer.attach
        self.abandon = self._writer.abandon

    def finish(self, footer: Footer) -> str:
        """Complete the trace."""
        return self._finish(footer)


def measure(scenes: Path | None = None) -> dict[str, float]:
    """`cycle_over_render` and `trace_over_cycle` of one episode.

    Args:
        scenes: The shared scenes folder with the furnished house; the built-in houses without it.
    """
    rendering, writing = Clock(), Clock()

    def renderer(scene: Scene) -> Any:
        made = embree(scene)
        made.render = rendering.around(made.render)  # pyright: ignore
        return made

    source, episode_id = benched_episode(scenes)
    profile = replace(VLNCE, max_steps=STEPS)
    bench = Workbench(
        source=source,
        worlds=Worlds(source, WorldsConfig(profile, renderer=renderer)),
        profile=profile,
        seat_for=seats_for("scripted"),
        recorder_for=lambda path, header: TimedWriter(path, header, writing),
    )
    run_to_end(bench.open(OpenSpec(episode_id)))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cycle.mcap"
        run = bench.open(OpenSpec(episode_id, trace=path))
        rendering.spent_s = writing.spent_s = 0.0
        start_s = time.perf_counter()
        run_to_end(run)
        whole_s = time.perf_counter() - start_s
    return {
        "cycle_over_render": whole_s / rendering.spent_s,
        "trace_over_cycle": writing.spent_s / whole_s,
    }


def benched_episode(scenes: Path | None) -> tuple[Source, str]:
    """An episode of the furnished house where it is to be had, else a built-in one."""
    beside = scenes.parent / "data" / "furnished_house_8.json.gz" if scenes else None
    if beside is not None and beside.is_file():
        return open_source(str(beside), scenes=scenes), "3"
    return open_source("builtin"), "1"


def main() -> None:
    """Print one table."""
    scenes = Path(sys.argv[1]) if len(sys.argv) > 1 else None
    for name, value in measure(scenes).items():
        print(f"{name:24} {value:.3f}")


if __name__ == "__main__":
    main()
