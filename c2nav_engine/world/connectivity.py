"""Matterport connectivity graphs: the panorama viewpoints of R2R and which of them connect.

Matterport's own frame has Z up. Its (x, y, z) is (x, z, −y) in ours, and the foot point lies the
viewpoint's `height` below the camera, so that a graph overlays R2R-CE's episodes without the scan.
Foot heights come from a tripod, R2R-CE's from a navigation mesh: they differ by up to some 0.4 m.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from pydantic import BaseModel, Field, TypeAdapter, ValidationError

from c2nav_engine.errors import SceneError
from c2nav_engine.geometry import Point

_SUFFIX = "_connectivity"


class _Entry(BaseModel):
    """One element of the file; `visible` and unknown fields are ignored."""

    image_id: str
    pose: list[float] = Field(min_length=16, max_length=16)
    included: bool
    unobstructed: list[bool]
    height: float


@dataclass(frozen=True, slots=True)
class Viewpoint:
    """A panorama's place.

    Attributes:
        image_id: Its name in R2R.
        foot_m: The floor below the camera, world frame.
        eye_m: The camera, world frame.
    """

    image_id: str
    foot_m: Point
    eye_m: Point


@dataclass(frozen=True, slots=True)
class ConnectivityGraph:
    """The included viewpoints of one scan and the straight ways between them.

    Attributes:
        scan: The scan's name.
        viewpoints: By `image_id`, in the order of the file.
        ways_m: For each viewpoint its neighbours and the camera distance to them, metres.
    """

    scan: str
    viewpoints: Mapping[str, Viewpoint]
    ways_m: Mapping[str, Mapping[str, float]]

    def distances_m(self, image_id: str) -> dict[str, float]:
        """Length of the shortest way along the graph to every viewpoint that can be reached."""
        distances = {image_id: 0.0}
        heap = [(0.0, image_id)]
        while heap:
            reached_m, here = heapq.heappop(heap)
            if reached_m > distances[here]:
                continue
            for neighbour, length_m in self.ways_m[here].items():
                if reached_m + length_m < distances.get(neighbour, math.inf):
                    distances[neighbour] = reached_m + length_m
                    heapq.heappush(heap, (distances[neighbour], neighbour))
        return distances

    def distance_m(self, start_id: str, end_id: str) -> float:
        """Length of the shortest way between two viewpoints; `inf` where there is none."""
        return self.distances_m(start_id).get(end_id, math.inf)

    def path(self, start_id: str, end_id: str) -> list[str] | None:
        """The viewpoints of that way, both ends included; None where there is none."""
        left_m = self.distances_m(end_id)
        if start_id not in left_m:
            return None
        path = [start_id]
        while path[-1] != end_id:
            ways = self.ways_m[path[-1]]
            path.append(min(ways, key=lambda step: ways[step] + left_m[step]))
        return path

    def nearest(self, point_m: Point) -> Viewpoint:
        """The viewpoint whose foot point is nearest in space."""
        return min(self.viewpoints.values(), key=lambda view: math.dist(view.foot_m, point_m))


def read_connectivity(path: Path) -> ConnectivityGraph:
    """Read `SCAN_connectivity.json`; raises `SceneError` for anything else.

    Viewpoints that the file marks as not included are left out, as R2R does.
    """
    try:
        entries = TypeAdapter(list[_Entry]).validate_json(path.read_bytes())
    except OSError as error:
        message = f"{path}: expected a connectivity file, came {error.strerror}; check the folder"
        raise SceneError(message) from error
    except ValidationError as error:
        first = error.errors()[0]
        place = "".join(f"[{part!r}]" for part in first["loc"])
        message = (
            f"{path}: expected a list of viewpoints with image_id, pose (16 numbers), included, "
            f"unobstructed and height, came an error at {place or 'the top'}: {first['msg']}; "
            "take the file from Matterport3DSimulator's connectivity folder"
        )
        raise SceneError(message) from error
    for entry in entries:
        if len(entry.unobstructed) != len(entries):
            message = (
                f"{path}: expected {len(entries)} values of unobstructed at {entry.image_id}, "
                f"came {len(entry.unobstructed)}; take the file from Matterport3DSimulator"
            )
            raise SceneError(message)
    return _graph(path.stem.removesuffix(_SUFFIX), entries)


def connectivity_file(folder: Path, scene_id: str) -> Path:
    """Where a folder of such files has the graph of a scene id's scan."""
    return folder / f"{PurePosixPath(scene_id).stem}{_SUFFIX}.json"


def connectivity_of(folder: Path, scene_id: str) -> ConnectivityGraph:
    """The graph of a scene id's scan, from a folder of such files; raises `SceneError`."""
    path = connectivity_file(folder, scene_id)
    if not path.is_file():
        message = (
            f"expected {path.name} in {folder}, found none; Matterport3DSimulator's folder "
            "`connectivity` has one for every scan"
        )
        raise SceneError(message)
    return read_connectivity(path)


def _graph(scan: str, entries: list[_Entry]) -> ConnectivityGraph:
    viewpoints = {entry.image_id: _viewpoint(entry) for entry in entries if entry.included}
    ways_m = {
        entry.image_id: {
            other.image_id: math.dist(
                viewpoints[entry.image_id].eye_m, viewpoints[other.image_id].eye_m
            )
            for other, free in zip(entries, entry.unobstructed, strict=True)
            if free and other.included and other is not entry
        }
        for entry in entries
        if entry.included
    }
    return ConnectivityGraph(scan, viewpoints, ways_m)


def _viewpoint(entry: _Entry) -> Viewpoint:
    """The pose is a row-major 4 × 4 matrix; its last column is the camera's position."""
    x, y, z = entry.pose[3], entry.pose[7], entry.pose[11]
    return Viewpoint(entry.image_id, (x, z - entry.height, -y), (x, z, -y))
