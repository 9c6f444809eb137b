"""An output that would destroy its input, or that cannot be written, is refused before any work."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest

from app import cli
from app.cli import main
from tests.helpers.exchanges import write_fake


@pytest.fixture
def trace(tmp_path: Path) -> Path:
    write_fake(tmp_path / "a.mcap", side_px=16)
    return tmp_path / "a.mcap"


def refused(capsys: pytest.CaptureFixture[str], *words: object) -> str:
    with pytest.raises(SystemExit) as stopped:
        main([str(word) for word in words])
    error = capsys.readouterr().err
    assert stopped.value.code == 2, error
    assert "Traceback" not in error
    return error


ONE_FILE: dict[str, tuple[str, ...]] = {
    "fork": ("fork", "TRACE", "--at", "0", "--ranking", "A", "--ranker", "scripted"),
    "reeval": ("reeval", "TRACE", "--ranker", "scripted"),
    "turning": ("turning", "TRACE"),
    "recover": ("trace", "recover", "TRACE"),
    "figure": ("figure", "TRACE", "--decisions", "0"),
    **{
        f"export {form}": ("trace", "export", "TRACE", "--to", form)
        for form in ("rrd", "html", "ndjson", "parquet", "video", "merged", "redacted")
    },
}
"""Commands that read a trace and write one file."""


def words_of(name: str, trace: Path) -> list[str]:
    return [str(trace) if word == "TRACE" else word for word in ONE_FILE[name]]


@pytest.mark.parametrize("link", ["itself", "symbolic", "hard"])
@pytest.mark.parametrize("name", ONE_FILE)
def test_no_output_goes_onto_its_input(
    capsys: pytest.CaptureFixture[str], trace: Path, name: str, link: str
):
    out, before = trace.with_name("b.mcap"), trace.read_bytes()
    if link == "symbolic":
        out.symlink_to(trace)
    elif link == "hard":
        out.hardlink_to(trace)
    else:
        out = trace
    assert "expected another file" in refused(capsys, *words_of(name, trace), "--out", out)
    assert trace.read_bytes() == before


@pytest.mark.parametrize("name", ONE_FILE)
def test_a_file_that_cannot_be_written_is_refused(
    capsys: pytest.CaptureFixture[str], trace: Path, name: str
):
    words, folder = words_of(name, trace), trace.with_name("folder")
    folder.mkdir()
    assert "came the folder" in refused(capsys, *words, "--out", folder)
    assert "/proc: " in refused(capsys, *words, "--out", "/proc/x/y.pdf")
    assert "is a device" in refused(capsys, *words, "--out", "/dev/full")
    assert str(trace) in refused(capsys, *words, "--out", trace / "y.pdf")
    assert sorted(trace.parent.iterdir()) == [trace, folder]


@pytest.mark.parametrize(
    "words",
    [
        ("run", "builtin", "--episodes", "1", "--ranker", "scripted", "--out"),
        ("question", "TRACE", "--at", "0", "--pictures"),
        ("report", "RUN", "--out"),
        ("study", "pack", "RUN", "--name", "x", "--out"),
        ("cases", "export", "RUN", "--name", "x", "--out"),
        ("cases", "import", "RUN", "--into"),
    ],
)
def test_a_folder_that_cannot_be_written_to_is_refused(
    capsys: pytest.CaptureFixture[str], trace: Path, words: tuple[str, ...]
):
    put = {"TRACE": str(trace), "RUN": str(trace.parent)}
    given = [put.get(word, word) for word in words]
    assert "/proc: " in refused(capsys, *given, "/proc/x/y")
    assert "which is a file" in refused(capsys, *given, trace)
    assert "which is a file" in refused(capsys, *given, "/dev/full")
    assert list(trace.parent.iterdir()) == [trace]


def test_sampled_episodes_and_exported_reviews_are_refused_too(
    capsys: pytest.CaptureFixture[str], trace: Path
):
    make = ("episodes", "make", "builtin/maple", "--count", "1", "--out")
    assert "/proc: " in refused(capsys, *make, "/proc/x.json")
    export = ("study", "export", trace.parent, "--out")
    assert "/proc: " in refused(capsys, *export, "/proc/x.jsonl")
    assert "came the folder" in refused(capsys, *export, trace.parent)


def failing(monkeypatch: pytest.MonkeyPatch, error: OSError) -> None:
    """Let the next command fail as a disk does in the middle of the work."""

    def fail(words: list[str]) -> int:
        raise error

    monkeypatch.setattr(cli, "_dispatch", fail)


@pytest.mark.parametrize(
    ("error", "named"),
    [
        (PermissionError(errno.EACCES, "Permission denied", "some.file"), "some.file"),
        (OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)), "the disk"),
    ],
)
def test_a_disk_that_refuses_is_told_in_one_message(
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    error: OSError,
    named: str,
):
    failing(monkeypatch, error)
    said = refused(capsys, "doctor")
    assert named in said and said.count("\n") == 1


def test_an_error_of_no_file_is_not_taken_for_bad_usage(monkeypatch: pytest.MonkeyPatch):
    failing(monkeypatch, OSError(errno.EIO, "Input/output error"))
    with pytest.raises(OSError, match="Input/output"):
        main(["doctor"])
