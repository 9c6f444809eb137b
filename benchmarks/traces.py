"""What writing and reading a trace costs.

    python -m benchmarks.traces TRACE.mcap [--seeks 300] [--seed 0] [--json]

Writing is measured by writing the trace's exchanges again; divide by the episode's own time for a
share. The bytes of all decisions are counted where they are read, index and footer included.
`c2nav bench traces` records an episode first and imports `measure`.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from benchmarks.cycle import benched_episode
from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.experiments.rankers import seats_for
from c2nav_engine.runner.episode_run import run_to_end
from c2nav_engine.runner.opening import OpenSpec, Workbench
from c2nav_engine.runner.recorded import Trace, open_trace, read_trace
from c2nav_engine.runner.recording import TraceWriter
from c2nav_engine.runner.worlds import Worlds, WorldsConfig
from c2nav_engine.traces import check


def measure(scenes: Path | None = None) -> dict[str, float]:
    """What reading decisions takes, on an episode that is recorded first.

    Args:
        scenes: The shared scenes folder with the furnished house; the built-in houses without it.
    """
    source, episode_id = benched_episode(scenes)
    bench = Workbench(
        source=source,
        worlds=Worlds(source, WorldsConfig(VLNCE)),
        profile=VLNCE,
        seat_for=seats_for("reference-cv"),
        recorder_for=TraceWriter,
    )
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bench.mcap"
        run_to_end(bench.open(OpenSpec(episode_id, trace=path)))
        return {
            "decision_bytes_share": decision_bytes_share(path),
            "decision_seek_ms": 1e3 * seek_s(path, seeks=300, seed=0),
            "trace_open_ms": 1e3 * best_s(lambda: open_trace(path).close(), repeats=20),
        }


def decision_bytes_share(path: Path) -> float:
    """Bytes read for all decisions, without their pictures, over the trace's size."""
    with open_trace(path) as opened:
        for _ in opened.decisions():
            pass
        return opened.file.bytes_read / opened.file.size_bytes


def figures(path: Path, *, seeks: int, seed: int) -> dict[str, float]:
    """Every figure of a trace by name, seconds and shares."""
    trace = read_trace(path)
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "again.mcap"
        write_s = best_s(lambda: write(target, trace), repeats=3)
        synced_s = best_s(lambda: write(target, trace, fsync=True), repeats=3)
    return {
        "megabytes": path.stat().st_size / 1e6,
        "exchanges": len(trace.exchanges),
        "decision_bytes_share": decision_bytes_share(path),
        "decision_seek_ms": 1e3 * seek_s(path, seeks=seeks, seed=seed),
        "open_ms": 1e3 * best_s(lambda: open_trace(path).close(), repeats=20),
        "read_all_ms": 1e3 * best_s(lambda: read_trace(path), repeats=3),
        "check_ms": 1e3 * best_s(lambda: check(path), repeats=3),
        "write_ms": 1e3 * write_s,
        "write_ms_an_exchange": 1e3 * write_s / len(trace.exchanges),
        "write_fsync_ms": 1e3 * synced_s,
    }


def write(target: Path, trace: Trace, *, fsync: bool = False) -> None:
    """Write a trace's exchanges again."""
    with TraceWriter(target, trace.header, fsync=fsync) as writer:
        for exchange in trace.exchanges:
            writer.write(exchange)
        writer.finish(trace.footer)


def seek_s(path: Path, *, seeks: int, seed: int) -> float:
    """Median time to one random decision with all its pictures, in a trace that is open.

    No opened chunk is kept between two seeks: the reader has moved on in between.
    """
    generator = np.random.default_rng(seed)
    times: list[float] = []
    with open_trace(path) as trace:
        for number in generator.integers(0, trace.decision_count, seeks).tolist():
            trace.file.forget()
            begun = time.perf_counter()
            trace.decision(number)
            times.append(time.perf_counter() - begun)
    return float(np.median(times))


def best_s(task: Callable[[], object], *, repeats: int) -> float:
    """Shortest of several runs."""
    times: list[float] = []
    for _ in range(repeats):
        begun = time.perf_counter()
        task()
        times.append(time.perf_counter() - begun)
    return min(times)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("trace", type=Path)
    parser.add_argument("--seeks", type=int, default=300, help="random decisions (default 300)")
    parser.add_argument("--seed", type=int, default=0, help="which ones (default 0)")
    parser.add_argument("--json", action="store_true", help="one JSON object instead of a table")
    options = parser.parse_args()
    found = figures(options.trace, seeks=options.seeks, seed=options.seed)
    if options.json:
        print(json.dumps(found))
        return
    table = Table("figure", "value", title=f"{options.trace.name}")
    for name, value in found.items():
        table.add_row(name, f"{value:.4g}")
    Console().print(table)


if __name__ == "__main__":
    main()
