"""Questions a second on one navigation mesh, on one core.

python benchmarks/navmesh.py MESH.navmesh [--points 400] [--seed 0]
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from c2nav_engine.geometry import Point
from c2nav_engine.world.navmesh import NavMesh, query_pairs, read_navmesh


def points_on(mesh: NavMesh, count: int, rng: np.random.Generator) -> list[Point]:
    """Points drawn evenly over the floor of the largest island."""
    triangles = mesh.triangles()
    sides = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    area = np.linalg.norm(sides, axis=1)
    largest = int(np.argmax([island.area_m2 for island in mesh.islands]))
    points: list[Point] = []
    while len(points) < count:
        corners = triangles[rng.choice(len(triangles), p=area / area.sum())]
        x, y, z = (rng.dirichlet([1.0, 1.0, 1.0]) @ corners).tolist()
        snapped = mesh.snap((x, y, z))
        if snapped is not None and mesh.island_at(snapped) == largest:
            points.append(snapped)
    return points


def rate(task: Callable[[], object], count: int) -> float:
    """Best of five runs, questions a second; a run before them compiles."""
    task()
    times: list[float] = []
    for _ in range(5):
        begun = time.perf_counter()
        task()
        times.append(time.perf_counter() - begun)
    return count / min(times)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("mesh", type=Path, help="a .navmesh file")
    parser.add_argument("--points", type=int, default=400, help="questions a run (default 400)")
    parser.add_argument("--seed", type=int, default=0, help="which points (default 0)")
    options = parser.parse_args()
    mesh = read_navmesh(options.mesh)
    starts = points_on(mesh, options.points, np.random.default_rng(options.seed))
    goals = starts[1:] + starts[:1]
    batch = {"paths": [{"raw": pair} for pair in zip(starts, goals, strict=True)]}
    steps = [(start, (start[0] + 0.25, start[1], start[2])) for start in starts]
    field, array = mesh.distance_field(goals[0]), np.array(starts)

    paths = rate(lambda: [mesh.geodesic_m(a, b) for a, b in zip(starts, goals, strict=True)],
                 len(starts))  # fmt: skip
    to_one = rate(lambda: [mesh.geodesic_m(start, goals[0]) for start in starts], len(starts))
    from_field = rate(lambda: field.distances_m(array), len(starts))
    rows = {
        "paths, one call each": paths,
        "paths, one batch": max(query_pairs(mesh, batch)["queries_per_s"] for _ in range(5)),
        "paths to one goal, one call each": to_one,
        "field, one call each": rate(lambda: [field.distance_m(p) for p in starts], len(starts)),
        "field, one batch": from_field,
        "steps, one call each": rate(lambda: [mesh.slide(a, b) for a, b in steps], len(steps)),
        "snaps, one call each": rate(lambda: [mesh.snap(start) for start in starts], len(starts)),
    }
    table = Table(title=f"{options.mesh.name}: {len(mesh.arrays.polygons)} polygons")
    table.add_column("question")
    table.add_column("per second", justify="right")
    for name, value in rows.items():
        table.add_row(name, f"{value:,.0f}")
    table.add_row("field batch ÷ paths to one goal", f"{from_field / to_one:.1f}")
    Console().print(table)


if __name__ == "__main__":
    main()
