"""The renderer contract: every renderer passes the same kit, and the kit notices what is wrong."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from c2nav_engine.errors import InternalError
from c2nav_engine.geometry import Pinhole
from c2nav_engine.sensing import conformance
from c2nav_engine.sensing.conformance import CHECKS, EXACT, check_renderer
from c2nav_engine.sensing.embree import EmbreeRenderer
from c2nav_engine.sensing.renderer import Image, Renderer
from c2nav_engine.world.scene import Scene


@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.__name__)
def test_embree_conforms(check):
    check(EmbreeRenderer, EXACT)


def test_embree_conforms_on_one_thread():
    check_renderer(lambda scene: EmbreeRenderer(scene, threads=1))


class Spoiled:
    """A renderer with one fault, to see that the kit can fail."""

    def __init__(self, scene: Scene, spoil) -> None:
        self._inner: Renderer = EmbreeRenderer(scene)
        self._spoil = spoil
        self._calls = 0

    @property
    def name(self) -> str:
        return "spoiled"

    def render(
        self,
        world_from_cameras: Sequence[np.ndarray],
        *,
        rgb: Pinhole,
        depth: Pinhole,
        near_m: float,
        far_m: float,
        depth_stride: int = 1,
    ) -> list[Image]:
        self._calls += 1
        images = self._inner.render(
            world_from_cameras,
            rgb=rgb,
            depth=depth,
            near_m=near_m,
            far_m=far_m,
            depth_stride=depth_stride,
        )
        return [self._spoil(image, self._calls) for image in images]


def mirrored(image, _):
    return Image(image.rgb[:, ::-1].copy(), image.depth_m, image.world_from_camera)


def upside_down(image, _):
    return Image(image.rgb[::-1].copy(), image.depth_m, image.world_from_camera)


def one_row_lower_at_a_stride(image, _):
    whole = image.depth_m.shape == (conformance.DEPTH.height_px, conformance.DEPTH.width_px)
    depth_m = image.depth_m if whole else np.roll(image.depth_m, 1, axis=0)
    return Image(image.rgb, depth_m, image.world_from_camera)


def euclidean_depth(image, _):
    length = np.linalg.norm(conformance.DEPTH.ray_directions(), axis=-1)
    depth_m = (image.depth_m * length).astype(np.float32)
    return Image(image.rgb, depth_m, image.world_from_camera)


def far_instead_of_holes(image, _):
    depth_m = np.where(image.depth_m == 0.0, np.float32(10.0), image.depth_m)
    return Image(image.rgb, depth_m, image.world_from_camera)


def never_twice_the_same(image, calls):
    rgb = image.rgb.copy()
    rgb[0, 0, 0] ^= np.uint8(calls % 2)
    return Image(rgb, image.depth_m, image.world_from_camera)


@pytest.mark.parametrize(
    "spoil",
    [
        mirrored,
        upside_down,
        euclidean_depth,
        far_instead_of_holes,
        never_twice_the_same,
        one_row_lower_at_a_stride,
    ],
)
def test_the_kit_notices(spoil):
    with pytest.raises(InternalError, match="renderer conformance: expected"):
        check_renderer(lambda scene: Spoiled(scene, spoil))
