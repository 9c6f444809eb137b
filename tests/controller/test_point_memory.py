"""What a bounded cloud keeps."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from c2nav_engine.controller.point_memory import PointMemory

METRES = st.floats(-0.3, 0.3)
CLOUD = st.integers(0, 12).flatmap(lambda n: arrays(np.float64, (n, 3), elements=METRES))


def memory() -> PointMemory:
    return PointMemory(voxel_m=0.1, forget_after_m=3.0)


@given(CLOUD, st.lists(CLOUD, min_size=1, max_size=4))
def test_views_of_one_look_can_be_remembered_at_once_the_last_one_first(
    before_m: np.ndarray, views_m: list[np.ndarray]
):
    one_by_one, at_once = memory(), memory()
    for kept in (one_by_one, at_once):
        kept.add(before_m, travelled_m=0.0)
    for view_m in views_m:
        one_by_one.add(view_m, travelled_m=1.0)
    at_once.add(np.concatenate(views_m[::-1]), travelled_m=1.0)
    assert np.array_equal(at_once.points_m, one_by_one.points_m)


@given(CLOUD)
def test_a_voxel_keeps_one_point_and_it_is_one_that_was_seen(points_m: np.ndarray):
    kept = memory()
    kept.add(points_m, travelled_m=0.0)
    seen = {tuple(point) for point in points_m.tolist()}
    assert {tuple(point) for point in kept.points_m.tolist()} <= seen
    cells = {tuple(cell) for cell in np.floor(points_m / 0.1).astype(int).tolist()}
    assert len(kept.points_m) == len(cells)
