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

BATCH_RAYS = 350_000
"""Rays cast at once: a fan, half a ring. Their hits take 21 MB; more at once is no faster, and
the process keeps as much memory as its largest look took."""

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
        """RGB and depth for several cameras, some at a time; equal pinholes share their rays."""
        plan = self._plan(rgb, depth, depth_stride)
        look = self._look(rgb)
        pixels = rgb.height_px, rgb.width_px, 3
        grid = -(-depth.height_px // depth_stride), -(-depth.width_px // depth_stride)
        range_m = float(near_m), float(far_m)
        at_once = max(1, BATCH_RAYS // len(plan.directions))
        images: list[Image] = []
        for first in range(0, len(world_from_cameras), at_once):
            batch = world_from_cameras[first : first + at_once]
            hits = self._cast(self._rays(batch, plan))
            # Made after the hits: memory that lies above theirs keeps the allocator from handing
            # it back to the system after every look, which costs a quarter of a fan.
            images += [
                Image(
                    rgb=np.empty(pixels, np.uint8),
                    depth_m=np.empty(grid, np.float32),
                    world_from_camera=np.asarray(matrix, np.float64),
                )
                for matrix in batch
            ]
            self._fill(images[first:], hits, plan, look=look, range_m=range_m)
        return images

    def _fill(
        self,
        images: Sequence[Image],
        hits: Hits,
        plan: RayPlan,
        *,
        look: Look,
        range_m: tuple[float, float],
    ) -> None:
        """Paint what the rays of some views hit."""

        def paint(chunk: tuple[int, int]) -> None:
            view, start = chunk
            stop = min(start + CHUNK_RAYS, len(plan.directions))
            shift = view * len(plan.directions)
            canvas = self._kernels.Canvas(
                images[view].rgb.reshape(-1, 3),
                images[view].depth_m.reshape(-1),
                plan.rgb_pixels[start:stop],
                plan.depth_pixels[start:stop],
            )
            part = Hits(*(array[shift + start : shift + stop] for array in hits))
            self._kernels.keep_depths(canvas, part.t_hit, range_m)
            self._kernels.paint(canvas, part, self._atlas, look)

        starts = range(0, len(plan.directions), CHUNK_RAYS)
        self._each(paint, [(view, start) for view in range(len(images)) for start in starts])

    def rays(
        self,
        world_from_cameras: Sequence[Float[np.ndarray, "4 4"]],
        *,
        rgb: Pinhole,
        depth: Pinhole,
    ) -> Float32[np.ndarray, "rays 6"]:
        """The rays of `render` with whole depth pictures, in the order in which it casts them."""
        return self._rays(world_from_cameras, self._plan(rgb, depth))

    def _rays(
        self, world_from_cameras: Sequence[Float[np.ndarray, "4 4"]], plan: RayPlan
    ) -> Float32[np.ndarray, "rays 6"]:
        directions = plan.directions
        count = len(directions)
        rays = np.empty((count * len(world_from_cameras), 6), np.float32)

        def fill(view: int) -> None:
            matrix = np.asarray(world_from_cameras[view], np.float32)
            self._kernels.fill_rays(rays[view * count : (view + 1) * count], directions, matrix)

        self._each(fill, range(len(world_from_cameras)))
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
