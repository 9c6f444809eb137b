"""Options that several subcommands share, and how their texts are read."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import tyro

from c2nav_engine.errors import UsageError

SourceArg = Annotated[
    str,
    tyro.conf.Positional,
    tyro.conf.arg(
        name="source", metavar="SOURCE", help="`builtin`, or an R2R-CE file (.json, .json.gz)."
    ),
]
ScenesOpt = Annotated[
    Path | None,
    tyro.conf.arg(metavar="DIR", help="Folder below which scene ids resolve."),
]
ConnectivityOpt = Annotated[
    Path | None,
    tyro.conf.arg(metavar="DIR", help="Folder of Matterport graphs, SCAN_connectivity.json."),
]
EpisodesOpt = Annotated[
    str, tyro.conf.arg(metavar="IDS", help="Episode ids, as in 1,5-9; all by default.")
]
RankerOptions = Annotated[
    tuple[str, ...],
    tyro.conf.UseAppendAction,
    tyro.conf.arg(metavar="KEY=VALUE", help="An option of the ranker; repeat for more."),
]
HeadingsOpt = Annotated[
    Path | None,
    tyro.conf.arg(metavar="FILE", help="Take start rotations from this file of the same episodes."),
]
GroundTruthOpt = Annotated[
    Path | None,
    tyro.conf.arg(metavar="FILE", help="Reference positions; the `_gt` file beside by default."),
]
JsonOpt = Annotated[bool, tyro.conf.arg(help="Print one JSON object and nothing else.")]

BESIDE_SCENES = "connectivity"
"""Folder below the scenes that is taken where no folder of graphs is named."""

_RANGE = re.compile(r"(\d+)-(\d+)")


def connectivity_folder(named: Path | None, scenes: Path | None) -> Path | None:
    """Where connectivity graphs lie; raises `UsageError` when what was named is no folder."""
    if named is not None and not named.is_dir():
        message = (
            f"expected a folder of SCAN_connectivity.json files, came --connectivity {named}; "
            "take Matterport3DSimulator's folder `connectivity`"
        )
        raise UsageError(message)
    beside = None if scenes is None else scenes / BESIDE_SCENES
    return named or (beside if beside is not None and beside.is_dir() else None)


def words(text: str) -> tuple[str, ...]:
    """Comma-separated words."""
    return tuple(word.strip() for word in text.split(",") if word.strip())


def ids(text: str) -> tuple[str, ...]:
    """Episode ids from `1,5-9`; a range stands for every whole number in it."""
    found: list[str] = []
    for word in words(text):
        bounds = _RANGE.fullmatch(word)
        if bounds is None:
            found.append(word)
            continue
        first, last = int(bounds[1]), int(bounds[2])
        if last < first or last - first > 100_000:
            message = f"expected a rising range of episode ids, came {word!r}"
            raise UsageError(message)
        found += [str(number) for number in range(first, last + 1)]
    if text and not found:
        message = f"expected episode ids, as in 1,5-9, came {text!r}; leave the option out for all"
        raise UsageError(message)
    return tuple(found)


def whole_numbers(text: str, what: str) -> tuple[int, ...]:
    """Comma-separated whole numbers; raises `UsageError` naming what they are."""
    try:
        return tuple(int(word) for word in words(text))
    except ValueError:
        message = f"expected {what} as whole numbers (0,1,2), came {text!r}"
        raise UsageError(message) from None


def key_values(pairs: Sequence[str]) -> dict[str, str]:
    """`KEY=VALUE` words as a mapping; raises `UsageError`."""
    found: dict[str, str] = {}
    for pair in pairs:
        key, equals, value = pair.partition("=")
        if not equals or not key:
            message = f"expected an option as KEY=VALUE, came {pair!r}"
            raise UsageError(message)
        found[key] = value
    return found
