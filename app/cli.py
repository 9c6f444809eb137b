"""The `c2nav` command: one small function per subcommand, each in `app.commands`.

Exit codes: 0 done; 1 a check found a difference or an episode ended in `error`; 2 bad usage or bad
input, with one message on standard error; 130 interrupted, with everything finished kept.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Sequence

import tyro

from app.commands.importing import uncollected
from c2nav_engine.errors import C2NavError, InputError, MissingExtra, RankerStopped

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


def main(arguments: Sequence[str] | None = None) -> None:
    """Run one subcommand and exit with its code."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    debug = "--debug" in words
    words = [word for word in words if word != "--debug"]
    try:
        code = _dispatch(words)
    except KeyboardInterrupt:
        sys.stderr.write("interrupted; everything finished is kept\n")
        code = 130
    except C2NavError as error:
        if debug:
            raise
        sys.stderr.write(f"c2nav: {error}\n")
        code = 2 if isinstance(error, InputError | MissingExtra) else 1
        code = 2 if isinstance(error, RankerStopped) else code
    sys.exit(code)


def _dispatch(words: list[str]) -> int:
    """Load only the named subcommand: each brings its own heavy imports."""
    name = next((word for word in words if not word.startswith("-")), "")
    if name not in COMMANDS:
        return _code(tyro.extras.subcommand_cli_from_dict(_everything(), args=words))
    command = _loaded(name)
    if not callable(command):
        return _code(
            tyro.extras.subcommand_cli_from_dict(command, args=words[1:], prog=f"c2nav {name}")
        )
    return _code(tyro.cli(command, args=words[1:], prog=f"c2nav {name}"))


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
