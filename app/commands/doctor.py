"""`c2nav doctor`: what works on this machine, and how to mend the rest."""

from __future__ import annotations

import ctypes.util
import importlib.util
import os
import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from app.commands.options import JsonOpt
from app.commands.output import print_json

EXTRAS = {
    "local": ("torch", "transformers"),
    "rerun": ("rerun",),
    "ray": ("ray",),
    "slurm": ("submitit",),
    "bench": ("pyrender", "playwright"),
}
"""Extra → modules that it brings."""
KEY_VARIABLES = ("OPENAI_API_KEY",)
"""Variables that commonly hold a key; only whether they are set is told."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that was tried.

    Attributes:
        name: What.
        ok: Whether it works.
        detail: What was found.
        mend: What to do where it does not.
        needed: Whether the inspector cannot do without it.
    """

    name: str
    ok: bool
    detail: str
    mend: str = ""
    needed: bool = False


def doctor(json: JsonOpt = False) -> int:
    """Try what the inspector needs, and say how to mend what does not work."""
    found = [_python(), _embree(), _filament(), _browser(), *_extras(), *_keys(), *_folders()]
    if json:
        print_json(
            {item.name: {"ok": item.ok, "detail": item.detail, "mend": item.mend} for item in found}
        )
    else:
        table = Table(box=None, show_header=False)
        for item in found:
            sign = "[green]✓[/]" if item.ok else ("[red]✕[/]" if item.needed else "–")
            table.add_row(sign, item.name, item.detail, item.mend)
        Console(highlight=False).print(table)
    return 1 if any(item.needed and not item.ok for item in found) else 0


def _python() -> Finding:
    version = ".".join(map(str, sys.version_info[:3]))
    return Finding("python", sys.version_info >= (3, 11), version, needed=True)


def _embree() -> Finding:
    def cast() -> str:
        import open3d

        o3d: Any = open3d
        tensor = o3d.core.Tensor
        scene = o3d.t.geometry.RaycastingScene()
        corners = np.array([[-1, -1, -2], [1, -1, -2], [0, 1, -2]], np.float32)
        scene.add_triangles(tensor(corners), tensor(np.array([[0, 1, 2]], np.uint32)))
        ray = tensor(np.array([[0, 0, 0, 0, 0, -1]], np.float32))
        depth_m = float(scene.cast_rays(ray)["t_hit"].numpy()[0])
        return f"Open3D {o3d.__version__}, a ray hit at {depth_m:.1f} m"

    mend = "apt-get install libusb-1.0-0 libgl1 libegl1 libgomp1, then `make setup`"
    return _tried("renderer embree", cast, mend=mend, needed=True)


def _filament() -> Finding:
    has_vulkan = ctypes.util.find_library("vulkan") is not None
    return Finding(
        "renderer filament (real GPUs)",
        has_vulkan,
        "Vulkan loader found" if has_vulkan else "no Vulkan loader",
        "" if has_vulkan else "apt-get install libvulkan1 and the GPU's driver; not needed",
    )


def _browser() -> Finding:
    path = os.environ.get("CHROMIUM") or shutil.which("chromium") or shutil.which("google-chrome")
    mend = "" if path else "apt-get install chromium, or set CHROMIUM; only tests need it"
    return Finding("browser for tests", bool(path), path or "none on PATH", mend)


def _extras() -> list[Finding]:
    found: list[Finding] = []
    for extra, modules in EXTRAS.items():
        missing = [name for name in modules if importlib.util.find_spec(name) is None]
        detail = "installed" if not missing else f"without {', '.join(missing)}"
        mend = f"uv sync --extra {extra}" if missing else ""
        found.append(Finding(f"extra {extra}", not missing, detail, mend))
    return found


def _keys() -> list[Finding]:
    return [
        Finding(f"key {name}", name in os.environ, "set" if name in os.environ else "not set")
        for name in KEY_VARIABLES
    ]


def _folders() -> list[Finding]:
    from c2nav_engine.runner.worlds import cache_folder

    folders = {"cache": cache_folder(), "logs": Path("logs")}
    return [
        _tried(
            f"folder {name}",
            lambda path=path: _writable(path),
            mend=f"make {path} writable, or set C2NAV_CACHE",
        )
        for name, path in folders.items()
    ]


def _writable(path: Path) -> str:
    path.mkdir(parents=True, exist_ok=True)
    probe = path / ".probe"
    probe.write_text("", encoding="utf-8")
    probe.unlink()
    return str(path)


def _tried(name: str, try_it: Callable[[], str], *, mend: str, needed: bool = False) -> Finding:
    try:
        return Finding(name, True, try_it(), needed=needed)
    except (ImportError, OSError, RuntimeError) as error:
        return Finding(name, False, str(error).splitlines()[0], mend, needed)
