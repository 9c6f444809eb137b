"""What a dry run reckons: counts exactly, the rest from means that it names."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from app.cli import main
from app.commands.run_estimate import duration
from c2nav_engine.experiments.dry_run import estimate, host_of
from c2nav_engine.experiments.expected import expected, picture_tokens
from c2nav_engine.experiments.spec import RunSpec, Setting
from c2nav_engine.navigator.variants import PRESETS
from tests.helpers.runs import row


def spec_of(
    ranker: str = "openai-chat",
    *,
    model: str = "Qwen/Qwen3-VL-8B-Instruct",
    base_url: str = "http://127.0.0.1:8000/v1",
    variants: tuple[str, ...] = ("full",),
    episodes: int = 100,
) -> RunSpec:
    remote = ranker.startswith("openai")
    options = {"base_url": base_url, "model": model} if remote else {}
    setting = Setting("builtin", ranker=ranker, ranker_options=options)
    return RunSpec(setting, tuple(map(str, range(episodes))), variants, (0,))


def test_presets_that_share_a_config_are_run_once() -> None:
    found = estimate(spec_of(variants=tuple(PRESETS), episodes=1839))
    assert found.rows == 1839 * len(PRESETS)
    assert found.tasks == 1839 * (len(PRESETS) - 1)
    assert ("seeing-remembering", "no-arriving") in [share.variants for share in found.shares]


def test_every_preset_has_measured_means() -> None:
    table = expected()
    assert set(PRESETS) - set(table.variants) <= {"no-arriving"}
    for means in table.variants.values():
        assert means.episodes >= 5 and means.core_s > 0 and means.trace_mb > 0
        assert set(means.queries) <= set(table.slots)
    assert table.how


def test_twice_the_episodes_take_twice_of_everything() -> None:
    once, twice = estimate(spec_of(episodes=50)), estimate(spec_of(episodes=100))
    assert twice.queries == pytest.approx(2 * once.queries)
    assert twice.tokens_in == pytest.approx(2 * (once.tokens_in or 0.0))
    assert twice.time_s == pytest.approx(2 * once.time_s)


def test_workers_share_the_time_and_nothing_else() -> None:
    one, four = estimate(spec_of(), workers=1), estimate(spec_of(), workers=4)
    assert four.time_s == pytest.approx(one.time_s / 4)
    assert four.queries == one.queries


def test_a_price_is_named_where_there_is_one() -> None:
    assert estimate(spec_of()).cost_usd is None
    known = estimate(spec_of(model="gpt-5.5-2026-04-23"))
    assert known.cost_usd == pytest.approx(
        ((known.tokens_in or 0) * 5.0 + (known.tokens_out or 0) * 30.0) / 1e6, rel=1e-6
    )


def test_rankers_without_tokens_have_none() -> None:
    found = estimate(spec_of("reference-cv"))
    assert found.tokens_in is None and found.cost_usd is None and found.lanes == 1


def test_random_answers_cost_a_model_nothing() -> None:
    found = estimate(spec_of(variants=("random",)))
    assert found.tokens_in == 0.0 and found.shares[0].wait_s == 0.0


@pytest.mark.parametrize(
    ("base_url", "host"),
    [
        ("http://127.0.0.1:8000/v1", ""),
        ("http://localhost:8000/v1", ""),
        ("http://[::1]:8000/v1", ""),
        ("https://models.example.org/v1", "models.example.org"),
    ],
)
def test_the_host_of_the_pictures_is_named(base_url: str, host: str) -> None:
    assert host_of(spec_of(base_url=base_url).setting) == host
    assert host_of(Setting("builtin")) == ""


def test_rows_of_the_run_itself_take_the_place_of_the_means() -> None:
    rows = [row(n, "full", 0, queries=1000, tokens=5_000_000, latency_s=250.0) for n in range(8)]
    found = estimate(spec_of(), rows=rows)
    assert found.shares[0].measured_here
    assert found.queries == pytest.approx(100 * 1000)
    total = (found.tokens_in or 0.0) + (found.tokens_out or 0.0)
    assert total == pytest.approx(100 * 5_000_000)
    assert not estimate(spec_of(), rows=rows[:2]).shares[0].measured_here


def test_pictures_cost_what_the_documents_say() -> None:
    # Measured figures of Qwen3-VL: 224 × 224 is scaled up, the others are rounded to patches.
    assert picture_tokens(224, 224, least=64) == 64
    assert picture_tokens(512, 512, least=64) == 256
    assert picture_tokens(640, 480, least=64) == 300


def test_the_command_runs_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "run"
    words = ["run", "builtin", "--out", str(out), "--variants", "full,base", "--dry-run", "--json"]
    with pytest.raises(SystemExit) as stopped:
        main(words)
    assert stopped.value.code == 0
    said = json.loads(capsys.readouterr().out)
    assert said["dry_run"] is True and said["tasks"] == 200 and said["hosts"] == []
    assert not out.exists()


def test_missing_scans_do_not_keep_from_reckoning(
    tmp_path: Path, shared: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    source = shared / "data" / "R2R_VLNCE_v1-3_val_unseen.json.gz"
    words = ["run", str(source), "--scenes", str(tmp_path), "--out", str(tmp_path / "r")]
    with pytest.raises(SystemExit) as stopped:
        main([*words, "--dry-run", "--json"])
    assert stopped.value.code == 0
    said = json.loads(capsys.readouterr().out)
    assert said["tasks"] == 1839 and len(said["missing_scenes"]) == 11


def test_durations_read_well() -> None:
    assert [duration(s) for s in (12, 700, 8000, 400_000)] == [
        "12 s",
        "12 min",
        "2 h 13 min",
        "4.6 days",
    ]


def test_a_seed_more_is_as_much_again() -> None:
    spec = spec_of()
    assert estimate(replace(spec, seeds=(0, 1))).tasks == 2 * estimate(spec).tasks
