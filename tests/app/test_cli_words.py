"""How the words of a command line are read."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest

from app.cli import main
from app.commands.options import ids, key_values, whole_numbers
from c2nav_engine.errors import UsageError


def test_episode_ids_are_ids_and_ranges():
    assert ids("1,5-9") == ("1", "5", "6", "7", "8", "9")
    assert ids("") == ()
    assert ids("a-b, 7") == ("a-b", "7")


@pytest.mark.parametrize("word", ["9-5", "0-99999999"])
def test_a_range_that_falls_or_never_ends_is_refused(word):
    with pytest.raises(UsageError, match=word):
        ids(word)


def test_options_keep_everything_after_the_first_equals_sign():
    assert key_values(["base_url=http://h/v1?a=b", "x="]) == {
        "base_url": "http://h/v1?a=b",
        "x": "",
    }


def test_seeds_are_whole_numbers():
    assert whole_numbers("0, 1", "seeds") == (0, 1)
    with pytest.raises(UsageError, match=r"expected seeds.*came '0\.5'"):
        whole_numbers("0.5", "seeds")


def test_json_prints_one_object_and_nothing_else(capsys):
    with pytest.raises(SystemExit) as stopped:
        main(["episodes", "list", "builtin", "--episodes", "1-2", "--json"])
    assert stopped.value.code == 0
    printed = capsys.readouterr().out
    assert [e["episode_id"] for e in json.loads(printed)["episodes"]] == ["1", "2"]
    assert printed.count("\n") == 1


def test_an_episode_is_shown_with_its_legs(capsys):
    with pytest.raises(SystemExit):
        main(["episodes", "show", "builtin", "1", "--json"])
    shown = json.loads(capsys.readouterr().out)
    assert " ".join(shown["legs"])[:4] == shown["instruction"][:4]
    assert len(shown["legs"]) >= 2


@pytest.mark.parametrize("words", [["--help"], ["episodes", "list", "builtin"], ["doctor"]])
def test_output_that_nobody_reads_ends_a_command_quietly(words):
    read, write = os.pipe()
    os.close(read)
    code = "import sys; from app.cli import main; main(sys.argv[1:])"
    done = subprocess.run(
        [sys.executable, "-c", code, *words], stdout=write, stderr=subprocess.PIPE, check=False
    )
    os.close(write)
    assert (done.returncode, done.stderr) == (1, b"")


def test_a_broken_pipe_elsewhere_is_told(monkeypatch):
    def command() -> int:
        raise BrokenPipeError("of a worker")

    monkeypatch.setattr("app.cli._loaded", lambda name: command)
    with pytest.raises(BrokenPipeError, match="of a worker"):
        main(["doctor"])
