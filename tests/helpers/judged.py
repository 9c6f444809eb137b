"""Run folders with made-up traces whose answers and facts are words found nowhere else."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

from app.reviews.study import Person, Study, add_person, make_study
from c2nav_engine.contract.prompt import Ranked
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.exchange import Exchange
from tests.helpers.exchanges import FakeEpisode, fake_episode, write_episode

ANSWER = "zanzibar-answer"
"""In every raw answer of the model."""

RANKER = "quokka-ranker"
SERVED = "wombat-served"
GOAL_M = 73.125
"""In the goal, the reference path and the metrics."""


def judged_run(folder: Path, *, episodes: int = 3, cycles: int = 4) -> Path:
    """A run folder with that many finished traces, every question of them asked of a model."""
    run = folder / "numbat-run"
    (run / "traces").mkdir(parents=True)
    for number in range(episodes):
        made = marked(fake_episode(cycles, seed=number, side_px=16), number)
        write_episode(run / "traces" / f"{number}.full.0.mcap", made)
    return run


def marked(made: FakeEpisode, number: int) -> FakeEpisode:
    """The episode with marks in everything that nobody may see who judges."""
    episode = replace(
        made.header.episode,
        episode_id=str(number),
        scene_id="builtin/potoroo",
        goal_m=(GOAL_M, 0.0, GOAL_M),
        reference_path_m=((GOAL_M, 0.0, 1.0), (GOAL_M, 0.0, GOAL_M)),
    )
    return replace(
        made,
        header=replace(made.header, episode=episode, run="numbat-run", ranker=RANKER),
        exchanges=tuple(map(_marked, made.exchanges)),
        footer=replace(made.footer, metrics={"ne_m": GOAL_M, "success": 0}),
    )


def _marked(exchange: Exchange) -> Exchange:
    if not isinstance(exchange.request, Ask) or exchange.ranked is None:
        return exchange
    queries = tuple(
        replace(query, reply=replace(query.reply, text=ANSWER, model=SERVED))
        for query in exchange.ranked.queries
    )
    return replace(exchange, ranked=Ranked(exchange.ranked.outcome, queries, RANKER))


def study_with(
    run: Path, *people: str, per_slot: int = 20, repeat: float = 0.1, queue: str = ""
) -> tuple[Study, list[tuple[Person, str]]]:
    """A study of that run and its people with their tokens."""
    study = make_study([run], name="first", per_slot=per_slot, seed=3, repeat=repeat)
    return study, [add_person(study, name, queue=queue) for name in people]


def amendments(study: Study) -> list[dict[str, object]]:
    """The dated amendments of a study."""
    text = (study.folder / "amendments.jsonl").read_text("utf-8")
    return [json.loads(line) for line in text.splitlines()]
