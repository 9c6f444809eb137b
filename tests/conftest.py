"""Shared set-up: run-time type and shape checks, and where the shared inputs lie."""

from __future__ import annotations

from pathlib import Path

import pytest
from jaxtyping import install_import_hook

from tests.helpers import checker

# Shapes and types in the engine's signatures hold in every test, or the test fails.
install_import_hook("c2nav_engine", f"{checker.__name__}.checked")

SHARED = Path(__file__).resolve().parents[2] / "shared"


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of real episodes, scenes and reference answers beside the repository."""
    if not (SHARED / "data").is_dir():
        pytest.skip(f"the shared inputs are not here (expected {SHARED.name}/data beside the repo)")
    return SHARED
