from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from c2nav_engine.errors import TraceError
from c2nav_engine.runner.recorded import open_trace, read_trace
from c2nav_engine.traces import SCHEMA_VERSION, check
from c2nav_engine.traces.container import Container
from c2nav_engine.traces.topics import METADATA
from tests.golden.make_trace import story

GOLDEN = Path(__file__).resolve().parents[1] / "golden"


def missing(golden: Any, came: Any, path: str = "") -> list[str]:
    """Where something that the golden file says is not read any more; new fields may come."""
    if isinstance(golden, dict):
        assert isinstance(came, dict), path
        return [
            line
            for key, value in golden.items()
            for line in (
                missing(value, came[key], f"{path}.{key}") if key in came else [f"{path}.{key}"]
            )
        ]
    if isinstance(golden, list):
        if not isinstance(came, list) or len(golden) != len(came):
            return [path]
        return [
            line
            for place, (value, other) in enumerate(zip(golden, came, strict=True))
            for line in missing(value, other, f"{path}[{place}]")
        ]
    return [] if golden == came else [f"{path}: {golden!r} became {came!r}"]


@pytest.mark.parametrize("version", range(1, SCHEMA_VERSION + 1))
def test_every_schema_version_still_reads_as_it_did(version: int) -> None:
    path = GOLDEN / f"trace-v{version}.mcap"
    assert check(path) == []
    golden = json.loads(path.with_suffix(".json").read_text(encoding="utf-8"))
    # Through JSON and back, so that tuples and infinities are spelled as in the file.
    came = json.loads(json.dumps(story(read_trace(path))))
    assert missing(golden, came) == []


def test_a_trace_of_a_newer_program_is_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "new.mcap"
    container = Container(path)
    container.describe(METADATA, {"schema_version": str(SCHEMA_VERSION + 1), "complete": "yes"})
    container.finish()
    with pytest.raises(TraceError, match=f"schema '{SCHEMA_VERSION + 1}'.*update the program"):
        open_trace(path)


def test_another_programs_mcap_is_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "other.mcap"
    Container(path).finish()
    with pytest.raises(TraceError, match="some other MCAP file"):
        open_trace(path)
