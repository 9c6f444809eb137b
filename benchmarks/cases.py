"""How long `/cases` takes to filter, count and sort an index, page included.

python -m benchmarks.cases [--rows 2000 100000] [--json]

Rows are made up, because a hundred thousand episodes would take weeks to run; every column and
every automatic tag is set as in a real index. Each query is asked of an open index seven times,
page by page; the shortest counts, so that a busy machine says little of it.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from app.pages.index.columns import Row, Value
from app.pages.index.finding import PAGE, Finder
from app.pages.index.query import Query
from app.pages.index.store import Store
from c2nav_engine.experiments.tags.endings import Ending
from c2nav_engine.experiments.tags.rules import TAGS

SIZES = (2_000, 100_000)
REPEATS = 7
QUERIES: Mapping[str, Query] = {
    "all": Query(),
    "one ending, farthest first": Query('ending:"step limit"', "-ne_m"),
    "a tag and a range": Query("tag:oscillation ne_m>3 steps<300", "steps"),
    "not a tag, one variant": Query("-tag:stopped_early variant:full", "-spl"),
    "words of the instruction": Query("kitchen", "ne_m"),
    "a manual tag": Query('tag:"glass door"'),
}
"""What people ask for; the slowest counts."""


def measure(scenes: Path | None) -> dict[str, float]:
    """The slowest query's time in milliseconds, by size of the index."""
    del scenes
    return {f"cases_filter_{size}_ms": max(times_ms(size).values()) for size in SIZES}


def times_ms(size: int) -> dict[str, float]:
    """Shortest time of each query over an index of that many episodes."""
    with tempfile.TemporaryDirectory() as folder:
        store = Store(Path(folder))
        store.put_all((row, 1, 1) for row in made_rows(size))
        with store.writing() as db:
            db.execute("insert into marks select trace_sha256, 'glass door' from episodes limit 99")
        times = {name: _best_ms(Finder(store), query) for name, query in QUERIES.items()}
        store.close()
    return times


def made_rows(count: int, *, seed: int = 0) -> Sequence[Row]:
    """Rows as 100 runs would have them."""
    generator = np.random.default_rng(seed)
    endings = [ending.value for ending in Ending]
    places = ("kitchen", "bedroom", "hall", "sofa", "stairs", "garden", "desk", "bath", "lamp")
    drawing = json.dumps({"way": [[0.25 * step, 1.5] for step in range(80)], "reference": []})
    rows: list[Row] = []
    for number in range(count):
        drawn = generator.uniform(size=len(TAGS) + 4)
        tags = {
            tag: None if u > 0.95 else int(u < 0.1) for tag, u in zip(TAGS, drawn, strict=False)
        }
        values: dict[str, Value] = {
            "run": f"run-{number % 100}",
            "episode_id": str(number // 100),
            "scene_id": f"mp3d/scan-{number % 11}",
            "variant": ("full", "base", "no-seeing")[number % 3],
            "ranker": "openai-chat:Qwen/Qwen3-VL-8B-Instruct",
            "profile": "vlnce",
            "outcome": "stopped",
            "ending": endings[int(drawn[-1] * len(endings))],
            "trace_sha256": f"{number:064x}",
            "code_version": "0.1.0",
            "seed": 0,
            "success": int(drawn[-1] < 0.125),
            "ne_m": float(14.0 * drawn[-2]),
            "spl": float(drawn[-3]),
            "steps": int(500 * drawn[-4]),
            **tags,
        }
        words = " ".join(f"Walk past the {places[(number * k) % 9]}." for k in range(1, 7))
        rows.append(Row(f"run-{number % 100}/traces/{number}.mcap", values, words, "", drawing))
    return rows


def _best_ms(finder: Finder, query: Query) -> float:
    times: list[float] = []
    for page in range(1, REPEATS + 1):
        begun = time.perf_counter()
        found = finder.find(query, page=page)
        times.append(1e3 * (time.perf_counter() - begun))
        assert len(found.cases) <= PAGE
    return min(times)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rows", type=int, nargs="+", default=SIZES, help="sizes of the index")
    parser.add_argument("--json", action="store_true", help="one JSON object instead of a table")
    options = parser.parse_args()
    found = {size: times_ms(size) for size in options.rows}
    if options.json:
        print(json.dumps(found))
        return
    table = Table("query", *(f"{size:,} episodes, ms" for size in found))
    for name in QUERIES:
        table.add_row(name, *(f"{times[name]:.1f}" for times in found.values()))
    Console().print(table)


if __name__ == "__main__":
    main()
