"""Depth points of recent travel, thinned to one a voxel."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

_BITS = 21  # voxels along an axis: ±52 km at 5 cm
_HALF = 1 << (_BITS - 1)


class PointMemory:
    """A bounded cloud in the odometry frame: the newest point of each voxel, for a while.

    Attributes:
        points_m: (n, 3) what is remembered, ordered by voxel.
    """

    def __init__(self, *, voxel_m: float, forget_after_m: float) -> None:
        self._voxel_m = voxel_m
        self._forget_after_m = forget_after_m
        self._keys = np.empty(0, np.int64)
        self._seen_at_m = np.empty(0)
        self.points_m: Float[np.ndarray, "n 3"] = np.empty((0, 3))

    def add(self, points_m: Float[np.ndarray, "n 3"], *, travelled_m: float) -> None:
        """Remember points seen after so much travel, and forget those of long ago.

        Of those that share a voxel, the first is kept.
        """
        recent = self._seen_at_m >= travelled_m - self._forget_after_m
        if not recent.all():
            self._keys, self._seen_at_m = self._keys[recent], self._seen_at_m[recent]
            self.points_m = self.points_m[recent]
        keys, first = np.unique(self._voxels(points_m), return_index=True)
        fresh_m = np.asarray(points_m, np.float64)[first]
        at = np.searchsorted(self._keys, keys)
        known = np.zeros(keys.size, np.bool_)
        inside = at < self._keys.size
        known[inside] = self._keys[at[inside]] == keys[inside]
        self.points_m[at[known]] = fresh_m[known]
        self._seen_at_m[at[known]] = travelled_m
        new = ~known
        self._keys = np.insert(self._keys, at[new], keys[new])
        self._seen_at_m = np.insert(self._seen_at_m, at[new], travelled_m)
        self.points_m = np.insert(self.points_m, at[new], fresh_m[new], axis=0)

    def _voxels(self, points_m: Float[np.ndarray, "n 3"]) -> Int[np.ndarray, " n"]:
        """One number a voxel."""
        cells = np.floor(np.asarray(points_m, np.float64) / self._voxel_m).astype(np.int64) + _HALF
        return (cells[:, 0] << (2 * _BITS)) | (cells[:, 1] << _BITS) | cells[:, 2]
