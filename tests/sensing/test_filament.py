"""The GPU renderer conforms too, judged by hue because its light is its own."""

from __future__ import annotations

import pytest

from c2nav_engine.sensing.conformance import CHECKS, Tolerance
from c2nav_engine.sensing.filament import FilamentRenderer, filament_unavailable

OWN_LIGHT = Tolerance(depth=1e-3, level=None)


@pytest.fixture(scope="module", autouse=True)
def _vulkan():
    reason = filament_unavailable()
    if reason:
        pytest.skip(reason)


@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.__name__)
def test_filament_conforms(check):
    check(FilamentRenderer, OWN_LIGHT)
