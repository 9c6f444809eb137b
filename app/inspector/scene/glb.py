"""Write binary glTF: positions, texture coordinates, colours with light; JPEG textures."""

from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np

from c2nav_engine.world.scene import Material

TEXTURE_PX = 1024
"""Longest side of a texture for display [C]: a room is looked at from metres away."""

JPEG_QUALITY = 85

_FLOAT, _UINT, _UBYTE = 5126, 5125, 5121
_ARRAY, _ELEMENTS = 34962, 34963
_REPEAT = 10497
_NEAREST_MIP = 9985
"""Linear within one size of the picture: blending two costs a browser without GPU a fifth more."""

Json = dict[str, Any]


_SRGB = np.arange(256) / 255.0
LINEAR = np.where(_SRGB <= 0.04045, _SRGB / 12.92, ((_SRGB + 0.055) / 1.055) ** 2.4)


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """One primitive: triangles with one material.

    Attributes:
        positions_m: Vertices, float32.
        triangles: Indices, uint32.
        material: How it looks.
        uvs: Texture coordinates with the origin at the top left, or None.
        colours: 8-bit sRGB colour with alpha, or None.
        shades: Share of light at each vertex, linear, or None for all of it.
        opacity: Below 1, what lies behind shines through.
    """

    positions_m: np.ndarray
    triangles: np.ndarray
    material: Material
    uvs: np.ndarray | None = None
    colours: np.ndarray | None = None
    shades: np.ndarray | None = None
    opacity: float = 1.0


def _vertex_colours(surface: Surface) -> np.ndarray | None:
    """Colour times light in linear bytes, as glTF prescribes, with alpha; None for white."""
    if surface.colours is None and surface.shades is None:
        return None
    count = len(surface.positions_m)
    colours = np.full((count, 4), 255, np.uint8) if surface.colours is None else surface.colours
    shades = np.ones(count) if surface.shades is None else surface.shades
    lit = (LINEAR * 255.0)[colours[:, :3]] * shades[:, None]
    return np.concatenate([lit.round().astype(np.uint8), colours[:, 3:]], axis=1)


def pack(surfaces: Sequence[Surface]) -> bytes:
    """One node with one mesh that holds all surfaces."""
    writer = _Writer()
    primitives = [writer.primitive(surface) for surface in surfaces]
    return writer.file(primitives)


class _Writer:
    def __init__(self) -> None:
        self._binary = bytearray()
        self._document: dict[str, list[Json]] = {
            name: []
            for name in ("bufferViews", "accessors", "materials", "textures", "images", "samplers")
        }
        self._materials: dict[tuple[int, float], int] = {}

    def primitive(self, surface: Surface) -> Json:
        attributes = {"POSITION": self._accessor(surface.positions_m, "VEC3", bounds=True)}
        if surface.uvs is not None:
            attributes["TEXCOORD_0"] = self._accessor(surface.uvs, "VEC2")
        colours = _vertex_colours(surface)
        if colours is not None:
            attributes["COLOR_0"] = self._accessor(colours, "VEC4")
        return {
            "attributes": attributes,
            "indices": self._accessor(surface.triangles.reshape(-1), "SCALAR"),
            "material": self._material(surface.material, surface.opacity),
        }

    def _accessor(self, array: np.ndarray, kind: str, *, bounds: bool = False) -> int:
        component, target = _FLOAT, _ARRAY
        if kind == "SCALAR":
            array, component, target = array.astype("<u4"), _UINT, _ELEMENTS
        elif array.dtype == np.uint8:
            component = _UBYTE
        else:
            array = array.astype("<f4")
        view = self._view(np.ascontiguousarray(array).tobytes(), target)
        accessor: Json = {
            "bufferView": view,
            "componentType": component,
            "count": len(array),
            "type": kind,
        }
        if component == _UBYTE:
            accessor["normalized"] = True
        if bounds and len(array):
            columns = array.T
            accessor["min"] = [float(column.min()) for column in columns]
            accessor["max"] = [float(column.max()) for column in columns]
        return self._add("accessors", accessor)

    def _view(self, data: bytes, target: int | None) -> int:
        view: Json = {"buffer": 0, "byteOffset": len(self._binary), "byteLength": len(data)}
        if target is not None:
            view["target"] = target
        self._binary += data + b"\0" * (-len(data) % 4)
        return self._add("bufferViews", view)

    def _add(self, section: str, item: Json) -> int:
        self._document[section].append(item)
        return len(self._document[section]) - 1

    def _material(self, material: Material, opacity: float) -> int:
        key = id(material), opacity
        if key not in self._materials:
            self._materials[key] = self._add("materials", self._described(material, opacity))
        return self._materials[key]

    def _described(self, material: Material, opacity: float) -> Json:
        red, green, blue, alpha = material.colour
        surface: Json = {
            "baseColorFactor": [red, green, blue, alpha * opacity],
            "metallicFactor": 0.0,
            "roughnessFactor": 1.0,
        }
        if material.texture is not None:
            surface["baseColorTexture"] = {"index": self._texture(material)}
        described: Json = {
            "name": material.name,
            "pbrMetallicRoughness": surface,
            "doubleSided": True,
            # The light is in the vertices: none is left to reckon with at every pixel.
            "extensions": {"KHR_materials_unlit": {}},
        }
        if material.cutout_alpha > 0.0:
            described |= {"alphaMode": "MASK", "alphaCutoff": material.cutout_alpha}
        elif opacity < 1.0:
            described["alphaMode"] = "BLEND"
        return described

    def _texture(self, material: Material) -> int:
        data, media_type = encode_texture(material)
        view = self._view(data, None)
        image = self._add("images", {"bufferView": view, "mimeType": media_type})
        if not self._document["samplers"]:
            self._add("samplers", {"wrapS": _REPEAT, "wrapT": _REPEAT, "minFilter": _NEAREST_MIP})
        return self._add("textures", {"source": image, "sampler": 0})

    def file(self, primitives: list[Json]) -> bytes:
        document: Json = {
            "asset": {"version": "2.0", "generator": "c2nav"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": primitives}],
            "buffers": [{"byteLength": len(self._binary)}],
            "extensionsUsed": ["KHR_materials_unlit"],
            **{name: items for name, items in self._document.items() if items},
        }
        text = json.dumps(document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        total = 12 + 8 + len(text) + 8 + len(self._binary)
        return b"".join(
            [
                struct.pack("<4sII", b"glTF", 2, total),
                struct.pack("<I4s", len(text), b"JSON"),
                text,
                struct.pack("<I4s", len(self._binary), b"BIN\0"),
                bytes(self._binary),
            ]
        )


def encode_texture(material: Material) -> tuple[bytes, str]:
    """A material's texture, small enough to send: JPEG, or PNG where alpha matters."""
    texture = material.texture
    if texture is None:
        return b"", ""
    longest = max(texture.shape[:2])
    if longest > TEXTURE_PX:
        scale = TEXTURE_PX / longest
        size = (max(1, round(texture.shape[1] * scale)), max(1, round(texture.shape[0] * scale)))
        texture = cv2.resize(texture, size, interpolation=cv2.INTER_AREA)
    if material.cutout_alpha > 0.0:
        _, data = cv2.imencode(".png", cv2.cvtColor(texture, cv2.COLOR_RGBA2BGRA))
        return data.tobytes(), "image/png"
    bgr = cv2.cvtColor(np.ascontiguousarray(texture[:, :, :3]), cv2.COLOR_RGB2BGR)
    _, data = cv2.imencode(".jpg", bgr, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])
    return data.tobytes(), "image/jpeg"
