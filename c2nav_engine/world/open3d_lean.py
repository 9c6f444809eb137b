"""Open3D without its notebook plots, which we never draw.

`import open3d` also loads dash, plotly, flask and IPython for one plotting function: two thirds of
its start-up time and 40 MB in every worker. An empty module in that function's place spares them.
"""

from __future__ import annotations

import importlib
import sys
from types import ModuleType
from typing import Any

_PLOTS = "open3d.visualization.draw_plotly"


class _Absent(ModuleType):
    """Has every public name, so that Open3D may import from it whatever it likes."""

    def __getattr__(self, name: str) -> None:
        if name.startswith("__"):
            raise AttributeError(name)


def open3d() -> Any:
    """The package, imported at the first call: half a second, so call it where rays are cast."""
    if "open3d" not in sys.modules:
        sys.modules.setdefault(_PLOTS, _Absent(_PLOTS))
    return importlib.import_module("open3d")
