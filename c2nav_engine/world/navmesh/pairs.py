"""Answers to a list of point pairs, in the form that `c2nav scene query` prints.

These are Detour's plain answers, for comparison with other programs that embed it: every flagged
polygon is open, a path runs between snapped points, and a move may end on another island.
`NavMesh` itself adds habitat-sim's own rules to them.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from typing import Any, cast

import numpy as np
from jaxtyping import Float32

from c2nav_engine.errors import UsageError
from c2nav_engine.world.navmesh.corridor import workspace
from c2nav_engine.world.navmesh.mesh import NavMesh
from c2nav_engine.world.navmesh.queries import find_lengths, find_moves


def query_pairs(mesh: NavMesh, pairs: object) -> dict[str, Any]:
    """Paths for `paths[].raw` (two points), moves for `steps[].from, to`, in their order.

    Returns `{"paths": [{"from", "to", "geodesic_m"}], "steps": [{"slid"}], "queries_per_s"}`; the
    distance is null where there is no path, a point where no surface lies within (2, 4, 2) m. The
    rate counts paths (moves where there are no paths) on one core, the fastest of three runs.

    Raises `UsageError` naming the entry that is not as it should be.
    """
    if not isinstance(pairs, Mapping):
        message = f"expected an object with paths and steps, came {type(pairs).__name__}"
        raise UsageError(message)
    asked = cast("Mapping[str, object]", pairs)
    ends = _rows(asked, "paths", ("raw",))
    moves = _rows(asked, "steps", ("from", "to"))
    arrays, work = mesh.as_filed, workspace(mesh.as_filed)
    lengths = np.empty(len(ends))
    landed = np.empty((len(moves), 3), np.float32)
    snapped = ends.copy()

    def find_all_lengths() -> None:
        snapped[:] = ends
        find_lengths(arrays, work, snapped, lengths)

    paths_s = _fastest_s(find_all_lengths)
    moves_s = _fastest_s(lambda: find_moves(arrays, moves, landed))
    count, taken_s = (len(ends), paths_s) if len(ends) else (len(moves), moves_s)
    return {
        "paths": [
            {
                "from": _json_point(pair[0]),
                "to": _json_point(pair[1]),
                "geodesic_m": float(length) if math.isfinite(length) else None,
            }
            for pair, length in zip(snapped, lengths, strict=True)
        ],
        "steps": [{"slid": _json_point(point)} for point in landed],
        "queries_per_s": round(count / taken_s, 1) if count else 0.0,
    }


def _fastest_s(task: Callable[[], None]) -> float:
    """Seconds of the fastest of three runs, after one that may compile."""
    task()
    taken: list[float] = []
    for _ in range(3):
        begun = time.perf_counter()
        task()
        taken.append(time.perf_counter() - begun)
    return min(taken)


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
