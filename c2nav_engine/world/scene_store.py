"""Scenes on disk as they lie in memory, so that a scan of millions of triangles opens at once.

A folder holds the arrays as `.npy` files, which are mapped and not read, and the pictures as the
scene file had them: decoded, the textures of one scan would take gigabytes.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, cast

import numpy as np
from jaxtyping import UInt8
from PIL import Image

from c2nav_engine.world.load_material import rgba
from c2nav_engine.world.scene import Material, Part, Scene

STORE_VERSION = 1
"""Counts changes of this layout and of the loader: folders of an older one are not read."""

FACTS = "scene.json"
"""Written last: a folder without it is unfinished."""

_PNG_LEVEL = 1

Rgba = UInt8[np.ndarray, "rows columns 4"]


def save_scene(folder: Path, scene: Scene, *, pictures: Iterable[bytes] = ()) -> None:
    """Write a scene into an empty folder.

    Args:
        folder: Made where it is missing.
        scene: What to keep, its content key included.
        pictures: Encoded pictures of the file that the scene came from; a texture that one of
            them decodes to is kept in that form, any other as PNG. Nothing is lost either way.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("vertices_m", "triangles", "uvs", "colours"):
        array = getattr(scene, name)
        if array is not None:
            np.save(folder / f"{name}.npy", np.ascontiguousarray(array))
    number = _save_textures(folder, scene, pictures)
    facts: dict[str, object] = {
        "version": STORE_VERSION,
        "sha256": scene.sha256,
        "licence": scene.licence,
        "textures": len(set(number.values())),
        "parts": [[part.name, part.material, part.first, part.stop] for part in scene.parts],
        "materials": [
            {
                "name": material.name,
                "colour": material.colour,
                "texture": None if material.texture is None else number[id(material.texture)],
                "cutout_alpha": material.cutout_alpha,
                "unlit": material.unlit,
            }
            for material in scene.materials
        ],
    }
    (folder / FACTS).write_text(json.dumps(facts), encoding="utf-8")


def open_scene(folder: Path, *, name: str) -> Scene:
    """A saved scene under a name; its arrays stay on disk until they are touched.

    Raises:
        ValueError: The folder is not whole or of another version; make it again.
    """
    try:
        facts = json.loads((folder / FACTS).read_text(encoding="utf-8"))
        if facts["version"] != STORE_VERSION:
            message = f"{folder}: expected version {STORE_VERSION}, came {facts['version']}"
            raise ValueError(message)
        return _opened(folder, name, facts)
    except (OSError, LookupError, TypeError) as error:
        message = f"{folder}: expected a saved scene, came {type(error).__name__}: {error}"
        raise ValueError(message) from error


def _opened(folder: Path, name: str, facts: Any) -> Scene:
    parts = tuple(Part(str(row[0]), *(int(value) for value in row[1:])) for row in facts["parts"])
    triangles = _mapped(folder, "triangles")
    vertices_m = _mapped(folder, "vertices_m")
    if triangles is None or vertices_m is None or len(triangles) != parts[-1].stop:
        message = f"{folder}: expected {parts[-1].stop} triangles with their vertices"
        raise ValueError(message)
    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        paths = [folder / f"texture{number}" for number in range(int(facts["textures"]))]
        textures = list(pool.map(_read, paths))
    return Scene(
        name=name,
        vertices_m=vertices_m,
        triangles=triangles,
        parts=parts,
        materials=tuple(_material(entry, textures) for entry in facts["materials"]),
        uvs=_mapped(folder, "uvs"),
        colours=_mapped(folder, "colours"),
        licence=str(facts["licence"]),
        known_sha256=str(facts["sha256"]),
    )


def _material(entry: Any, textures: list[Rgba]) -> Material:
    red, green, blue, alpha = (float(value) for value in entry["colour"])
    number: int | None = entry["texture"]
    return Material(
        name=str(entry["name"]),
        colour=(red, green, blue, alpha),
        texture=None if number is None else textures[number],
        cutout_alpha=float(entry["cutout_alpha"]),
        unlit=bool(entry["unlit"]),
    )


def _mapped(folder: Path, name: str) -> np.ndarray | None:
    path = folder / f"{name}.npy"
    if not path.is_file():
        return None
    # Copy on write: kernels compiled for writable arrays take it, and the file cannot change.
    return cast("np.ndarray", np.load(path, mmap_mode="c")).view(np.ndarray)


def _save_textures(folder: Path, scene: Scene, pictures: Iterable[bytes]) -> dict[int, int]:
    """Write each texture once; returns the number of each by the identity of its array."""
    textures = {id(m.texture): m.texture for m in scene.materials if m.texture is not None}
    wanted = {_content(texture) for texture in textures.values()}
    encoded: dict[str, bytes] = {}
    for picture in pictures:
        content = _content(_decoded(picture))
        if content in wanted:
            encoded[content] = picture
    number: dict[int, int] = {}
    for index, (identity, texture) in enumerate(textures.items()):
        data = encoded.get(_content(texture)) or _png(texture)
        (folder / f"texture{index}").write_bytes(data)
        number[identity] = index
    return number


def _content(texture: Rgba) -> str:
    digest = hashlib.sha256(repr(texture.shape).encode())
    digest.update(np.ascontiguousarray(texture).data)
    return digest.hexdigest()


def _read(path: Path) -> Rgba:
    return _decoded(path.read_bytes())


def _decoded(data: bytes) -> Rgba:
    with Image.open(io.BytesIO(data)) as picture:
        return rgba(picture)


def _png(texture: Rgba) -> bytes:
    buffer = io.BytesIO()
    Image.fromarray(texture, "RGBA").save(buffer, "PNG", compress_level=_PNG_LEVEL)
    return buffer.getvalue()
