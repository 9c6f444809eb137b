"""Exact dynamic time warping between two polylines."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float


def dtw_m(path_m: Float[np.ndarray, "n 3"], reference_m: Float[np.ndarray, "m 3"]) -> float:
    """Least summed distance over all monotone alignments of two non-empty paths, metres.

    One numpy step per anti-diagonal, whose cells depend on the two diagonals before alone.
    VLN-CE's default is the approximate fastdtw, whose cost can only be larger (so its nDTW can
    only be lower).
    """
    rows, columns = len(path_m), len(reference_m)
    cost_m = np.linalg.norm(path_m[:, None, :] - reference_m[None, :, :], axis=2)
    before, last = np.full(rows + 1, np.inf), np.full(rows + 1, np.inf)
    before[0] = 0.0
    for diagonal in range(2, rows + columns + 1):
        low, high = max(1, diagonal - columns), min(rows, diagonal - 1)
        i = np.arange(low, high + 1)
        reached = np.minimum(np.minimum(last[i - 1], last[i]), before[i - 1])
        current = np.full(rows + 1, np.inf)
        current[i] = cost_m[i - 1, diagonal - i - 1] + reached
        before, last = last, current
    return float(last[rows])
