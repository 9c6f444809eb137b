"""Words for the parts of any scene: what a mesh's own names say stands where."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass

import numpy as np

from c2nav_engine.geometry import Point
from c2nav_engine.world.scene import Scene

_STRUCTURE = frozenset(
    (
        *("wall", "walls", "floor", "floors", "ceiling", "ceilings", "roof", "ground", "house"),
        *("room", "building", "window", "windows", "banister", "handle", "light", "lights"),
        *("mesh", "node", "object", "geometry", "geom", "group", "root", "scene", "default"),
        *("material", "primitive", "model", "world", "visual", "lib", "shape", "polygon", "part"),
        *("section", "chunk", "curtain", "board", "portrait", "camera", "utensils", "tableware"),
        *("airconditioner", "seasoning", "chandelier", "rangehood"),
    )
)
"""Names with one of these are no landmark: structure, small things, or nothing at all."""
_HIGHEST_M = 1.2
"""A landmark begins below this height above the floor beside it."""


@dataclass(frozen=True, slots=True)
class NamedThing:
    """Something of a scene that has a name.

    Attributes:
        words: How an instruction calls it, without article.
        low_m: Lowest corner of its box.
        high_m: Highest corner.
    """

    words: str
    low_m: Point
    high_m: Point

    @property
    def centre_m(self) -> Point:
        """Middle of its box."""
        x, y, z = ((a + b) / 2 for a, b in zip(self.low_m, self.high_m, strict=True))
        return (x, y, z)

    def gap_m(self, point_m: Point) -> float:
        """Horizontal distance from a foot point to its box; inf on another storey."""
        if not self.low_m[1] - _HIGHEST_M < point_m[1] < self.high_m[1] + 0.1:
            return float("inf")
        dx = max(self.low_m[0] - point_m[0], 0.0, point_m[0] - self.high_m[0])
        dz = max(self.low_m[2] - point_m[2], 0.0, point_m[2] - self.high_m[2])
        return (dx * dx + dz * dz) ** 0.5


def named_things(scene: Scene) -> list[NamedThing]:
    """Things whose name is a landmark and means one thing only, in the scene's order."""
    boxes: dict[str, tuple[np.ndarray, np.ndarray]] = {}
    for part in scene.parts:
        points = scene.vertices_m[scene.triangles[part.first : part.stop].reshape(-1)]
        name = part.name.rsplit("/", 1)[0] if _is_plain(part.name) else part.name
        low, high = boxes.get(name, (points.min(axis=0), points.max(axis=0)))
        boxes[name] = np.minimum(low, points.min(axis=0)), np.maximum(high, points.max(axis=0))
    words = {name: words_of_part(name) for name in boxes}
    count = Counter(words.values())
    return [
        NamedThing(words[name], _point(low), _point(high))
        for name, (low, high) in boxes.items()
        if words[name] and count[words[name]] == 1
    ]


def words_of_part(name: str) -> str:
    """Plain words: "refrigerator" of `Refrigerator_01_001/…`, itself of "study/teal globe".

    Empty for structure ("wall/study") and for names that mean nothing ("mesh0").
    """
    first, _, rest = name.partition("/")
    text = rest if _is_room(name) else first
    text = re.sub(r"[_.\-\d]+", " ", text)
    text = re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", text)
    words = [word for word in text.lower().split() if len(word) > 1]
    if first in _STRUCTURE or not _STRUCTURE.isdisjoint(words) or len(words) > 6:
        return ""
    return " ".join(words)


def _is_room(name: str) -> bool:
    """Whether a name reads "room/thing", as in the built-in houses."""
    first, _, rest = name.partition("/")
    return bool(rest) and first == first.lower() and not re.search(r"[_\d]", name)


def _is_plain(name: str) -> bool:
    return "/" in name and not _is_room(name)


def _point(corner: np.ndarray) -> Point:
    x, y, z = (float(value) for value in corner)
    return (x, y, z)
