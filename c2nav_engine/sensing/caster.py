"""The one wrapper of Open3D's ray casting scene: numpy in, numpy out."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float32, UInt32

from c2nav_engine.world.open3d_lean import open3d
from c2nav_engine.world.scene import Scene

NO_TRIANGLE = 0xFFFFFFFF
"""What `Hits.triangles` holds where a ray hits nothing."""


class Hits(NamedTuple):
    """First hits of rays, as the caster returns them.

    Attributes:
        rays: Origin and direction of each ray.
        t_hit: Distance in lengths of the direction; inf where nothing is hit.
        triangles: Index of the triangle hit; `NO_TRIANGLE` where nothing is hit.
        barycentrics: Weights of the triangle's second and third corner.
        normals: Normal of the triangle, on either side.
    """

    rays: Float32[np.ndarray, "rays 6"]
    t_hit: Float32[np.ndarray, " rays"]
    triangles: UInt32[np.ndarray, " rays"]
    barycentrics: Float32[np.ndarray, "rays 2"]
    normals: Float32[np.ndarray, "rays 3"]


class Caster:
    """An acceleration structure over a scene's triangles.

    Args:
        scene: Its triangles are copied into the structure.
        threads: Threads to build and cast with; 0 uses every core.
    """

    def __init__(self, scene: Scene, *, threads: int = 0) -> None:
        o3d = open3d()
        self._tensor: Any = o3d.core.Tensor.from_numpy
        self._scene: Any = o3d.t.geometry.RaycastingScene(nthreads=threads)
        self._scene.add_triangles(
            self._tensor(np.ascontiguousarray(scene.vertices_m)),
            self._tensor(np.ascontiguousarray(scene.triangles).view(np.uint32)),
        )
        self._threads = threads

    def cast(self, rays: Float32[np.ndarray, "rays 6"]) -> Hits:
        """First hits of rays given as origin and direction in the world frame."""
        found = self._scene.cast_rays(self._tensor(rays), nthreads=self._threads)
        return Hits(
            rays=rays,
            t_hit=found["t_hit"].numpy(),
            triangles=found["primitive_ids"].numpy(),
            barycentrics=found["primitive_uvs"].numpy(),
            normals=found["primitive_normals"].numpy(),
        )
