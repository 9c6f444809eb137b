"""Answers to a list of point pairs, in the form that `c2nav scene query` prints.

These are Detour's plain answers, for comparison with other programs that embed it: every flagged
polygon is open, a path runs between snapped points, and a move may end on another island.
`NavMesh` itself adds habitat-sim's own rules to them.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from typing import Any, cast

import numpy as np
from jaxtyping import Float32

from c2nav_engine.errors import UsageError
from c2nav_engine.world.navmesh.corridor import workspace
from c2nav_engine.world.navmesh.mesh import NavMesh
from c2nav_engine.world.navmesh.queries import find_lengths, find_moves


def query_pairs(mesh: NavMesh, pairs: Mapping[str, object]) -> dict[str, Any]:
    """Paths for `paths[].raw` (two points), moves for `steps[].from, to`, in their order.

    Returns `{"paths": [{"from", "to", "geodesic_m"}], "steps": [{"slid"}], "queries_per_s"}`; the
    distance is null where there is no path, a point where no surface lies within (2, 4, 2) m. The
    rate counts paths (moves where there are no paths) on one core, without compilation.

    Raises `UsageError` naming the entry that is not as it should be.
    """
    ends = _rows(pairs, "paths", ("raw",))
    moves = _rows(pairs, "steps", ("from", "to"))
    arrays, work = mesh.as_filed, workspace(mesh.as_filed)
    lengths = np.empty(len(ends))
    landed = np.empty((len(moves), 3), np.float32)
    find_lengths(arrays, work, ends[:0], lengths)
    find_moves(arrays, moves[:0], landed)
    begun = time.perf_counter()
    find_lengths(arrays, work, ends, lengths)
    between = time.perf_counter()
    find_moves(arrays, moves, landed)
    ended = time.perf_counter()
    count, taken_s = (len(ends), between - begun) if len(ends) else (len(moves), ended - between)
    return {
        "paths": [
            {
                "from": _json_point(pair[0]),
                "to": _json_point(pair[1]),
                "geodesic_m": float(length) if math.isfinite(length) else None,
            }
            for pair, length in zip(ends, lengths, strict=True)
        ],
        "steps": [{"slid": _json_point(point)} for point in landed],
        "queries_per_s": round(count / taken_s, 1) if count else 0.0,
    }


def _json_point(row: Float32[np.ndarray, " xyz"]) -> list[float] | None:
    return [float(value) for value in row] if np.isfinite(row).all() else None


def _rows(
    pairs: Mapping[str, object], key: str, names: tuple[str, ...]
) -> Float32[np.ndarray, "n 2 3"]:
    found = pairs.get(key, [])
    if not isinstance(found, list):
        message = f"expected {key} to be a list, came {type(found).__name__}"
        raise UsageError(message)
    entries = cast("list[object]", found)
    rows = np.empty((len(entries), 2, 3), np.float32)
    for index, entry in enumerate(entries):
        where = f"{key}[{index}]"
        values = [_entry(entry, name, where) for name in names]
        rows[index] = _points(values[0] if len(names) == 1 else values, where)
    return rows


def _entry(entry: object, name: str, where: str) -> object:
    if not isinstance(entry, Mapping) or name not in entry:
        message = f"expected {where} to hold {name!r}, came {entry!r}"
        raise UsageError(message)
    return cast("Mapping[str, object]", entry)[name]


def _points(values: object, where: str) -> Float32[np.ndarray, "2 3"]:
    try:
        with np.errstate(over="ignore"):
            points = np.array(values, np.float32)
    except (TypeError, ValueError):
        points = np.empty(0, np.float32)
    if points.shape != (2, 3) or not np.isfinite(points).all():
        message = f"expected {where} to be two points [x, y, z] in metres, came {values!r}"
        raise UsageError(message)
    return points
