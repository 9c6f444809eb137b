"""The inspector on a run of which no trace is finished yet."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from tests.helpers.runs import by_chance, make_run

GOLDEN = Path(__file__).resolve().parents[1] / "golden" / "trace-v1.mcap"
PROGRAM = "from app.cli import main; main()"


@pytest.fixture
def inspected(tmp_path: Path) -> Iterator[tuple[Path, subprocess.Popen[str]]]:
    """A run without traces and the inspector on it."""
    run = tmp_path / "run"
    make_run(run, ["full"], by_chance({"full": 1.0}), episodes=1)
    (run / "traces").mkdir()
    words = ["inspect", str(run), "--port", "0", "--no-browser"]
    command = [sys.executable, "-c", PROGRAM, *words]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        yield run, process
        process.terminate()


def address(process: subprocess.Popen[str], name: str) -> str:
    assert process.stdout is not None
    for line in process.stdout:
        found = re.search(rf"{name} at (http://\S+?)(?:run;?)?(?:\s|$)", line)
        if found is not None:
            return found[1]
    raise AssertionError(f"the program ended with {process.wait()} and never said {name!r}")


def test_the_inspector_follows_at_the_same_address_once_a_trace_is_finished(
    inspected: tuple[Path, subprocess.Popen[str]],
):
    run, process = inspected
    alone = address(process, "run")
    page = httpx.get(f"{alone}run", timeout=60.0)
    assert page.status_code == 200
    assert "Inspector" not in page.text
    part = run / "traces" / "1.full.mcap.part"
    shutil.copy(GOLDEN, part)
    part.rename(part.with_suffix(""))
    # Asked while nobody may be serving yet: the answer comes late, and it comes.
    assert httpx.get(f"{alone}run", timeout=60.0).status_code == 200
    assert address(process, "inspector") == alone
    assert "Inspector" in httpx.get(f"{alone}run", timeout=60.0).text
    assert httpx.get(f"{alone}api/state", timeout=60.0).json()["decision"] is not None
