"""What a report says equals what anyone computes from `episodes.csv`."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from statistics import fmean
from typing import Any

import pytest
from statsmodels.stats.contingency_tables import mcnemar as mcnemar_oracle
from statsmodels.stats.multitest import multipletests
from statsmodels.stats.proportion import proportion_confint

from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.report.writing import write_report
from tests.helpers.runs import by_chance, make_run

RATES = {
    "full": 0.45,
    "base": 0.2,
    "no-seeing": 0.15,
    "seeing-remembering": 0.4,
    "no-arriving": 0.4,
    "no-sketch": 0.35,
    "spatial-cardinal": 0.1,
}
SHARED = ("seeing-remembering", "no-arriving")
"""One configuration under two names."""


def outcomes(variant: str, episode: int, seed: int) -> dict[str, str | int | float | None]:
    variant = SHARED[0] if variant in SHARED else variant
    return dict(by_chance(RATES)(variant, episode, seed))


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A made-up run and the report on it."""
    root = tmp_path_factory.mktemp("report")
    make_run(root / "run", tuple(RATES), outcomes)
    write_report([root / "run"], root / "out")
    return root / "run", root / "out"


def records(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def of_variant(run: Path, variant: str) -> list[dict[str, str]]:
    return [row for row in records(run / "episodes.csv") if row["variant"] == variant]


@pytest.mark.parametrize("variant", RATES)
def test_rates_are_shares_of_the_rows_with_wilson_intervals(
    folders: tuple[Path, Path], variant: str
) -> None:
    run, out = folders
    rows = of_variant(run, variant)
    mine = [
        record
        for record in records(out / "csv" / "tables.csv")
        if record["kind"] == "ours" and record["variant"] == variant
    ]
    columns = {"sr": "success", "osr": "os"}
    assert {record["figure"] for record in mine} >= {"sr", "osr", "spl"}
    for record in mine:
        if record["figure"] in columns:
            count = sum(int(row[columns[record["figure"]]]) for row in rows)
            low, high = proportion_confint(count, len(rows), method="wilson")
            assert float(record["value"]) == count / len(rows)
            assert float(record["low"]) == pytest.approx(low, abs=1e-9)
            assert float(record["high"]) == pytest.approx(high, abs=1e-9)
        else:
            column = record["figure"]
            assert float(record["value"]) == pytest.approx(fmean(float(r[column]) for r in rows))
            assert float(record["low"]) < float(record["value"]) < float(record["high"])


def test_paired_tests_equal_an_independent_computation(folders: tuple[Path, Path]) -> None:
    run, out = folders
    full = {row["episode_id"]: int(row["success"]) for row in of_variant(run, "full")}
    compared = records(out / "csv" / "comparisons.csv")
    p_values: list[float] = []
    for record in compared:
        variant = record["compared"].split(": ")[1].split(" = ")[0]
        other = {row["episode_id"]: int(row["success"]) for row in of_variant(run, variant)}
        table = [[0, 0], [0, 0]]
        for episode, success in full.items():
            table[1 - success][1 - other[episode]] += 1
        oracle: Any = mcnemar_oracle(table, exact=True)
        assert int(record["only_with"]) == table[0][1]
        assert int(record["only_compared"]) == table[1][0]
        assert float(record["mcnemar_p"]) == pytest.approx(oracle.pvalue, abs=1e-12)
        p_values.append(float(record["mcnemar_p"]))
    adjusted = multipletests(p_values, method="holm")[1]
    assert [float(record["mcnemar_holm_p"]) for record in compared] == pytest.approx(adjusted)


def test_one_config_under_two_names_counts_once_and_stands_in_both_rows(
    folders: tuple[Path, Path],
) -> None:
    _, out = folders
    names = [r["compared"].split(": ")[1] for r in records(out / "csv" / "comparisons.csv")]
    assert names.count(" = ".join(SHARED)) == 1
    assert not set(SHARED) & set(names)
    # Five configurations beside `full`, although six presets ran.
    assert len(names) == len(RATES) - 2
    tables = records(out / "csv" / "tables.csv")
    both = [
        [r["value"] for r in tables if r["variant"] == name and r["table"] == "faculty"]
        for name in SHARED
    ]
    assert both[0] == both[1] and both[0]


def test_a_preset_that_ran_under_its_twin_name_fills_both_rows(tmp_path: Path) -> None:
    make_run(tmp_path / "run", ("full", "no-arriving"), outcomes, episodes=30)
    write_report([tmp_path / "run"], tmp_path / "out")
    ours = [r for r in records(tmp_path / "out" / "csv" / "tables.csv") if r["kind"] == "ours"]
    assert {r["variant"] for r in ours if r["table"] == "faculty"} == {"full", *SHARED}


def test_reported_rows_stand_beside_ours_with_inside_or_outside(
    folders: tuple[Path, Path],
) -> None:
    _, out = folders
    beside = records(out / "csv" / "beside.csv")
    assert {record["reported_is"] for record in beside} == {"inside", "outside"}
    for record in beside:
        ours, reported = float(record["ours"]), float(record["reported"])
        assert float(record["difference"]) == pytest.approx(ours - reported)
        # Printed figures are rounded: half a last digit is still inside.
        slack = 0.005 if record["figure"] == "ne_m" else 0.0005
        inside = float(record["low"]) - slack <= reported <= float(record["high"]) + slack
        assert record["reported_is"] == ("inside" if inside else "outside")
    main = {r["figure"]: float(r["reported"]) for r in beside if r["table"] == "main"}
    assert main == {"ne_m": 8.89, "osr": 0.41, "sr": 0.31, "spl": 0.167}


def test_unreachable_goals_and_missing_values_are_left_out_of_means(tmp_path: Path) -> None:
    def outcome(variant: str, episode: int, seed: int) -> dict[str, str | int | float | None]:
        if episode == 1:
            return {"ne_m": math.inf}
        return {"success": None, "ne_m": None} if episode == 2 else {"ne_m": 4.0, "success": 1}

    make_run(tmp_path / "run", ("full",), outcome, episodes=10)
    write_report([tmp_path / "run"], tmp_path / "out")
    ours = [r for r in records(tmp_path / "out" / "csv" / "tables.csv") if r["kind"] == "ours"]
    figures = {r["figure"]: float(r["value"]) for r in ours if r["table"] == "main"}
    assert figures["ne_m"] == 4.0
    assert figures["sr"] == pytest.approx(8 / 9)


def test_seeds_of_an_episode_do_not_narrow_the_interval(tmp_path: Path) -> None:
    def same(variant: str, episode: int, seed: int) -> dict[str, str | int | float | None]:
        return dict(by_chance({"full": 0.4})(variant, episode, 0))

    widths: list[float] = []
    for name, seeds in (("one", (0,)), ("four", (0, 1, 2, 3))):
        make_run(tmp_path / name, ("full",), same, seeds=seeds)
        write_report([tmp_path / name], tmp_path / f"{name}-out")
        found = records(tmp_path / f"{name}-out" / "csv" / "tables.csv")
        sr = next(r for r in found if r["kind"] == "ours" and r["figure"] == "sr")
        assert sr["episodes"] == "100"
        widths.append(float(sr["high"]) - float(sr["low"]))
    assert widths[1] == pytest.approx(widths[0], rel=0.1)


def test_a_folder_without_a_run_is_bad_usage(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="expected a run folder"):
        write_report([tmp_path], tmp_path / "out")
