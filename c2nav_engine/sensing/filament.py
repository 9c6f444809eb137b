"""Open3D's offscreen renderer (Filament) under the same protocol, for machines with a GPU.

It wants Vulkan. Without a GPU it falls to a software driver and takes about thirty times as long
as ray casting, so `sensing.embree` is the default everywhere; this one is asked for by name.
"""

from __future__ import annotations

import atexit
import subprocess
import sys
from collections.abc import Sequence
from typing import Any

import numpy as np
from jaxtyping import Float, Float32, UInt8

from c2nav_engine.errors import MissingExtra
from c2nav_engine.geometry import Pinhole
from c2nav_engine.sensing.renderer import Image
from c2nav_engine.world.scene import Material, Part, Scene

BACKGROUND = (200 / 255, 210 / 255, 220 / 255, 1.0)
"""Where nothing is hit, as in the default renderer."""

CV_FROM_CAMERA = np.diag([1.0, -1.0, -1.0, 1.0])
"""From x right, y up, looking along −z, to x right, y down, looking along +z."""

_Part = tuple[str, Any, Any]
"""Name, mesh and material as Open3D takes them."""


def filament_unavailable() -> str:
    """Why this machine cannot render with Filament, or "" where it can.

    Tried in a process of its own: without a driver, Open3D may end the process.
    """
    probe = "from open3d.visualization.rendering import OffscreenRenderer as R; R(8, 8)"
    # The interpreter runs a constant, no input.
    tried = subprocess.run(  # noqa: S603
        [sys.executable, "-c", probe], capture_output=True, text=True, timeout=120, check=False
    )
    if tried.returncode == 0:
        return ""
    said = (tried.stderr.strip() or tried.stdout.strip()).splitlines()
    return f"Open3D found no usable Vulkan driver ({said[-1] if said else tried.returncode})"


class FilamentRenderer:
    """Colour and depth by rasterisation; see `sensing.renderer.Renderer`.

    Surfaces are lit by Filament's own sun and sky unless their material is unlit. All renderers
    of a process share one stage and one thread; taking turns between scenes costs an upload.

    Args:
        scene: What to render; its arrays are copied.
    """

    def __init__(self, scene: Scene) -> None:
        self._parts = [_geometry(scene, part) for part in scene.parts]

    @property
    def name(self) -> str:
        """What run records call it."""
        return "filament"

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
        """RGB and depth, camera by camera; raises `MissingExtra` without a Vulkan driver."""
        if not world_from_cameras:
            return []
        stage = _STAGE.showing(self._parts, [rgb, depth])
        return [
            Image(
                rgb=stage.rgb(matrix, rgb),
                depth_m=_in_range(
                    stage.depth_m(matrix, depth)[::depth_stride, ::depth_stride], near_m, far_m
                ),
                world_from_camera=np.asarray(matrix, np.float64),
            )
            for matrix in world_from_cameras
        ]


class _Stage:
    """Open3D's one offscreen renderer of this process.

    Open3D aborts the process when one of two offscreen renderers is destroyed, so there is one,
    as large as any picture asked for: smaller pictures are its top left corner.
    """

    def __init__(self) -> None:
        self._renderer: Any = None
        self._size_px = (0, 0)
        self._shown: list[_Part] | None = None

    def showing(self, parts: list[_Part], pinholes: Sequence[Pinhole]) -> _Stage:
        """The stage with these parts on it and room for these pictures."""
        width_px = max(self._size_px[0], *(pinhole.width_px for pinhole in pinholes))
        height_px = max(self._size_px[1], *(pinhole.height_px for pinhole in pinholes))
        if (width_px, height_px) != self._size_px:
            self.close()
            self._renderer, self._size_px = _offscreen(width_px, height_px), (width_px, height_px)
        if self._shown is not parts:
            self._renderer.scene.clear_geometry()
            for part in parts:
                self._renderer.scene.add_geometry(*part)
            self._shown = parts
        return self

    def rgb(
        self, matrix: Float[np.ndarray, "4 4"], pinhole: Pinhole
    ) -> UInt8[np.ndarray, "rows columns 3"]:
        """Colours as one camera sees them."""
        self._aim(matrix, pinhole)
        picture = np.asarray(self._renderer.render_to_image())
        return np.ascontiguousarray(picture[: pinhole.height_px, : pinhole.width_px, :3])

    def depth_m(
        self, matrix: Float[np.ndarray, "4 4"], pinhole: Pinhole
    ) -> Float32[np.ndarray, "rows columns"]:
        """Depth along the axis; not finite where nothing is hit."""
        self._aim(matrix, pinhole)
        picture = np.asarray(self._renderer.render_to_depth_image(z_in_view_space=True), np.float32)
        return np.ascontiguousarray(picture[: pinhole.height_px, : pinhole.width_px])

    def close(self) -> None:
        """Let go of the renderer, emptied first, and before the interpreter takes Open3D down."""
        if self._renderer is not None:
            self._renderer.scene.clear_geometry()
        self._renderer, self._shown, self._size_px = None, None, (0, 0)

    def _aim(self, matrix: Float[np.ndarray, "4 4"], pinhole: Pinhole) -> None:
        intrinsics = np.asarray(
            [
                [pinhole.focal_px, 0.0, pinhole.width_px / 2.0],
                [0.0, pinhole.focal_px, pinhole.height_px / 2.0],
                [0.0, 0.0, 1.0],
            ]
        )
        camera_from_world = CV_FROM_CAMERA @ np.linalg.inv(matrix)
        self._renderer.setup_camera(intrinsics, camera_from_world, *self._size_px)


_STAGE = _Stage()
atexit.register(_STAGE.close)


def _in_range(
    depth_m: Float32[np.ndarray, "rows columns"], near_m: float, far_m: float
) -> Float32[np.ndarray, "rows columns"]:
    valid = np.isfinite(depth_m) & (depth_m >= near_m) & (depth_m <= far_m)
    return np.where(valid, depth_m, np.float32(0.0))


def _offscreen(width_px: int, height_px: int) -> Any:
    import open3d

    o3d: Any = open3d
    try:
        renderer = o3d.visualization.rendering.OffscreenRenderer(width_px, height_px)
    except Exception as error:
        message = (
            f"the filament renderer needs a Vulkan driver, came {error}; install one, or use the "
            "default renderer"
        )
        raise MissingExtra(message) from error
    renderer.scene.set_background(BACKGROUND)
    # Tone mapping and dithering would change unlit colours, and from frame to frame.
    renderer.scene.view.set_post_processing(False)
    return renderer


def _geometry(scene: Scene, part: Part) -> _Part:
    """A part as Open3D's mesh, with vertices of its own, and material."""
    import open3d

    o3d: Any = open3d
    triangles = scene.triangles[part.first : part.stop]
    used, local = np.unique(triangles, return_inverse=True)
    mesh = o3d.geometry.TriangleMesh(
        o3d.utility.Vector3dVector(scene.vertices_m[used].astype(np.float64)),
        o3d.utility.Vector3iVector(local.reshape(-1, 3).astype(np.int32)),
    )
    mesh.compute_vertex_normals()
    material = scene.materials[part.material]
    if scene.colours is not None:
        colours = scene.colours[used, :3].astype(np.float64) / 255.0
        mesh.vertex_colors = o3d.utility.Vector3dVector(colours)
    if scene.uvs is not None and material.texture is not None:
        uvs = scene.uvs[part.first : part.stop].reshape(-1, 2).astype(np.float64)
        mesh.triangle_uvs = o3d.utility.Vector2dVector(uvs)
    return f"{part.first}", mesh, _record(material)


def _record(material: Material) -> Any:
    import open3d

    o3d: Any = open3d
    record = o3d.visualization.rendering.MaterialRecord()
    record.shader = "defaultUnlit" if material.unlit else "defaultLit"
    record.base_color = material.colour
    record.base_roughness = 1.0
    if material.texture is not None:
        record.albedo_img = o3d.geometry.Image(np.ascontiguousarray(material.texture[..., :3]))
    return record
