"""Made-up run folders: manifest and rows as a batch writes them, without an episode being run."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np

from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.experiments.batch import write_tables
from c2nav_engine.experiments.spec import RunSpec, Setting
from c2nav_engine.navigator.variants import preset

Row = dict[str, str | int | float | None]
OutcomeOf = Callable[[str, int, int], Mapping[str, str | int | float | None]]
"""(variant, episode, seed) → columns that differ from the usual ones."""


def row(episode: int, variant: str, seed: int, **changes: str | float | None) -> Row:
    """A plausible failed episode."""
    usual: Row = {
        "episode_id": str(episode),
        "trajectory_id": str(episode),
        "scene_id": "made/up",
        "variant": variant,
        "ranker": "openai-chat:Qwen/Qwen3-VL-8B-Instruct",
        "seed": seed,
        "outcome": "stopped",
        "ne_m": 6.0,
        "os": 0,
        "success": 0,
        "success_zero_shot": 0,
        "spl": 0.0,
        "ndtw": 0.3,
        "sdtw": 0.0,
        "path_length_m": 9.0,
        "steps": 60,
        "collisions": 1,
        "decisions": 20,
        "queries": 30,
        "invalid": 3,
        "abstained": 2,
        "fallbacks": 1,
        "glances": 1,
        "walkbacks": 0,
        "tokens": None,
        "latency_s": 12.5,
        "trace_sha256": None,
    }
    return usual | changes


def by_chance(rates: Mapping[str, float], *, seed: int = 7) -> OutcomeOf:
    """Successes at these rates, and figures that go with them."""

    def outcome(variant: str, episode: int, run_seed: int) -> dict[str, str | int | float | None]:
        facts = f"{seed}/{variant}/{episode}/{run_seed}".encode()
        draw = np.random.default_rng(int.from_bytes(facts, "big") % 2**63)
        success = int(draw.random() < rates[variant])
        near = max(success, int(draw.random() < 0.3))
        return {
            "success": success,
            "success_zero_shot": success,
            "os": near,
            "spl": success * float(draw.uniform(0.4, 1.0)),
            "ne_m": float(draw.uniform(0.2, 2.9) if success else draw.uniform(3.0, 12.0)),
        }

    return outcome


def make_run(
    folder: Path,
    variants: Sequence[str],
    outcome_of: OutcomeOf,
    *,
    episodes: int = 100,
    seeds: Sequence[int] = (0,),
    ranker: str = "openai-chat",
    named: str = "openai-chat:Qwen/Qwen3-VL-8B-Instruct",
    source: str = "made-up.json",
) -> list[Row]:
    """Write a finished run folder; returns its rows."""
    setting = Setting(source=source, ranker=ranker)
    ids = tuple(str(number) for number in range(1, episodes + 1))
    spec = RunSpec(setting, ids, tuple(variants), tuple(seeds))
    rows = [
        row(int(task.episode_id), task.variant, task.seed)
        | {"ranker": "random" if task.variant == "random" else named}
        | dict(outcome_of(task.variant, int(task.episode_id), task.seed))
        for task in spec.tasks()
    ]
    folder.mkdir(parents=True)
    write_tables(rows, folder)
    manifest = {
        "schema": 1,
        "code_version": "0",
        "spec_sha256": spec.sha256(),
        "source": source,
        "source_sha256": "0" * 64,
        "headings": "v1-3",
        "ground_truth": "reference path",
        "profile": asdict(VLNCE),
        "ranker": ranker,
        "ranker_options": {},
        "seeds": list(seeds),
        "variants": {name: {"sha256": preset(name).sha256()} for name in variants},
        "spec": asdict(spec),
    }
    (folder / "manifest.json").write_text(json.dumps(manifest), encoding="utf-8")
    return rows
