"""How long a person who judges waits for the next question.

    python -m benchmarks.judging RUN [--per-slot 67] [--seed 0] [--json]

Times the whole reply to an answer, in process: the answer is stored durably, the next question is
picked and its pictures are encoded. Reading ahead is part of it, thinking is not: the answers
follow each other at once, which is the worst that a person can do. The browser's own drawing is
not in it. Processor time is the mean of client and server together; on a machine that others use
too, the other times are upper bounds and this one is not.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table
from starlette.testclient import TestClient

from app.gateway.judging import desks_of, judging_application
from app.reviews.study import add_person, make_study


def measure(run: Path, *, per_slot: int, seed: int) -> dict[str, float]:
    """Milliseconds by name; the run's own folder is left alone."""
    with tempfile.TemporaryDirectory() as folder:
        beside = Path(folder) / "run"
        beside.mkdir()
        (beside / "traces").symlink_to((run / "traces").resolve())
        study = make_study([beside], name="bench", per_slot=per_slot, seed=seed, repeat=0.1)
        _, token = add_person(study, "nobody")
        begun = time.perf_counter()
        app = judging_application(desks_of([beside]))
        with TestClient(app, base_url="http://127.0.0.1") as client:
            client.headers["X-Judge-Token"] = token
            shown = client.post("/judge/next").json()
            first_s = time.perf_counter() - begun
            times_s: list[float] = []
            begun_processor_s = time.process_time()
            while "question" in shown:
                answer = {
                    "id": f"{shown['number']:032x}",
                    "number": shown["number"],
                    "tiers": [[label] for label in shown["question"]["labels"]],
                }
                begun = time.perf_counter()
                reply = client.post("/judge/answer", json=answer)
                times_s.append(time.perf_counter() - begun)
                shown = reply.json()
            processor_s = time.process_time() - begun_processor_s
    return {
        "questions": len(times_s),
        "first_question_ms": 1e3 * first_s,
        "next_question_p50_ms": 1e3 * float(np.quantile(times_s, 0.5)),
        "next_question_p95_ms": 1e3 * float(np.quantile(times_s, 0.95)),
        "next_question_most_ms": 1e3 * max(times_s),
        "next_question_processor_ms": 1e3 * processor_s / len(times_s),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("run", type=Path)
    parser.add_argument("--per-slot", type=int, default=67, help="decisions (default 67)")
    parser.add_argument("--seed", type=int, default=0, help="of the draw (default 0)")
    parser.add_argument("--json", action="store_true", help="one JSON object instead of a table")
    options = parser.parse_args()
    figures = measure(options.run, per_slot=options.per_slot, seed=options.seed)
    if options.json:
        print(json.dumps(figures))
        return
    table = Table("figure", "value", title=f"{options.run.name}")
    for name, value in figures.items():
        table.add_row(name, f"{value:.4g}")
    Console().print(table)


if __name__ == "__main__":
    main()
