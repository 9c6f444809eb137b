"""The default renderer: Embree ray casting by Open3D, shaded by one compiled kernel.

It needs no GPU, display or driver, and the same pose gives the same bytes every time.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Float32, Int64, UInt8

from c2nav_engine.geometry import Pinhole
from c2nav_engine.sensing.atlas import atlas_of
from c2nav_engine.sensing.caster import Caster, Hits
from c2nav_engine.sensing.renderer import Image
from c2nav_engine.world.scene import Scene

CHUNK_RAYS = 16_384
"""Rays that one thread shades at a time."""


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


class EmbreeRenderer:
    """Colour and depth of a scene by ray casting; see `sensing.renderer.Renderer`.

    Colours are bilinear texture × material × vertex colour, lit from both sides without shadows
    and encoded to sRGB. One renderer serves one thread at a time.

    Args:
        scene: What to render; its arrays are kept.
        light: How surfaces are lit.
        threads: Threads to cast and shade with; 0 uses every core.
    """

    def __init__(self, scene: Scene, *, light: Light | None = None, threads: int = 0) -> None:
        # The kernels import numba, which takes a second: only what renders pays for it.
        from c2nav_engine.sensing import shading

        light = light or Light()
        self._kernels = shading
        self._lighting = shading.Lighting(
            light.ambient, light.headlight, light.sky, *light.background
        )
        self._atlas = atlas_of(scene)
        self._has_cutouts = bool(self._atlas.cutout_alphas.any())
        self._caster = Caster(scene, threads=threads)
        self._pool = ThreadPoolExecutor(threads or os.cpu_count() or 1, "render")
        self._directions: dict[Pinhole, Float32[np.ndarray, "rays 3"]] = {}

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
    ) -> list[Image]:
        """RGB and depth for several cameras in one cast; equal pinholes share their rays."""
        count = len(world_from_cameras)
        if not count:
            return []
        pinholes = [rgb] if rgb == depth else [rgb, depth]
        hits = self._cast(self.rays(world_from_cameras, pinholes))
        pictures = self._shaded(hits, rgb, count)
        t_hit = hits.t_hit[-count * depth.width_px * depth.height_px :]
        depths_m = np.where((t_hit >= near_m) & (t_hit <= far_m), t_hit, np.float32(0.0))
        return [
            Image(rgb=picture, depth_m=depth_m, world_from_camera=np.asarray(matrix, np.float64))
            for picture, depth_m, matrix in zip(
                pictures,
                depths_m.reshape(count, depth.height_px, depth.width_px),
                world_from_cameras,
                strict=True,
            )
        ]

    def rays(
        self, world_from_cameras: Sequence[Float[np.ndarray, "4 4"]], pinholes: Sequence[Pinhole]
    ) -> Float32[np.ndarray, "rays 6"]:
        """Rays through all pixel centres: by pinhole, then by camera, then row by row."""
        cameras = [(matrix, pinhole) for pinhole in pinholes for matrix in world_from_cameras]
        counts = [pinhole.width_px * pinhole.height_px for _, pinhole in cameras]
        stops = np.cumsum(counts).tolist()
        rays = np.empty((stops[-1], 6), np.float32)

        def fill(index: int) -> None:
            matrix, pinhole = cameras[index]
            block = rays[stops[index] - counts[index] : stops[index]]
            self._kernels.fill_rays(
                block, self._camera_rays(pinhole), np.asarray(matrix, np.float32)
            )

        self._each(fill, range(len(cameras)))
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

    def _camera_rays(self, pinhole: Pinhole) -> Float32[np.ndarray, "rays 3"]:
        if pinhole not in self._directions:
            directions = pinhole.ray_directions().reshape(-1, 3)
            self._directions[pinhole] = np.ascontiguousarray(directions, np.float32)
        return self._directions[pinhole]

    def _cast(self, rays: Float32[np.ndarray, "rays 6"]) -> Hits:
        """First hits; rays go on behind surfaces that alpha says are not there."""
        hits = self._caster.cast(rays)
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
        beyond = self._caster.cast(rays)
        hits.t_hit[indices] = beyond.t_hit + passed
        hits.triangles[indices] = beyond.triangles
        hits.barycentrics[indices] = beyond.barycentrics
        hits.normals[indices] = beyond.normals

    def _shaded(
        self, hits: Hits, pinhole: Pinhole, views: int
    ) -> UInt8[np.ndarray, "views rows columns 3"]:
        """Pictures of the first hits, which are those of `views` cameras of one pinhole."""
        rgb = np.empty((views, pinhole.height_px, pinhole.width_px, 3), np.uint8)
        pixels = rgb.reshape(-1, 3)
        look = (self._lighting, pinhole.focal_px**-2)

        def shade_chunk(start: int) -> None:
            chunk = slice(start, min(start + CHUNK_RAYS, len(pixels)))
            part = Hits(*(array[chunk] for array in hits))
            self._kernels.shade(pixels[chunk], part, self._atlas, look)

        self._each(shade_chunk, range(0, len(pixels), CHUNK_RAYS))
        return rgb

    def _each(self, work: Callable[[int], None], items: Sequence[int]) -> None:
        """Run independent pieces of work on the renderer's threads; errors come through."""
        for _ in self._pool.map(work, items):
            pass
