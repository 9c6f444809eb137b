"""The default renderer: Embree ray casting by Open3D, shaded by one compiled kernel.

It needs no GPU, display or driver, and the same pose gives the same bytes every time.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from jaxtyping import Bool, Float, Float32, Int64

from c2nav_engine.geometry import Pinhole
from c2nav_engine.sensing.atlas import atlas_of
from c2nav_engine.sensing.caster import Caster, Hits
from c2nav_engine.sensing.rayplan import RayPlan, ray_plan
from c2nav_engine.sensing.renderer import Image
from c2nav_engine.world.scene import Scene

if TYPE_CHECKING:
    from c2nav_engine.sensing.shading import Look

T = TypeVar("T")

CHUNK_RAYS = 16_384
"""Rays whose pixels one thread fills at a time."""

SEE_THROUGH_LAYERS = 8
"""Cut-out surfaces that a ray passes before the next one counts as there."""


@dataclass(frozen=True, slots=True)
class Light:
    """How surfaces are lit [C]: linear shares of a light that casts no shadow.

    Attributes:
        ambient: Reaches every surface.
        headlight: From the camera, by Lambert's law, whatever the distance.
        sky: From above: whole on floors, half on walls, none on undersides.
        background: Colour in sRGB where nothing is hit.
    """

    ambient: float = 0.3
    headlight: float = 0.45
    sky: float = 0.25
    background: tuple[int, int, int] = (200, 210, 220)


def granted_threads() -> int:
    """Threads this process may use: what its parent granted a worker, else every core."""
    granted = os.environ.get("OMP_NUM_THREADS", "")
    return int(granted) if granted.isdecimal() and int(granted) else os.cpu_count() or 1


class EmbreeRenderer:
    """Colour and depth of a scene by ray casting; see `sensing.renderer.Renderer`.

    Colours are bilinear texture × material × vertex colour, lit from both sides without shadows
    and encoded to sRGB. One renderer serves one thread at a time.

    Args:
        scene: What to render; its arrays are kept.
        light: How surfaces are lit.
        threads: Threads to cast and shade with; 0 takes `OMP_NUM_THREADS`, else every core.

    Attributes:
        caster: The bare caster, which sees cut-outs as solid.
    """

    def __init__(self, scene: Scene, *, light: Light | None = None, threads: int = 0) -> None:
        # The kernels import numba, which takes a second: only what renders pays for it.
        from c2nav_engine.sensing import shading

        self._kernels = shading
        self._light = light or Light()
        self._atlas = atlas_of(scene)
        self._has_cutouts = bool(self._atlas.cutout_alphas.any())
        threads = threads or granted_threads()
        self.caster = Caster(scene, threads=threads)
        self._pool = ThreadPoolExecutor(threads, "render")
        self._plans: dict[tuple[Pinhole, Pinhole, int], RayPlan] = {}

    @property
    def name(self) -> str:
        """What run records call it."""
        return "embree"

    def render(
        self,
        world_from_cameras: Sequence[Float[np.ndarray, "4 4"]],
        *,
        rgb: Pinhole,
        depth: Pinhole,
        near_m: float,
        far_m: float,
        depth_stride: int = 1,
    ) -> list[Image]:
        """RGB and depth for several cameras; equal pinholes share their rays."""
        plan = self._plan(rgb, depth, depth_stride)
        look = self._look(rgb)
        range_m = float(near_m), float(far_m)
        grid = -(-depth.height_px // depth_stride), -(-depth.width_px // depth_stride)
        images = [
            Image(
                rgb=np.empty((rgb.height_px, rgb.width_px, 3), np.uint8),
                depth_m=np.empty(grid, np.float32),
                world_from_camera=np.asarray(matrix, np.float64),
            )
            for matrix in world_from_cameras
        ]
        # One after the other costs no more than all at once, and a whole ring no more memory than
        # one view: a process keeps what its largest look took.
        for image in images:
            self._fill(image, plan, look=look, range_m=range_m)
        return images

    def _fill(
        self, image: Image, plan: RayPlan, *, look: Look, range_m: tuple[float, float]
    ) -> None:
        """Cast one view's rays and paint what they hit."""
        hits = self._cast(self._rays(image.world_from_camera, plan))

        def paint(start: int) -> None:
            part = slice(start, start + CHUNK_RAYS)
            canvas = self._kernels.Canvas(
                image.rgb.reshape(-1, 3),
                image.depth_m.reshape(-1),
                plan.rgb_pixels[part],
                plan.depth_pixels[part],
            )
            found = Hits(*(array[part] for array in hits))
            self._kernels.keep_depths(canvas, found.t_hit, range_m)
            self._kernels.paint(canvas, found, self._atlas, look)

        self._each(paint, range(0, len(plan.directions), CHUNK_RAYS))

    def rays(
        self,
        world_from_cameras: Sequence[Float[np.ndarray, "4 4"]],
        *,
        rgb: Pinhole,
        depth: Pinhole,
    ) -> Float32[np.ndarray, "rays 6"]:
        """The rays of `render` with whole depth pictures, in the order in which it casts them."""
        plan = self._plan(rgb, depth)
        return np.concatenate([self._rays(matrix, plan) for matrix in world_from_cameras])

    def _rays(
        self, world_from_camera: Float[np.ndarray, "4 4"], plan: RayPlan
    ) -> Float32[np.ndarray, "rays 6"]:
        rays = np.empty((len(plan.directions), 6), np.float32)
        matrix = np.asarray(world_from_camera, np.float32)
        self._kernels.fill_rays(rays, plan.directions, matrix)
        return rays

    def cast(
        self, origins_m: Float[np.ndarray, "rays 3"], directions: Float[np.ndarray, "rays 3"]
    ) -> Hits:
        """First hits of any rays in the world frame, in lengths of their directions."""
        return self._cast(np.hstack([origins_m, directions]).astype(np.float32))

    def segment_clear(
        self,
        a_m: Float[np.ndarray, "segments 3"],
        b_m: Float[np.ndarray, "segments 3"],
        *,
        margin_m: float = 0.01,
    ) -> Bool[np.ndarray, " segments"]:
        """Whether nothing stands between the points, up to `margin_m` before b.

        The margin lets b lie on a surface: asking whether that point is seen from a.
        """
        directions = np.asarray(b_m, np.float64) - a_m
        lengths_m = np.linalg.norm(directions, axis=1)
        units = directions / np.maximum(lengths_m, 1e-12)[:, None]
        return self.cast(a_m, units).t_hit >= lengths_m - margin_m

    def _plan(self, rgb: Pinhole, depth: Pinhole, depth_stride: int = 1) -> RayPlan:
        asked = rgb, depth, depth_stride
        if asked not in self._plans:
            self._plans[asked] = ray_plan(*asked)
        return self._plans[asked]

    def _look(self, rgb: Pinhole) -> Look:
        light = self._light
        return self._kernels.Look(
            light.ambient,
            light.headlight,
            light.sky,
            *light.background,
            pixel_m2=rgb.focal_px**-2,
        )

    def _cast(self, rays: Float32[np.ndarray, "rays 6"]) -> Hits:
        """First hits; rays go on behind surfaces that alpha says are not there."""
        hits = self.caster.cast(rays)
        if not self._has_cutouts:
            return hits
        through = np.empty(len(rays), np.bool_)
        for _ in range(SEE_THROUGH_LAYERS):
            if not self._kernels.find_cutouts(through, hits, self._atlas):
                break
            self._go_on(hits, np.flatnonzero(through))
        return hits

    def _go_on(self, hits: Hits, indices: Int64[np.ndarray, " passing"]) -> None:
        """Replace hits by the next ones along the same rays."""
        rays = hits.rays[indices]
        # Just behind the surface, in lengths of the ray: far enough for 32-bit coordinates.
        passed = hits.t_hit[indices] * np.float32(1.0 + 1e-5) + np.float32(1e-4)
        rays[:, :3] += rays[:, 3:] * passed[:, None]
        beyond = self.caster.cast(rays)
        hits.t_hit[indices] = beyond.t_hit + passed
        hits.triangles[indices] = beyond.triangles
        hits.barycentrics[indices] = beyond.barycentrics
        hits.normals[indices] = beyond.normals

    def _each(self, work: Callable[[T], None], items: Iterable[T]) -> None:
        """Run independent pieces of work on the renderer's threads; errors come through."""
        for _ in self._pool.map(work, items):
            pass
