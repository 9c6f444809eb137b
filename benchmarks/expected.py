"""Measures what a dry run reckons with, from a finished run and its traces.

    python -m benchmarks.expected RUN --core-s-a-view S --how "…"

Writes `c2nav_engine/experiments/expected.json`. Steps, decisions and queries come from the run's
rows, words and pictures of a query from its traces. Core seconds are reckoned from the views that
were rendered, at what `python -m benchmarks.batch` measures for one, recording included.
"""

from __future__ import annotations

import argparse
import json
from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from statistics import fmean

from c2nav_engine.contract.outcome import Ordering
from c2nav_engine.contract.prompt import Query
from c2nav_engine.experiments.expected import (
    EXPECTED_FILE,
    Expected,
    ModelMeans,
    Shown,
    SlotMeans,
    VariantMeans,
)
from c2nav_engine.experiments.report.behaviour import trace_of
from c2nav_engine.experiments.report.reading import Run, read_run
from c2nav_engine.navigator.requests import Ask, Seen
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.runner.recorded import open_trace

MODELS = {
    "qwen3-vl": ModelMeans(
        0.8, 0.004, None, "latency on one GPU with a local vLLM is an assumption, not measured"
    ),
    "gpt-5.5": ModelMeans(
        6.0, 0.004, 350.0, "latency and reasoning at low effort are assumptions, not measured"
    ),
    "generic": ModelMeans(
        1.5, 0.004, None, "latency of an unknown server is an assumption, not measured"
    ),
    "local": ModelMeans(
        1.5, 0.0, 0.0, "latency on one GPU is an assumption, not measured; labels are scored"
    ),
    "reference-cv": ModelMeans(
        0.0, 0.02, None, "15 to 20 ms a query on one core of this project's 2-core machine"
    ),
    "other": ModelMeans(0.0, 0.0, None, "answers at once"),
}


@dataclass
class Tally:
    """Queries of one slot while traces are read."""

    texts: list[int] = field(default_factory=list[int])
    answers: list[int] = field(default_factory=list[int])
    sizes: Counter[tuple[int, int]] = field(default_factory=Counter[tuple[int, int]])

    def add(self, query: Query) -> None:
        """Count one query's words and pictures."""
        parts = query.prompt.parts
        self.texts.append(sum(len(part) for part in parts if isinstance(part, str)))
        if isinstance(query.outcome, Ordering):
            self.answers.append(4 * len(query.outcome.keys) - 3)
        for part in parts:
            if not isinstance(part, str):
                self.sizes[part.width_px, part.height_px] += 1

    def means(self) -> SlotMeans:
        """A mean query."""
        count = len(self.texts)
        return SlotMeans(
            text_chars=round(fmean(self.texts), 1),
            # A JSON object around the order: {"ranking": "A > B > C"}.
            answer_chars=round((fmean(self.answers) if self.answers else 3.0) + 15.0, 1),
            pictures=[
                Shown(width, height, round(number / count, 3))
                for (width, height), number in sorted(self.sizes.items())
            ],
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("run", type=Path)
    parser.add_argument("--how", required=True, help="the run in words, machine included")
    parser.add_argument("--core-s-a-view", type=float, required=True, help="as benchmarks.batch")
    parser.add_argument("--out", type=Path, default=EXPECTED_FILE)
    arguments = parser.parse_args()
    run = read_run(arguments.run)
    tallies: defaultdict[str, Tally] = defaultdict(Tally)
    core_s = arguments.core_s_a_view
    variants = {
        name: variant_means(run, name, tallies, core_s_a_view=core_s) for name in run.configs
    }
    slots = {slot: tally.means() for slot, tally in sorted(tallies.items())}
    table = Expected(arguments.how, variants, slots, MODELS)
    text = json.dumps(asdict(table), indent=1, ensure_ascii=False)
    arguments.out.write_text(text + "\n", encoding="utf-8")
    for name, means in variants.items():
        queries = sum(means.queries.values())
        print(f"{name:22} {queries:6.1f} queries {means.core_s:6.1f} s {means.trace_mb:5.1f} MB")


def variant_means(
    run: Run, variant: str, tallies: defaultdict[str, Tally], *, core_s_a_view: float
) -> VariantMeans:
    rows = [row for row in run.rows if row["variant"] == variant]
    presets = [name for name in run.configs if run.configs[name] == run.configs[variant]]
    queries: Counter[str] = Counter()
    views: list[int] = []
    megabytes: list[float] = []
    for row in rows:
        path = trace_of(row, presets, run.folder)
        with open_trace(path) as trace:
            exchanges = list(trace.exchanges())
        for exchange in exchanges:
            count_queries(exchange, queries, tallies)
        views.append(views_of(exchanges))
        megabytes.append(path.stat().st_size / 1e6)
    return VariantMeans(
        episodes=len(rows),
        steps=round(fmean(float(row["steps"] or 0) for row in rows), 1),
        decisions=round(fmean(float(row["decisions"] or 0) for row in rows), 1),
        queries={slot: round(count / len(rows), 2) for slot, count in sorted(queries.items())},
        core_s=round(core_s_a_view * fmean(views), 2),
        trace_mb=round(fmean(megabytes), 2),
    )


def count_queries(
    exchange: Exchange, queries: Counter[str], tallies: defaultdict[str, Tally]
) -> None:
    if isinstance(exchange.request, Ask) and exchange.ranked is not None:
        slot = exchange.request.question.slot.value
        queries[slot] += len(exchange.ranked.queries)
        for query in exchange.ranked.queries:
            tallies[slot].add(query)


def views_of(exchanges: Sequence[Exchange]) -> int:
    """Views rendered: what an episode spends nearly all of its time on."""
    return sum(len(e.response.views) for e in exchanges if isinstance(e.response, Seen))


if __name__ == "__main__":
    main()
