"""`c2nav turning` on a planted failure: what it leaves undone a later call completes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli import main
from c2nav_engine.experiments.turning.flips import TURNING
from c2nav_engine.experiments.turning.summary import UNFINISHED
from c2nav_engine.experiments.turning.table import Row, read_table
from tests.helpers.planted import SHORT, decision_of, flawless


def tried(rows: list[Row]) -> list[tuple[object, object]]:
    return [(row["decision"], row["answer"]) for row in rows if row["part"] == "flip"]


def test_a_table_is_left_and_taken_up_again(capsys: pytest.CaptureFixture[str], tmp_path: Path):
    trace, table = tmp_path / "failure.mcap", tmp_path / "turning.parquet"
    whole = flawless(SHORT)
    recording = whole.with_mistakes(whole.mistakes[0], trace=trace)

    def called(*words: str) -> str:
        how = ("--suspects", "1", "--repeats", "1", "--json", *words)
        with pytest.raises(SystemExit) as stopped:
            main(["turning", str(trace), "--out", str(table), *how])
        out, error = capsys.readouterr()
        assert stopped.value.code == 0, error
        return json.loads(out)["episodes"][trace.name]

    assert called("--max-queries", "1") == UNFINISHED
    first = read_table(table)
    assert len(tried(first)) == 1
    assert called() == TURNING
    whole_table = read_table(table)
    assert tried(whole_table)[:1] == tried(first)
    assert len(set(tried(whole_table))) == len(tried(whole_table)) > 1
    assert {decision for decision, _ in tried(whole_table)} == {
        decision_of(recording, whole.mistakes[0])
    }
    assert called() == TURNING
    assert read_table(table) == whole_table
