"""What the program imports is what its package asks for: extras of tests must not hide a gap."""

from __future__ import annotations

import ast
import re
import sys
import tomllib
from collections.abc import Iterable, Iterator
from importlib.metadata import packages_distributions
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
OURS = {"app", "c2nav_engine", "benchmarks"}
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
OWNERS = packages_distributions()


def names(requirements: Iterable[str]) -> set[str]:
    return {re.split(r"[^A-Za-z0-9._-]", each, maxsplit=1)[0].lower() for each in requirements}


# The small wheel of one platform and the large one of the others hold the same module.
BASE = names(PROJECT["dependencies"]) | {"open3d"}
EXTRAS = names(each for group in PROJECT["optional-dependencies"].values() for each in group)


def sources() -> list[Path]:
    return sorted(path for name in ("app", "c2nav_engine") for path in (ROOT / name).rglob("*.py"))


def imported(nodes: Iterable[ast.AST]) -> Iterator[tuple[str, set[str]]]:
    """Third-party modules of import statements, each with the packages that bring it."""
    for node in nodes:
        found: list[str] = []
        if isinstance(node, ast.Import):
            found = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            found = [node.module or ""]
        for top in {name.partition(".")[0] for name in found}:
            if top not in sys.stdlib_module_names and top not in OURS:
                # A module that is not installed here can only be that of an extra of its name.
                yield top, {owner.lower() for owner in OWNERS.get(top, [top])}


def test_everything_imported_is_asked_for():
    undeclared = {
        (path.name, top)
        for path in sources()
        for top, owners in imported(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
        if not owners & (BASE | EXTRAS)
    }
    assert not undeclared


def test_what_only_an_extra_brings_is_imported_where_it_is_used():
    at_the_top = {
        (path.name, top)
        for path in sources()
        for top, owners in imported(ast.parse(path.read_text(encoding="utf-8")).body)
        if not owners & BASE and owners & EXTRAS
    }
    assert not at_the_top
