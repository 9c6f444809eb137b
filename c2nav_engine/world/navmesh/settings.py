"""For which body a navigation mesh was built, as far as its file says."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from c2nav_engine.episodes.profile import Profile
from c2nav_engine.world.navmesh.cursor import Cursor

HABITAT_HEIGHT_M = 1.5
HABITAT_RADIUS_M = 0.1

_NUMBERS = (
    "cell_size_m",
    "cell_height_m",
    "agent_height_m",
    "agent_radius_m",
    "agent_climb_m",
    "agent_slope_deg",
    "region_min_cells",
    "region_merge_cells",
    "edge_max_length_m",
    "edge_max_error_cells",
    "corners_per_polygon",
    "detail_sample_cells",
    "detail_sample_error_cells",
)
_FLAGS = (
    "filter_low_hanging_obstacles",
    "filter_ledge_spans",
    "filter_low_height_spans",
    "include_static_objects",
)
BLOCK_BYTES = 4 * len(_NUMBERS) + len(_FLAGS)


@dataclass(frozen=True, slots=True)
class NavMeshSettings:
    """The body a mesh was built for.

    Attributes:
        agent_height_m: Clearance above every point of the mesh.
        agent_radius_m: How far the mesh keeps from obstacles.
        agent_climb_m: Highest step between neighbouring cells.
        recorded: All values of version 2's settings block under descriptive names (angles in
            degrees, as written); empty for version 1, whose tile headers hold the three above.
    """

    agent_height_m: float
    agent_radius_m: float
    agent_climb_m: float
    recorded: Mapping[str, float] = field(default_factory=dict[str, float])


def read_block(cursor: Cursor, *, bounds_bytes: int) -> dict[str, float]:
    """Version 2's settings block: thirteen numbers and four flags, scene bounds perhaps between."""
    start = cursor.offset
    values = cursor.floats("settings", len(_NUMBERS))
    cursor.array("scene bounds", "u1", bounds_bytes)
    flags = [float(flag) for flag in cursor.array("settings flags", "u1", len(_FLAGS))]
    recorded: dict[str, float] = {}
    recorded.update(zip((*_NUMBERS, *_FLAGS), (*values, *flags), strict=True))
    for index, (name, value) in enumerate(recorded.items()):
        if not math.isfinite(value) or value < 0.0:
            raise cursor.error(f"{name} ≥ 0", f"{value}", offset=start + 4 * index)
    return recorded


def profile_note(settings: NavMeshSettings, profile: Profile) -> str:
    """What Habitat would do with this mesh and that body; empty where both agree.

    Habitat recomputes the mesh at start for a body other than 1.5 m × 0.1 m; we keep the file's,
    so distances near obstacles can differ from its own.
    """
    body = f"{profile.height_m:g} m high, {profile.radius_m:g} m in radius"
    built = f"{settings.agent_height_m:g} m and {settings.agent_radius_m:g} m"
    if not _same(profile, HABITAT_HEIGHT_M, HABITAT_RADIUS_M):
        return (
            f"profile {profile.name} is {body}: habitat-sim would recompute the navigation mesh; "
            f"this one was built for {built} and is used as it is"
        )
    if not _same(profile, settings.agent_height_m, settings.agent_radius_m):
        return (
            f"profile {profile.name} is {body}, but this navigation mesh was built for {built}; "
            "it is used as it is"
        )
    return ""


def _same(profile: Profile, height_m: float, radius_m: float) -> bool:
    # The file holds 32-bit numbers: 0.1 comes back as 0.100000001.
    return bool(np.isclose(profile.height_m, height_m) and np.isclose(profile.radius_m, radius_m))
