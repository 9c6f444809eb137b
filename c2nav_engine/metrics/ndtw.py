"""nDTW: how closely the visited path follows the annotated one."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from c2nav_engine.geometry import Point
from c2nav_engine.metrics.dtw import dtw_m
from c2nav_engine.metrics.trajectory import SUCCESS_M


def ndtw(positions_m: tuple[Point, ...], ground_truth_m: tuple[Point, ...]) -> float:
    """exp(−DTW(P, G) / (|G| · 3)) in (0, 1], P without consecutive repeats, G not empty."""
    path_m = np.array(without_repeats(positions_m))
    reference_m = np.array(ground_truth_m)
    return math.exp(-dtw_m(path_m, reference_m) / (len(reference_m) * SUCCESS_M))


def without_repeats(positions_m: tuple[Point, ...]) -> tuple[Point, ...]:
    """The positions without those equal to the one before."""
    kept = positions_m[:1]
    return kept + tuple(after for before, after in pairwise(positions_m) if after != before)
