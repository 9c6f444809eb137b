from __future__ import annotations

import subprocess
import sys

HEAVY = ("matplotlib", "numba", "open3d", "pandas", "pyarrow", "scipy", "torch", "trimesh")
"""Each takes a tenth of a second or more to load; whoever opens a trace waits for none of them."""


def test_the_inspector_serves_before_any_heavy_library_is_loaded():
    code = f"import app.commands.inspect, sys; print(*set({HEAVY}) & set(sys.modules))"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.split() == []
