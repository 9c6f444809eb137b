from __future__ import annotations

import subprocess
import sys

HEAVY = ("matplotlib", "numba", "open3d", "pandas", "pyarrow", "scipy", "torch", "trimesh")
"""Each takes a tenth of a second or more to load; whoever opens a trace waits for none of them."""


LATE = ("fastapi", "jinja2", "mcap", "viser", "app.session.worker")
"""What the page's own bytes do not need: it is being read while these load."""


def loaded(modules: str) -> set[str]:
    """Everything that a fresh program has loaded once these are imported."""
    code = f"import {modules}, sys; print(*sys.modules)"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(found.stdout.split())


def test_a_trace_is_open_before_any_heavy_library_is_loaded():
    assert not loaded("app.commands.inspect, app.commands.inspected") & set(HEAVY)


def test_the_page_is_served_before_viser_and_the_session_are_loaded():
    assert not loaded("app.commands.inspect") & set(LATE)
