"""Shared set-up: run-time type and shape checks, and where the shared inputs lie."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import settings
from jaxtyping import install_import_hook

from tests.helpers import checker

# Shapes and types in the engine's signatures hold in every test, or the test fails.
install_import_hook("c2nav_engine", f"{checker.__name__}.checked")

# The same examples in every run, on every machine: a red test stays red, a green one green.
settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.load_profile("repeatable")

SHARED = Path(__file__).resolve().parents[2] / "shared"


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of real episodes, scenes and reference answers beside the repository."""
    if not (SHARED / "data").is_dir():
        pytest.skip(f"the shared inputs are not here (expected {SHARED.name}/data beside the repo)")
    return SHARED
