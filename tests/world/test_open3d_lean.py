from __future__ import annotations

import subprocess
import sys

LOADS = """
import sys
from c2nav_engine.world.open3d_lean import open3d
scene = open3d().t.geometry.RaycastingScene()
assert open3d().visualization.rendering.MaterialRecord is not None
print(*sorted({"dash", "plotly", "flask", "IPython"} & set(sys.modules)))
"""


def test_casting_rays_loads_no_notebook_library():
    found = subprocess.run(
        [sys.executable, "-c", LOADS], capture_output=True, text=True, check=True
    )
    assert found.stdout.strip() == ""
