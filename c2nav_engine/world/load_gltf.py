"""What a glTF header says that the mesh loader drops: licence, unlit materials, true length."""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

from c2nav_engine.errors import SceneError

GLB_MAGIC = b"glTF"
JSON_CHUNK = b"JSON"


@dataclass(frozen=True, slots=True)
class GltfFacts:
    """Facts of a glTF file.

    Attributes:
        is_gltf: Whether it is one at all (PLY and OBJ are not).
        licence: The asset's licence or copyright, "" when it names none.
        unlit: Names of the materials marked `KHR_materials_unlit`.
    """

    is_gltf: bool = False
    licence: str = ""
    unlit: frozenset[str] = frozenset()


def gltf_facts(path: Path) -> GltfFacts:
    """Read the header of a `.glb` or `.gltf`; raises `SceneError` for a file cut short."""
    try:
        header: Any = json.loads(
            _glb_json(path) if path.suffix.lower() == ".glb" else path.read_bytes()
        )
    except ValueError as error:
        message = f"scene {path}: expected a glTF header, came {error}; fetch it again"
        raise SceneError(message) from error
    if not isinstance(header, dict) or "asset" not in header:
        message = f"scene {path}: expected a glTF header with an asset; fetch it again"
        raise SceneError(message)
    header = cast("dict[str, Any]", header)
    asset = header["asset"]
    extras: Any = asset.get("extras") or {}
    return GltfFacts(
        is_gltf=True,
        licence=str(_text(extras, "license") or asset.get("copyright") or ""),
        unlit=frozenset(
            str(material.get("name", ""))
            for material in header.get("materials", [])
            if "KHR_materials_unlit" in material.get("extensions", {})
        ),
    )


def _text(extras: Any, key: str) -> str:
    return str(cast("dict[str, Any]", extras).get(key, "")) if isinstance(extras, dict) else ""


def _glb_json(path: Path) -> bytes:
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(20)
        if len(head) < 20 or head[:4] != GLB_MAGIC or head[16:20] != JSON_CHUNK:
            message = (
                f"scene {path}: expected a binary glTF header, came {head[:20]!r}; fetch it again"
            )
            raise SceneError(message)
        version, length, json_length = struct.unpack("<III", head[4:16])
        if version != 2:
            message = f"scene {path}: expected glTF 2, came version {version}; convert it"
            raise SceneError(message)
        if size < length:
            message = (
                f"scene {path}: expected {length} bytes, came {size}; fetch it again, it is cut"
            )
            raise SceneError(message)
        return file.read(json_length)
