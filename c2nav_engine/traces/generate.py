"""Generates the protobuf modules: `python -m c2nav_engine.traces.generate` (needs grpcio-tools)."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

PACKAGE = Path("c2nav_engine/traces/pb")
ROOT = Path(__file__).resolve().parents[2]


def generate(out: Path = ROOT) -> list[Path]:
    """Write `*_pb2.py` and `*_pb2.pyi` below `out`, in the package's own folder; returns them."""
    schemas = sorted((ROOT / PACKAGE).glob("*.proto"))
    out.mkdir(parents=True, exist_ok=True)
    command = [sys.executable, "-m", "grpc_tools.protoc", f"-I{ROOT}"]
    command += [f"--python_out={out}", f"--pyi_out={out}", *map(str, schemas)]
    subprocess.run(command, check=True)  # noqa: S603 the arguments are our own
    return sorted((out / PACKAGE).glob("*_pb2.py*"))


if __name__ == "__main__":
    generate()
