"""The encoded pictures inside a binary glTF file, as they are."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

_BINARY_CHUNK = b"BIN\0"


def is_whole(path: Path) -> bool:
    """Whether a scene file holds all that it shows, so that its bytes alone are its content.

    True of a `.glb` that names no other file, and of a `.ply` without a texture; a `.gltf` or
    `.obj` always leans on others.
    """
    if path.suffix.lower() == ".ply":
        with path.open("rb") as file:
            return b"TextureFile" not in file.read(4096)
    if path.suffix.lower() != ".glb":
        return False
    document, _ = _document(path)
    entries = [*document.get("images", []), *document.get("buffers", [])]
    return all(str(entry.get("uri", "data:")).startswith("data:") for entry in entries)


def glb_pictures(path: Path) -> Iterator[bytes]:
    """Pictures in the binary chunk of a `.glb`, in the file's order; nothing for other files."""
    if path.suffix.lower() != ".glb":
        return
    document, start = _document(path)
    views = document.get("bufferViews", [])
    with path.open("rb") as file:
        for image in document.get("images", []):
            if "bufferView" in image:
                view = views[image["bufferView"]]
                file.seek(start + view.get("byteOffset", 0))
                yield file.read(view["byteLength"])


def _document(path: Path) -> tuple[dict[str, Any], int]:
    """The JSON header of a `.glb` that has been read before, and where its binary data begins."""
    with path.open("rb") as file:
        file.seek(12)
        length, _ = struct.unpack("<I4s", file.read(8))
        document = json.loads(file.read(length))
        head = file.read(8)
        has_binary = len(head) == 8 and head[4:] == _BINARY_CHUNK
        return document, file.tell() if has_binary else 0
