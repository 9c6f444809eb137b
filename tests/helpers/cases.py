"""Made-up rows of the index, and small run folders to read them from."""

from __future__ import annotations

import sqlite3
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from app.pages.index.columns import Row, Value
from app.pages.index.store import Store
from c2nav_engine.experiments.tags.endings import Ending
from c2nav_engine.experiments.tags.rules import TAGS
from tests.helpers.exchanges import write_fake

VARIANTS = ("full", "no-seeing", "no-arriving")
PLACES = ("kitchen", "bedroom", "hall", "sofa", "stairs")


def made_rows(count: int, *, seed: int = 5) -> list[Row]:
    """Rows with every column set as a run of that many episodes would set them."""
    generator = np.random.default_rng(seed)
    endings = [ending.value for ending in Ending]
    made: list[Row] = []
    for number in range(count):
        ending = endings[int(generator.integers(len(endings)))]
        variant = VARIANTS[number % 3]
        values: dict[str, Value] = {
            "run": f"run-{number % 7}",
            "episode_id": str(number // 3),
            "scene_id": f"builtin/{number % 12}",
            "variant": variant,
            "ranker": "openai-chat:Qwen/Qwen3-VL-8B-Instruct",
            "profile": "vlnce",
            "outcome": "stopped",
            "ending": ending,
            "trace_sha256": f"{number:064x}",
            "seed": 0,
            "success": int(ending == Ending.SUCCESS),
            "os": int(generator.integers(2)),
            "steps": int(generator.integers(20, 500)),
            "queries": int(generator.integers(5, 90)),
            "ne_m": round(float(generator.uniform(0.1, 14.0)), 3),
            "spl": round(float(generator.uniform()), 3),
            **{tag: _three_way(generator) for tag in TAGS},
        }
        words = f"Walk to the {PLACES[number % 5]} and wait by door {number}."
        made.append(Row(f"run-{number % 7}/traces/{number}.{variant}.0.mcap", values, words))
    return made


def _three_way(generator: np.random.Generator) -> int | None:
    drawn = int(generator.integers(10))
    return None if drawn == 9 else int(drawn < 2)


def filled(root: Path, rows: Sequence[Row]) -> Store:
    """An index of these rows."""
    root.mkdir(parents=True, exist_ok=True)
    store = Store(root)
    store.put_all((row, 1, 1) for row in rows)
    return store


def fake_run(run: Path, *, episodes: int = 2, cycles: int = 2) -> list[Path]:
    """A run folder of made-up traces; their scene is not to be had."""
    (run / "traces").mkdir(parents=True)
    paths = [run / "traces" / f"{number}.full.0.mcap" for number in range(episodes)]
    for number, path in enumerate(paths):
        write_fake(path, cycles, seed=number)
    return paths


def failed_task(run: Path, name: str) -> None:
    """A ledger with one task that failed before it left a trace."""
    with sqlite3.connect(run / "ledger.sqlite") as db:
        db.execute("create table tasks (key text, name text, state text, row text, error text)")
        row = '{"episode_id": "9", "scene_id": "lost", "variant": "full", "seed": 0, '
        row += '"ranker": "m", "outcome": "error"}'
        db.execute("insert into tasks values ('k', ?, 'failed', ?, 'no scene')", (name, row))
    db.close()
