"""Generates the protobuf modules: `python -m c2nav_engine.traces.generate` (needs grpcio-tools)."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

from c2nav_engine.errors import InternalError

PACKAGE = Path("c2nav_engine/traces/pb")
ROOT = Path(__file__).resolve().parents[2]


def generate(out: Path = ROOT) -> list[Path]:
    """Write `*_pb2.py` and `*_pb2.pyi` below `out`, in the package's own folder; returns them.

    Raises `InternalError` where a schema does not compile; the compiler says why.
    """
    schemas = sorted((ROOT / PACKAGE).glob("*.proto"))
    out.mkdir(parents=True, exist_ok=True)
    compiler: Any = importlib.import_module("grpc_tools.protoc")
    outputs = [f"--python_out={out}", f"--pyi_out={out}"]
    if compiler.main(["protoc", f"-I{ROOT}", *outputs, *map(str, schemas)]) != 0:
        message = f"expected schemas that compile below {PACKAGE}; mend what the compiler named"
        raise InternalError(message)
    return sorted((out / PACKAGE).glob("*_pb2.py*"))


if __name__ == "__main__":
    generate()
