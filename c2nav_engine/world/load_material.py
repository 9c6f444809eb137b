"""Materials of the mesh loader, of whatever kind, to ours."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
from jaxtyping import UInt8

from c2nav_engine.world.scene import Material

SEE_THROUGH_ALPHA = 0.5
"""Blended surfaces (panes, leaves) are there where alpha reaches this; rays do not blend."""


class Materials:
    """Turns each loader's material into one `Material`, once, however many meshes share it."""

    def __init__(self, unlit: frozenset[str], *, all_unlit: bool = False) -> None:
        self._unlit = unlit
        self._all_unlit = all_unlit
        self._made: dict[tuple[object, ...], Material] = {}
        self._textures: dict[int, UInt8[np.ndarray, "rows columns 4"]] = {}
        # Keys are ids of the loader's objects, so these must outlive the dictionary.
        self._alive: list[object] = []

    def of(self, visual: Any) -> Material:
        """The material of a mesh's visual; plain white where it has only vertex colours."""
        source = getattr(visual, "material", None) if visual.kind == "texture" else None
        has_uvs = source is not None and visual.uv is not None
        image = _image(source) if has_uvs else None
        name = str(getattr(source, "name", None) or "")
        colour, cutout = _factors(source), _cutout_alpha(source)
        key = (name, colour, cutout, None if image is None else id(image))
        if key not in self._made:
            unlit = self._all_unlit or name in self._unlit
            self._made[key] = Material(name, colour, self._texture(image), cutout, unlit)
        return self._made[key]

    def _texture(self, image: Any) -> UInt8[np.ndarray, "rows columns 4"] | None:
        if image is None:
            return None
        if id(image) not in self._textures:
            self._alive.append(image)
            self._textures[id(image)] = rgba(image)
        return self._textures[id(image)]


def rgba(image: Any) -> UInt8[np.ndarray, "rows columns 4"]:
    """Any picture (RGB, palette, greyscale, 16-bit, with or without alpha) as 8-bit RGBA."""
    if str(image.mode).startswith(("I", "F")):
        # Pillow clips 16-bit greyscale instead of scaling it.
        grey = np.asarray(image)
        grey = np.clip(grey / (257.0 if str(image.mode).startswith("I") else 1 / 255.0), 0, 255)
        return np.dstack([grey, grey, grey, np.full_like(grey, 255.0)]).astype(np.uint8)
    return np.ascontiguousarray(image.convert("RGBA"), np.uint8)


def linear_from_srgb(srgb: float) -> float:
    """The linear value in [0, 1] of an sRGB value in [0, 1]."""
    return srgb / 12.92 if srgb <= 0.04045 else ((srgb + 0.055) / 1.055) ** 2.4


def srgb_from_linear(linear: UInt8[np.ndarray, "n 4"]) -> UInt8[np.ndarray, "n 4"]:
    """8-bit linear colours as 8-bit sRGB; alpha stays."""
    values = np.arange(256) / 255.0
    curve = np.where(values <= 0.0031308, 12.92 * values, 1.055 * values ** (1 / 2.4) - 0.055)
    table = np.rint(curve * 255.0).astype(np.uint8)
    srgb = table[linear]
    srgb[:, 3] = linear[:, 3]
    return srgb


def _image(source: Any) -> Any:
    """The base colour picture of a PBR or a simple material."""
    for name in ("baseColorTexture", "image"):
        image = getattr(source, name, None)
        if image is not None:
            return image
    return None


def _factors(source: Any) -> tuple[float, float, float, float]:
    """Linear base colour factors; a simple material's diffuse colour is sRGB."""
    factor = getattr(source, "baseColorFactor", None)
    if factor is not None:
        return _four(factor)
    if getattr(source, "image", None) is not None:
        # Exporters write a grey diffuse colour beside a picture that is meant as it is.
        return (1.0, 1.0, 1.0, 1.0)
    diffuse = getattr(source, "diffuse", None)
    if diffuse is None:
        return (1.0, 1.0, 1.0, 1.0)
    red, green, blue, alpha = _four(diffuse)
    return (linear_from_srgb(red), linear_from_srgb(green), linear_from_srgb(blue), alpha)


def _four(factor: Any) -> tuple[float, float, float, float]:
    values = np.asarray(factor, np.float64).reshape(-1) / 255.0
    numbers = cast("list[float]", values.tolist())
    red, green, blue, alpha = (*numbers[:3], numbers[3] if len(numbers) > 3 else 1.0)
    return (red, green, blue, alpha)


def _cutout_alpha(source: Any) -> float:
    mode = getattr(source, "alphaMode", None)
    if mode == "MASK":
        cutoff = getattr(source, "alphaCutoff", None)
        return SEE_THROUGH_ALPHA if cutoff is None else float(cutoff)
    return SEE_THROUGH_ALPHA if mode == "BLEND" else 0.0
