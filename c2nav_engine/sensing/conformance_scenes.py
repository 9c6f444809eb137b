"""Scenes whose pictures are known in closed form, for checking renderers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from c2nav_engine.world.scene import Material, Piece, Scene, scene_of

Colour = tuple[float, float, float]
Corner = tuple[float, float, float]

FLOOR: Colour = (0.0, 1.0, 0.0)
CEILING: Colour = (0.0, 0.0, 1.0)
LEFT: Colour = (1.0, 0.0, 0.0)
RIGHT: Colour = (1.0, 1.0, 0.0)
AHEAD: Colour = (1.0, 1.0, 1.0)
BEHIND: Colour = (1.0, 0.0, 1.0)


@dataclass(frozen=True, slots=True)
class Room:
    """A box seen from its middle: walls of one colour each.

    Attributes:
        half_width_m: Distance to the left and right walls.
        ahead_m: Distance to the walls in front and behind.
        height_m: Ceiling above the floor at y = 0.
    """

    half_width_m: float = 2.0
    ahead_m: float = 3.0
    height_m: float = 2.5

    def scene(self) -> Scene:
        """The room as a scene: the viewer at the origin looks along −Z at the white wall."""
        o, w, d, h = 0.0, self.half_width_m, self.ahead_m, self.height_m
        sides: dict[str, tuple[Colour, list[Corner]]] = {
            "floor": (FLOOR, [(-w, o, d), (w, o, d), (w, o, -d), (-w, o, -d)]),
            "ceiling": (CEILING, [(-w, h, -d), (w, h, -d), (w, h, d), (-w, h, d)]),
            "left": (LEFT, [(-w, o, d), (-w, o, -d), (-w, h, -d), (-w, h, d)]),
            "right": (RIGHT, [(w, o, -d), (w, o, d), (w, h, d), (w, h, -d)]),
            "ahead": (AHEAD, [(-w, o, -d), (w, o, -d), (w, h, -d), (-w, h, -d)]),
            "behind": (BEHIND, [(w, o, d), (-w, o, d), (-w, h, d), (w, h, d)]),
        }
        return scene_of(
            "room",
            [
                quad(name, corners, Material(name, (*colour, 1.0), unlit=True))
                for name, (colour, corners) in sides.items()
            ],
        )


CORNER_COLOURS: tuple[Colour, Colour, Colour, Colour] = (LEFT, FLOOR, CEILING, RIGHT)
"""Of the textured quad: bottom left, bottom right, top right, top left."""


def textured_wall(distance_m: float = 1.0) -> Scene:
    """A square wall of 2 m ahead whose texture has one colour in each quarter."""
    bottom_left, bottom_right, top_right, top_left = CORNER_COLOURS
    rows = [[top_left] * 8 + [top_right] * 8] * 8 + [[bottom_left] * 8 + [bottom_right] * 8] * 8
    texture = np.full((16, 16, 4), 255, np.uint8)
    texture[..., :3] = np.asarray(rows) * 255.0
    d = -distance_m
    corners = [(-1.0, 0.0, d), (1.0, 0.0, d), (1.0, 2.0, d), (-1.0, 2.0, d)]
    material = Material("quarters", texture=texture, unlit=True)
    return scene_of("wall", [quad("wall", corners, material)])


def quad(name: str, corners_m: Sequence[Corner], material: Material) -> Piece:
    """A rectangle from its corners (bottom left, bottom right, top right, top left)."""
    corner_uvs = np.asarray([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32)
    triangles = np.asarray([[0, 1, 2], [0, 2, 3]], np.int32)
    return Piece(
        name=name,
        material=material,
        vertices_m=np.asarray(corners_m, np.float32),
        triangles=triangles,
        uvs=corner_uvs[triangles] if material.texture is not None else None,
    )
