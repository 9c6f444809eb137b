"""How long `/cases` takes to filter, count and sort an index, and to write the page.

python -m benchmarks.cases [--rows 2000 100000] [--json]

Rows are made up, because a hundred thousand episodes would take weeks to run; every column and
every automatic tag is set as in a real index. Each query is asked of an open index seven times,
page by page; the shortest counts. On a machine that others use too, that is an upper bound, and
the processor time beside it is not.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from rich.console import Console
from rich.table import Table

from app.pages.cases import cases_page
from app.pages.index.columns import Row, Value
from app.pages.index.finding import PAGE
from app.pages.index.query import Query
from app.pages.library import Library
from app.pages.page import ABOUT_RUNS
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


class Times(NamedTuple):
    """Shortest times of one query, in milliseconds."""

    wall_ms: float
    processor_ms: float


def measure(scenes: Path | None) -> dict[str, float]:
    """The slowest query's time in milliseconds, by size of the index."""
    del scenes
    return {
        f"cases_filter_{size}_ms": max(each.wall_ms for each in times(size).values())
        for size in SIZES
    }


def times(size: int) -> dict[str, Times]:
    """Times of each query over an index of that many episodes."""
    with tempfile.TemporaryDirectory() as folder:
        library = Library(Path(folder))
        library.store.put_all((row, 1, 1) for row in made_rows(size))
        with library.store.writing() as db:
            db.execute("insert into marks select trace_sha256, 'glass door' from episodes limit 99")
        found = {name: _best(library, query) for name, query in QUERIES.items()}
        library.close()
    return found


def made_rows(count: int, *, seed: int = 0) -> Sequence[Row]:
    """Rows as 100 runs would have them."""
    generator = np.random.default_rng(seed)
    endings = [ending.value for ending in Ending]
    places = ("kitchen", "bedroom", "hall", "sofa", "stairs", "garden", "desk", "bath", "lamp")
    way = [[0.25 * step, 1.5] for step in range(80)]
    drawing = json.dumps({"way": way, "reference": [], "goal": way[-1], "radius_m": 3.0})
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


def _best(library: Library, query: Query) -> Times:
    walls_s: list[float] = []
    processor_s: list[float] = []
    for page in range(1, REPEATS + 1):
        begun = (time.perf_counter(), time.process_time())
        text = cases_page(library, query, page=page, menu=ABOUT_RUNS)
        walls_s.append(time.perf_counter() - begun[0])
        processor_s.append(time.process_time() - begun[1])
        assert 0 < text.count('class="p-case"') <= PAGE
    return Times(1e3 * min(walls_s), 1e3 * min(processor_s))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rows", type=int, nargs="+", default=SIZES, help="sizes of the index")
    parser.add_argument("--json", action="store_true", help="one JSON object instead of a table")
    options = parser.parse_args()
    found = {size: times(size) for size in options.rows}
    if options.json:
        plain = {
            size: {name: each._asdict() for name, each in by_query.items()}
            for size, by_query in found.items()
        }
        print(json.dumps(plain))
        return
    table = Table("query", *(f"{size:,} episodes, ms (processor)" for size in found))
    for name in QUERIES:
        shown = (by_query[name] for by_query in found.values())
        table.add_row(name, *(f"{each.wall_ms:.1f} ({each.processor_ms:.1f})" for each in shown))
    Console().print(table)


if __name__ == "__main__":
    main()
