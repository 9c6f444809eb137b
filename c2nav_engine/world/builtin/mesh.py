"""Solids that furniture and walls are made of, with outward faces and their own vertices.

Local frame: metres, Y up. A solid's texture coordinates follow its longest faces unless given.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from c2nav_engine.world.scene import Material

Vector = tuple[float, float, float]


@dataclass(frozen=True, slots=True, eq=False)
class Look:
    """What a solid is made of; compared by identity.

    Attributes:
        material: Shared by all solids of this look.
        tile_m: Length that one copy of the texture covers.
        glow: How much light it gives off when the house is lit; 0 for nearly everything.
        thin: Too thin to take or cast soft shade (frames, skirting).
    """

    material: Material
    tile_m: float = 1.0
    glow: float = 0.0
    thin: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class Solid:
    """A mesh of one look.

    Attributes:
        look: What it is made of.
        vertices_m: Positions.
        triangles: Vertex indices, counter-clockwise from outside.
        uvs: Texture coordinates per corner; None to project along the dominant axis.
    """

    look: Look
    vertices_m: Float[np.ndarray, "vertices 3"]
    triangles: Int[np.ndarray, "triangles 3"]
    uvs: Float[np.ndarray, "triangles 3 2"] | None = None

    def at(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Solid:
        """The solid moved."""
        return replace(self, vertices_m=self.vertices_m + np.array((x, y, z)))

    def turned(self, yaw_rad: float) -> Solid:
        """The solid turned left about the vertical axis."""
        return replace(self, vertices_m=self.vertices_m @ turn_about_y(yaw_rad).T)

    def tilted(self, pitch_rad: float) -> Solid:
        """The solid turned about its x axis: positive lifts what lies towards +z down."""
        sin, cos = math.sin(pitch_rad), math.cos(pitch_rad)
        rotation = np.array(((1.0, 0.0, 0.0), (0.0, cos, -sin), (0.0, sin, cos)))
        return replace(self, vertices_m=self.vertices_m @ rotation.T)

    def leaned(self, roll_rad: float) -> Solid:
        """The solid turned about its z axis: positive lifts +x."""
        sin, cos = math.sin(roll_rad), math.cos(roll_rad)
        rotation = np.array(((cos, -sin, 0.0), (sin, cos, 0.0), (0.0, 0.0, 1.0)))
        return replace(self, vertices_m=self.vertices_m @ rotation.T)


def turn_about_y(yaw_rad: float) -> Float[np.ndarray, "3 3"]:
    """Rotation to the left about +Y."""
    sin, cos = math.sin(yaw_rad), math.cos(yaw_rad)
    return np.array(((cos, 0.0, sin), (0.0, 1.0, 0.0), (-sin, 0.0, cos)))


def sheet(
    look: Look,
    corner: Vector,
    sides: tuple[Vector, Vector],
    *,
    parts: tuple[int, int] = (1, 1),
    levels: Sequence[float] = (),
    whole: bool = False,
) -> Solid:
    """A parallelogram, facing along first side × second side.

    Args:
        look: Its look.
        corner: Where both sides start.
        sides: First (the picture's right) and second (the picture's up) side.
        parts: How often each side is cut, for lighting.
        levels: Shares of the second side where it is cut instead, 0 and 1 included.
        whole: Whether one copy of the texture covers all of it.
    """
    across, up = (np.array(side) for side in sides)
    columns, rows = parts[0], len(levels) - 1 if levels else parts[1]
    cuts = np.array(levels) if levels else np.linspace(0, 1, rows + 1)
    s, t = np.meshgrid(np.linspace(0, 1, columns + 1), cuts)
    vertices = np.array(corner) + s.reshape(-1, 1) * across + t.reshape(-1, 1) * up
    triangles = _grid_triangles(columns, rows)
    uvs = np.stack([s.reshape(-1), t.reshape(-1)], axis=1)[triangles] if whole else None
    return Solid(look, vertices, triangles, uvs)


def _grid_triangles(columns: int, rows: int) -> Int[np.ndarray, "triangles 3"]:
    first = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)[None, :]).reshape(-1)
    right, above = first + 1, first + columns + 1
    lower = np.stack([first, right, above + 1], axis=1)
    upper = np.stack([first, above + 1, above], axis=1)
    return np.stack([lower, upper], axis=1).reshape(-1, 3)


_BOX_CORNERS = np.array(
    [
        [(-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)],
        [(1, -1, -1), (-1, -1, -1), (-1, 1, -1), (1, 1, -1)],
        [(1, -1, 1), (1, -1, -1), (1, 1, -1), (1, 1, 1)],
        [(-1, -1, -1), (-1, -1, 1), (-1, 1, 1), (-1, 1, -1)],
        [(-1, 1, 1), (1, 1, 1), (1, 1, -1), (-1, 1, -1)],
        [(-1, -1, -1), (1, -1, -1), (1, -1, 1), (-1, -1, 1)],
    ],
    float,
).reshape(-1, 3)
_BOX_TRIANGLES = (
    np.array([(0, 1, 2), (0, 2, 3)])[None, :, :] + 4 * np.arange(6)[:, None, None]
).reshape(-1, 3)


def box(look: Look, size: Vector, base: Vector = (0.0, 0.0, 0.0)) -> Solid:
    """A box of (width, height, depth) that stands centred on `base`."""
    half = np.array(size) / 2.0
    centre = np.array((base[0], base[1] + half[1], base[2]))
    return Solid(look, _BOX_CORNERS * half + centre, _BOX_TRIANGLES)


def cushion(
    look: Look, size: Vector, base: Vector = (0.0, 0.0, 0.0), *, radius: float = 0.05
) -> Solid:
    """A box with rounded edges that stands centred on `base`."""
    half = np.array(size) / 2.0
    round_m = min(radius, float(half.min()) * 0.98)
    axis_u = (0, 0, 2, 2, 0, 0)
    vertices: list[np.ndarray] = []
    for face, first in enumerate(axis_u):
        corners = _BOX_CORNERS[4 * face : 4 * face + 4] * half
        second = next(axis for axis in range(3) if axis != first and np.ptp(corners[:, axis]))
        s = _chamfered(float(half[first]), round_m)
        t = _chamfered(float(half[second]), round_m)
        # Signs keep the face's own winding.
        s = s * np.sign(corners[1, first] - corners[0, first])
        t = t * np.sign(corners[3, second] - corners[0, second])
        grid = np.tile(corners[0], (16, 1))
        grid[:, first], grid[:, second] = np.tile(s, 4), np.repeat(t, 4)
        vertices.append(grid)
    points = np.concatenate(vertices)
    inner = np.clip(points, -(half - round_m), half - round_m)
    out = points - inner
    points = inner + round_m * out / np.linalg.norm(out, axis=1, keepdims=True)
    triangles = (_grid_triangles(3, 3)[None] + 16 * np.arange(6)[:, None, None]).reshape(-1, 3)
    return Solid(look, points + np.array(base) + (0.0, half[1], 0.0), triangles)


def _chamfered(half: float, radius: float) -> Float[np.ndarray, " 4"]:
    return np.array((-half, -half + radius, half - radius, half))


def lathe(look: Look, profile: Sequence[tuple[float, float]], *, sides: int = 16) -> Solid:
    """A profile of (radius, height), bottom to top, turned about the vertical axis."""
    radius, height = (np.array(column) for column in zip(*profile, strict=True))
    angle = np.linspace(0.0, math.tau, sides + 1)
    vertices = np.stack(
        [
            (radius[:, None] * np.sin(angle)[None, :]).reshape(-1),
            np.repeat(height, sides + 1),
            (radius[:, None] * np.cos(angle)[None, :]).reshape(-1),
        ],
        axis=1,
    )
    triangles = _grid_triangles(sides, len(profile) - 1)
    corners = vertices[triangles]
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    kept = area > 1e-9
    around = math.tau * float(radius.max())
    u, v = np.tile(angle / math.tau * around, len(profile)), np.repeat(height, sides + 1)
    uvs = np.stack([u, v], axis=1)[triangles] / look.tile_m
    return Solid(look, vertices, triangles[kept], uvs[kept])


def cylinder(
    look: Look, radius: float, height: float, base: Vector = (0.0, 0.0, 0.0), *, sides: int = 14
) -> Solid:
    """A closed upright cylinder that stands on `base`."""
    profile = ((0.0, 0.0), (radius, 0.0), (radius, height), (0.0, height))
    return lathe(look, profile, sides=sides).at(*base)


def disc_facing_front(look: Look, radius: float, centre: Vector, *, sides: int = 20) -> Solid:
    """A flat disc that faces +z with one copy of the texture on it."""
    angle = np.linspace(0.0, math.tau, sides, endpoint=False)
    rim = np.stack([np.cos(angle), np.sin(angle), np.zeros(sides)], axis=1)
    unit = np.concatenate([np.zeros((1, 3)), rim])
    around = np.arange(sides)
    triangles = np.stack([np.zeros(sides, int), 1 + around, 1 + (around + 1) % sides], axis=1)
    uvs = (unit[:, :2] * 0.5 + 0.5)[triangles]
    return Solid(look, unit * radius + np.array(centre), triangles, uvs)


def projected_uvs(
    vertices_m: Float[np.ndarray, "vertices 3"],
    triangles: Int[np.ndarray, "triangles 3"],
    tile_m: float,
) -> Float[np.ndarray, "triangles 3 2"]:
    """Texture coordinates along the axis that each triangle faces most; one tile per `tile_m`."""
    corners = vertices_m[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    facing = np.abs(normals).argmax(axis=1)
    # Walls take (horizontal, vertical), floors (x, −z).
    axes = np.array(((2, 1), (0, 2), (0, 1)))[facing]
    uvs = np.take_along_axis(corners, axes[:, None, :], axis=2) / tile_m
    uvs[facing == 1, :, 1] *= -1.0
    return uvs
