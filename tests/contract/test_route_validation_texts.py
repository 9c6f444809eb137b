"""What the English parser does to every validation-unseen text: docs/route-parser.md holds this."""

from __future__ import annotations

import gzip
import json
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from c2nav_engine.contract.route import RouteLadder, parse_english
from c2nav_engine.contract.route_clauses import Clause, words_of

PROGRESS_GATE_M = 0.75
HISTOGRAM = {1: 79, 2: 445, 3: 643, 4: 435, 5: 172, 6: 48, 7: 12, 8: 5}


@pytest.fixture(scope="module")
def parsed(shared: Path) -> list[tuple[RouteLadder, str, float]]:
    path = shared / "data" / "R2R_VLNCE_v1-3_val_unseen.json.gz"
    with gzip.open(path, "rt", encoding="utf-8") as file:
        episodes: list[dict[str, Any]] = json.load(file)["episodes"]
    texts = [episode["instruction"]["instruction_text"] for episode in episodes]
    lengths = [episode["info"]["geodesic_distance"] for episode in episodes]
    return [(parse_english(t), t, m) for t, m in zip(texts, lengths, strict=True)]


def clause(leg: str) -> Clause:
    return Clause(words_of(leg), introduces=False)


def test_every_word_of_every_text_is_kept(parsed: list[tuple[RouteLadder, str, float]]) -> None:
    assert len(parsed) == 1839
    for ladder, text, _ in parsed:
        kept = [word.text for leg in ladder.legs for word in words_of(leg)]
        assert kept == [word.text for word in words_of(text)]


def test_no_leg_is_without_verb_or_landmark(
    parsed: list[tuple[RouteLadder, str, float]],
) -> None:
    legs = [clause(leg) for ladder, _, _ in parsed for leg in ladder.legs]
    assert all(leg.has_verb or leg.has_landmark for leg in legs)
    # Stronger: both, but for two texts that name nothing to be seen at all.
    assert sum(not leg.has_landmark for leg in legs) == 2
    assert sum(not leg.has_verb for leg in legs) == 0


def test_legs_per_instruction(parsed: list[tuple[RouteLadder, str, float]]) -> None:
    counts = Counter(len(ladder.legs) for ladder, _, _ in parsed)
    assert dict(sorted(counts.items())) == HISTOGRAM


def test_no_episode_is_too_short_for_its_legs(
    parsed: list[tuple[RouteLadder, str, float]],
) -> None:
    # K − 1 transitions, each after the progress gate; and the same with the last leg counted.
    before_last = sum((len(x.legs) - 1) * PROGRESS_GATE_M > m for x, _, m in parsed)
    every_leg = sum(len(x.legs) * PROGRESS_GATE_M > m for x, _, m in parsed)
    assert (before_last, every_leg) == (0, 1)


def test_furnished_house_legs(shared: Path) -> None:
    path = shared / "data" / "furnished_house_8.json.gz"
    with gzip.open(path, "rt", encoding="utf-8") as file:
        episodes: list[dict[str, Any]] = json.load(file)["episodes"]
    ladders = [parse_english(episode["instruction"]["instruction_text"]) for episode in episodes]
    assert [len(ladder.legs) for ladder in ladders] == [3, 2, 4, 4, 3, 3, 4, 4]
    assert ladders[2].legs == (
        "Walk between the sofa and the television",
        "turn right at the folding door",
        "then go left into the room behind the low wall",
        "and stop next to the armchair",
    )
