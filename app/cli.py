"""The `c2nav` command: one small function per subcommand, each in `app.commands`.

Exit codes: 0 done; 1 a check found a difference, an episode ended in `error`, or standard output
was closed before the end, as by `| head`; 2 bad usage or bad input, with one message on standard
error; 130 interrupted, with everything finished kept.
"""

from __future__ import annotations

import errno
import importlib
import itertools
import os
import select
import sys
from collections.abc import Callable, Sequence

import tyro

from app.commands.importing import uncollected
from c2nav_engine.errors import C2NavError, InputError, MissingExtra, RankerStopped, UsageError

Command = Callable[..., int]

COMMANDS = (
    "agree",
    "cases",
    "doctor",
    "episodes",
    "inspect",
    "run",
    "report",
    "reeval",
    "scene",
    "replay",
    "question",
    "fork",
    "figure",
    "study",
    "trace",
    "turning",
    "bench",
)
"""Subcommands; each is a function, or a table of them, of that name in `app.commands`."""

_PLACES = ("--out", "--into", "--pictures")
"""Options that name where a command writes."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Run one subcommand and exit with its code."""
    try:
        try:
            code = _run(arguments)
        finally:
            sys.stdout.flush()
    except BrokenPipeError:
        if not _output_closed():
            raise
        # The rest goes nowhere: else the interpreter complains about it once more at its end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        code = 1
    sys.exit(code)


def _run(arguments: Sequence[str] | None) -> int:
    """The exit code; errors of ours are told in one message."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    debug = "--debug" in words
    words = [word for word in words if word != "--debug"]
    try:
        return _dispatch(words)
    except KeyboardInterrupt:
        sys.stderr.write("interrupted; everything finished is kept\n")
        return 130
    except C2NavError as error:
        if debug:
            raise
        sys.stderr.write(f"c2nav: {error}\n")
        return 2 if isinstance(error, InputError | MissingExtra | RankerStopped) else 1
    except OSError as error:
        where = _place_of(error)
        if debug or not where:
            raise
        sys.stderr.write(
            f"c2nav: expected files that can be read and written, came {error.strerror}: {where}; "
            "mend the place or name another (--debug says where in the program)\n"
        )
        return 2


def _place_of(error: OSError) -> str:
    """The file that the user's disk refused; "" for what no file name or disk explains."""
    if error.filename is not None:
        return str(error.filename2 or error.filename)
    # A write that finds the disk full does not know its file any more.
    return "the disk" if error.errno in (errno.ENOSPC, errno.EDQUOT) else ""


def _output_closed() -> bool:
    """Whether nobody can read standard output any more."""
    asked = select.poll()
    asked.register(sys.stdout.fileno(), 0)
    return any(event & select.POLLERR for _, event in asked.poll(0))


def _dispatch(words: list[str]) -> int:
    """Load only the named subcommand: each brings its own heavy imports."""
    _check_places(words)
    name = next((word for word in words if not word.startswith("-")), "")
    if name not in COMMANDS:
        return _code(tyro.extras.subcommand_cli_from_dict(_everything(), args=words))
    command = _loaded(name)
    if not callable(command):
        return _code(
            tyro.extras.subcommand_cli_from_dict(command, args=words[1:], prog=f"c2nav {name}")
        )
    return _code(tyro.cli(command, args=words[1:], prog=f"c2nav {name}"))


def _check_places(words: list[str]) -> None:
    """An empty name, as of an unset variable, would mean the working folder to a path."""
    for option in _PLACES:
        if f"{option}=" in words or (option, "") in itertools.pairwise(words):
            message = f"expected a file or folder after {option}, came an empty word; name one"
            raise UsageError(message)


def _everything() -> dict[str, Command]:
    """All subcommands flat, for `c2nav --help`."""
    flat: dict[str, Command] = {}
    for name in COMMANDS:
        command = _loaded(name)
        if not callable(command):
            flat.update({f"{name} {inner}": function for inner, function in command.items()})
        else:
            flat[name] = command
    return flat


def _code(result: object) -> int:
    return result if isinstance(result, int) else 0


def _loaded(name: str) -> Command | dict[str, Command]:
    with uncollected():
        return getattr(importlib.import_module(f"app.commands.{name}"), name)
