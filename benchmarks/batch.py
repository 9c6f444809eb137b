"""What a batch costs beside its episodes, and what workers and lanes gain.

    python -m benchmarks.batch [SCENES]

Every ratio is measured side by side in one run, so a busy machine slows both sides alike.
`c2nav bench` imports `measure` and `measure_lanes`.
"""

from __future__ import annotations

import json
import sys
import tempfile
import threading
import time
from collections.abc import Generator, Sequence
from contextlib import closing, contextmanager
from dataclasses import replace
from functools import partial
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from c2nav_engine.experiments.executors.lanes import run_here
from c2nav_engine.experiments.executors.processes import Job, WorkerProcess
from c2nav_engine.experiments.ledger import Ledger
from c2nav_engine.experiments.spec import Setting, Task
from c2nav_engine.experiments.working import (
    Finished,
    Simulating,
    Stopping,
    never,
    work,
    workbench_of,
)
from c2nav_engine.geometry import Pinhole
from c2nav_engine.runner.opening import Workbench
from c2nav_engine.runner.recorded import open_trace
from c2nav_engine.runner.worlds import Worlds, WorldsConfig
from c2nav_engine.sensing.renderer import Image

LATENCY_S = 0.2
"""Of the made-up model server."""
LANES = 8
STEPS = 60
"""Low-level actions of an episode in the lanes' benchmark."""


def measure(scenes: Path | None = None, *, rounds: int = 1, seeds: int = 3) -> dict[str, float]:
    """`workers2_over_1`: episodes a second with two workers over one.

    Both workers are warm; each in turn runs the same episodes alone, then both run them at once.

    Args:
        scenes: The shared scenes folder with the furnished house; the built-in houses without it.
        rounds: How often.
        seeds: Episodes a worker in each.
    """
    setting, episode = _setting(scenes)
    with tempfile.TemporaryDirectory() as folder:
        crew = [WorkerProcess(Job(work, Path(folder) / str(n)), threads=1) for n in range(2)]
        try:
            tasks = [Task(setting, episode, "full", seed) for seed in range(seeds + 1)]
            _seconds(crew, tasks[:1])
            one_s = two_s = 0.0
            for _ in range(rounds):
                one_s += sum(_seconds([worker], tasks[1:]) for worker in crew)
                two_s += _seconds(crew, tasks[1:])
        finally:
            for worker in crew:
                worker.end()
    return {"workers2_over_1": one_s / two_s}


def _setting(scenes: Path | None) -> tuple[Setting, str]:
    beside = scenes.parent / "data" / "furnished_house_8.json.gz" if scenes else None
    if scenes is not None and beside is not None and beside.is_file():
        return Setting(str(beside.resolve()), scenes=str(scenes.resolve())), "3"
    return Setting("builtin"), "1"


def _seconds(crew: Sequence[WorkerProcess], tasks: Sequence[Task]) -> float:
    """Wall time until every worker has run all of these tasks."""
    start_s = time.perf_counter()
    for worker in crew:
        for task in tasks:
            worker.give(task)
    for worker in crew:
        for _ in tasks:
            finished = worker.take()
            if finished is None or finished.error:
                raise RuntimeError(f"expected a finished episode, came {finished}")
    return time.perf_counter() - start_s


def overhead_ms(*, tasks: int = 200) -> float:
    """Milliseconds a task of queueing, a pipe to a worker and two ledger entries."""
    setting = Setting("builtin", ranker="scripted")
    given = [Task(setting, str(number), "full", 0) for number in range(tasks)]
    with tempfile.TemporaryDirectory() as folder:
        worker = WorkerProcess(Job(_nothing, Path(folder)), threads=1)
        try:
            with closing(Ledger(Path(folder) / "ledger.sqlite")) as ledger:
                ledger.add((task.key, task.name) for task in given)
                for task in given[:10]:
                    _one(worker, ledger, task)
                start_s = time.perf_counter()
                for task in given:
                    _one(worker, ledger, task)
                spent_s = time.perf_counter() - start_s
        finally:
            worker.end()
    return 1e3 * spent_s / tasks


def _one(worker: WorkerProcess, ledger: Ledger, task: Task) -> None:
    ledger.lease(task.key)
    worker.give(task)
    finished = worker.take()
    if finished is not None:
        ledger.finish(finished.key, finished.row)


def _nothing(task: Task, folder: Path, stop: Stopping) -> Finished:
    del folder, stop
    return Finished(task.key, {"episode_id": task.episode_id, "outcome": "stopped"})


# ---------------------------------------------------------------- episodes that wait for a model


class _Flat:
    """Pictures at no cost: what is measured is waiting, not rendering."""

    name = "flat"

    def render(
        self,
        world_from_cameras: Sequence[Float[np.ndarray, "4 4"]],
        *,
        rgb: Pinhole,
        depth: Pinhole,
        near_m: float,
        far_m: float,
        depth_stride: int = 1,
    ) -> list[Image]:
        """Grey, three metres away."""
        del near_m, far_m
        colour = np.full((rgb.height_px, rgb.width_px, 3), 128, np.uint8)
        whole_m = np.full((depth.height_px, depth.width_px), 3.0, np.float32)
        depth_m = whole_m[::depth_stride, ::depth_stride]
        return [Image(colour, depth_m, matrix) for matrix in world_from_cameras]


def _flat_bench(setting: Setting, run: Path) -> Workbench:
    bench = workbench_of(setting, run)
    profile = replace(bench.profile, max_steps=STEPS)
    config = WorldsConfig(profile, renderer=lambda _scene: _Flat())
    return replace(bench, profile=profile, worlds=Worlds(bench.source, config))


def measure_lanes(_scenes: Path | None = None) -> dict[str, float]:
    """`lanes8_over_1`: episodes that wait for a model, eight at once over one at a time."""
    return {"lanes8_over_1": lanes_over_one()}


def lanes_over_one(*, episodes: int = LANES) -> float:
    """Episodes a second with eight queries at once over one at a time, at 200 ms a query."""
    with _model_server() as address, tempfile.TemporaryDirectory() as folder:
        spent_s: dict[int, float] = {}
        for lanes in (1, LANES):
            options = {
                "base_url": address,
                "model": "made-up",
                "probe": "false",
                "concurrency": str(lanes),
            }
            setting = Setting("builtin", ranker="openai-chat", ranker_options=options)
            tasks = [Task(setting, "1", "full", seed) for seed in range(episodes)]
            simulating = Simulating(_flat_bench)
            # House and floor are ready before the clock starts.
            simulating.work(replace(tasks[0], seed=999), Path(folder) / "warm", never)
            run = partial(run_here, started=lambda _task: None, work=simulating.work)
            start_s = time.perf_counter()
            results = list(run(tasks, Path(folder) / str(lanes), lanes=lanes))
            spent_s[lanes] = time.perf_counter() - start_s
            if any(finished.error for finished in results):
                raise RuntimeError(f"expected finished episodes, came {results}")
    return spent_s[1] / spent_s[LANES]


@contextmanager
def _model_server() -> Generator[str]:
    """A server on loopback that thinks for 200 ms and says "A > B > C"."""

    class Handler(BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"
        disable_nagle_algorithm = True

        def do_POST(self) -> None:
            """Answer any completion."""
            body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
            time.sleep(LATENCY_S)
            text = json.dumps(_answer(body)).encode()
            self.send_response(200)
            self.send_header("Content-Type", "application/json")
            self.send_header("Content-Length", str(len(text)))
            self.end_headers()
            self.wfile.write(text)

        def log_request(self, code: object = "-", size: object = "-") -> None:
            """Say nothing."""

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        yield f"http://127.0.0.1:{server.server_port}/v1"
    finally:
        server.shutdown()
        server.server_close()


def _answer(body: dict[str, Any]) -> dict[str, Any]:
    """The labels as they stand, as the wanted schema has them."""
    words = "".join(
        part.get("text", "") for part in body["messages"][0]["content"] if part["type"] == "text"
    )
    count = max(2, sum(f"View {label}" in words or f"\n{label}. " in words for label in "ABCDEF"))
    ranking = " > ".join("ABCDEF"[:count])
    return {
        "id": "x",
        "object": "chat.completion",
        "created": 0,
        "model": "made-up",
        "choices": [
            {
                "index": 0,
                "finish_reason": "stop",
                "message": {"role": "assistant", "content": ranking},
            }
        ],
        "usage": {"prompt_tokens": 100, "completion_tokens": 7, "total_tokens": 107},
    }


def core_s_a_view(*, episodes: int = 2) -> float:
    """Core seconds a rendered view, recording and all, on a built-in house."""
    setting = Setting("builtin")
    simulating = Simulating()
    with tempfile.TemporaryDirectory() as folder:
        run = Path(folder)
        simulating.work(Task(setting, "1", "full", 99), run, never)
        views, start_s = 0, time.process_time()
        for seed in range(episodes):
            simulating.work(Task(setting, "1", "full", seed), run, never)
        spent_s = time.process_time() - start_s
        for path in (run / "traces").glob("*.mcap"):
            if not path.name.endswith(".99.mcap"):
                with open_trace(path) as trace:
                    looks = (exchange.response for exchange in trace.exchanges())
                    views += sum(len(getattr(seen, "views", ())) for seen in looks)
    return spent_s / views


def main() -> None:
    """Print one table."""
    scenes = Path(sys.argv[1]) if len(sys.argv) > 1 else None
    rows = {
        "workers2_over_1": measure(scenes)["workers2_over_1"],
        **measure_lanes(),
        "task_overhead_ms": overhead_ms(),
        "core_s_a_view": core_s_a_view(),
    }
    for name, value in rows.items():
        print(f"{name:24} {value:.4f}")


if __name__ == "__main__":
    main()
