"""Meshes of one flat colour: a sign looks the same wherever the light comes from.

viser's own meshes are lit pixel by pixel. A browser without a GPU takes longer to compile that
light than to draw all the rest of the map.
"""

from __future__ import annotations

import numpy as np
import viser
from jaxtyping import Float32, UInt32

from app.inspector.scene.colours import Rgb
from app.inspector.scene.glb import LINEAR, Surface, pack
from c2nav_engine.geometry import Point
from c2nav_engine.world.scene import Material

_BELOW_M = 200.0
"""How far below a translucent sheet a vertex lies that no triangle uses. Browsers paint what shines
through by the distance of its bounds' middle, the farthest first. The cut face of the walls lies
above the sheets; where it comes first, its clear parts keep what is below from being painted."""


def add_flat(
    scene: viser.SceneApi,
    name: str,
    mesh: tuple[Float32[np.ndarray, "n 3"], UInt32[np.ndarray, "m 3"]],
    colour: Rgb,
    *,
    opacity: float = 1.0,
    position_m: Point = (0.0, 0.0, 0.0),
) -> viser.SceneNodeHandle:
    """Add vertices and triangles, seen from both sides.

    Args:
        scene: Where to draw.
        name: Of the node.
        mesh: Vertices in metres and triangles.
        colour: sRGB.
        opacity: Below 1, what lies behind shines through.
        position_m: Where the mesh's origin stands.
    """
    vertices_m, triangles = mesh
    if opacity < 1.0:
        x, y, z = (vertices_m.min(axis=0) + vertices_m.max(axis=0)) / 2.0
        vertices_m = np.concatenate([vertices_m, np.array([[x, y - _BELOW_M, z]], np.float32)])
    red, green, blue = (float(LINEAR[channel]) for channel in colour)
    material = Material(name, (red, green, blue, 1.0))
    surface = Surface(vertices_m, triangles, material, opacity=opacity)
    return scene.add_glb(
        name, pack([surface]), position=position_m, cast_shadow=False, receive_shadow=False
    )
