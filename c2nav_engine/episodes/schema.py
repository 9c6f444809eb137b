"""One episode in the R2R-CE schema: JSON to `Episode` and back.

Quaternions are [x, y, z, w]. Tokens are ignored; fields we do not know are kept in `extra`.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Mapping
from dataclasses import replace

from c2nav_engine.episodes.episode import Episode
from c2nav_engine.episodes.fields import Fields
from c2nav_engine.errors import EpisodeError
from c2nav_engine.geometry import Point, Pose

_IDENTIFIER = re.compile(r"\w[\w.\-]{0,99}")
_SMALLEST_ROTATION = 1e-6
"""Norm under which a quaternion says nothing; R2R-CE's are unit to five digits."""
_KNOWN = (
    "episode_id",
    "trajectory_id",
    "scene_id",
    "start_position",
    "start_rotation",
    "info",
    "goals",
    "instruction",
    "reference_path",
    "leg_ends",
)


def episode_from_json(owner: str, index: int, item: object) -> Episode:
    """One entry of a file's `episodes`.

    Args:
        owner: What error messages call the file.
        index: Position in the file, for entries without a usable id.
        item: The parsed JSON.

    Raises:
        EpisodeError: Naming the episode and the field.
    """
    if not isinstance(item, dict):
        message = f"{owner}: episodes[{index}]: expected an object, came {type(item).__name__}"
        raise EpisodeError(message)
    unnamed = Fields(f"{owner}, episodes[{index}]", item)  # pyright: ignore[reportUnknownArgumentType]
    episode_id = _identifier(unnamed, "episode_id")
    fields = replace(unnamed, owner=f"{owner}, episode {episode_id}")
    position_m = fields.point("start_position")
    reference_path_m = fields.points("reference_path") if fields.has("reference_path") else ()
    goal_m, goal_radius_m = _goal(fields)
    has_trajectory = fields.has("trajectory_id")
    return Episode(
        episode_id=episode_id,
        trajectory_id=_identifier(fields, "trajectory_id") if has_trajectory else "",
        scene_id=_named(fields, "scene_id"),
        start=Pose.from_quaternion(position_m, _rotation(fields)),
        instruction=_named(fields.inner("instruction"), "instruction_text"),
        goal_m=goal_m,
        goal_radius_m=goal_radius_m,
        geodesic_m=_geodesic(fields),
        reference_path_m=reference_path_m,
        leg_ends=_leg_ends(fields, len(reference_path_m)),
        extra=_kept(fields),
    )


def _identifier(fields: Fields, name: str) -> str:
    """An id as text; ids become parts of file names, so only plain ones pass."""
    value = fields.values.get(name)
    if isinstance(value, int) and not isinstance(value, bool) and 0 <= value < 10**18:
        return str(value)
    if isinstance(value, str) and _IDENTIFIER.fullmatch(value):
        return fields.text(name)
    raise fields.wrong(name, "a number or a plain name (letters, digits, _ . -)")


def _named(fields: Fields, name: str) -> str:
    text = fields.text(name)
    if not text.strip():
        raise fields.wrong(name, "a text that is not empty")
    return text


def _rotation(fields: Fields) -> tuple[float, float, float, float]:
    x, y, z, w = fields.vector("start_rotation", 4)
    norm = math.hypot(x, y, z, w)
    if not _SMALLEST_ROTATION < norm < 1.0 / _SMALLEST_ROTATION:
        raise fields.wrong("start_rotation", "a rotation [x, y, z, w] that is not zero")
    return (x / norm, y / norm, z / norm, w / norm)


def _goal(fields: Fields) -> tuple[Point | None, float]:
    """First goal and its radius; a test split has none."""
    if not fields.has("goals") or not fields.items("goals"):
        return None, 3.0
    first = fields.items("goals")[0]
    if not isinstance(first, dict):
        raise fields.wrong("goals", "a list of objects")
    goal = Fields(fields.owner, first, "goals[0].")  # pyright: ignore[reportUnknownArgumentType]
    radius_m = goal.number("radius") if goal.has("radius") else 3.0
    if radius_m <= 0.0:
        raise goal.wrong("radius", "a radius above 0")
    return goal.point("position"), radius_m


def _geodesic(fields: Fields) -> float | None:
    if not fields.has("info") or not fields.inner("info").has("geodesic_distance"):
        return None
    info = fields.inner("info")
    distance_m = info.number("geodesic_distance")
    if distance_m < 0.0:
        raise info.wrong("geodesic_distance", "a distance of at least 0")
    return distance_m


def _leg_ends(fields: Fields, points: int) -> tuple[int, ...]:
    """Strictly ascending indices, the last one at the path's end."""
    if not fields.has("leg_ends"):
        return ()
    ends = [end for end in fields.items("leg_ends") if isinstance(end, int) and end is not True]
    rising = all(before < after for before, after in itertools.pairwise(ends))
    whole = len(ends) == len(fields.items("leg_ends"))
    if not (whole and rising and ends and ends[0] > 0 and ends[-1] == points - 1):
        raise fields.wrong("leg_ends", "rising indices that end with the reference path")
    return tuple(ends)


def _kept(fields: Fields) -> dict[str, object]:
    """Unknown fields, those of `info` and `instruction` and further goals included."""
    kept = fields.without(*_KNOWN)
    if fields.has("info"):
        kept["info"] = fields.inner("info").without("geodesic_distance")
    kept["instruction"] = fields.inner("instruction").without(
        "instruction_text", "instruction_tokens"
    )
    if fields.has("goals"):
        kept["goals"] = fields.items("goals")[1:]
    return {name: value for name, value in kept.items() if value not in ({}, [])}


def episode_as_json(episode: Episode) -> dict[str, object]:
    """The JSON form of an episode; reading it again gives the same episode."""
    extra = dict(episode.extra)
    info = _as_dict(extra.pop("info", {}))
    instruction = _as_dict(extra.pop("instruction", {}))
    goals = extra.pop("goals", [])
    plain: dict[str, object] = {
        "episode_id": _number_or_text(episode.episode_id),
        "trajectory_id": _number_or_text(episode.trajectory_id),
        "scene_id": episode.scene_id,
        "start_position": list(episode.start.position_m),
        "start_rotation": list(episode.start.quaternion_xyzw),
        "info": {"geodesic_distance": episode.geodesic_m} | info,
        "goals": [],
        "instruction": {
            "instruction_text": episode.instruction,
            "instruction_tokens": [],
        }
        | instruction,
        "reference_path": [list(point) for point in episode.reference_path_m],
    }
    if episode.goal_m is not None:
        first = {"position": list(episode.goal_m), "radius": episode.goal_radius_m}
        plain["goals"] = [first, *(goals if isinstance(goals, list) else [])]  # pyright: ignore[reportUnknownArgumentType]
    if episode.geodesic_m is None:
        plain["info"] = info
    if not episode.trajectory_id:
        del plain["trajectory_id"]
    if episode.leg_ends:
        plain["leg_ends"] = list(episode.leg_ends)
    return plain | extra


def _as_dict(value: object) -> dict[str, object]:
    return dict(value) if isinstance(value, Mapping) else {}  # pyright: ignore[reportUnknownArgumentType, reportUnknownVariableType]


def _number_or_text(identifier: str) -> int | str:
    return int(identifier) if re.fullmatch(r"0|[1-9][0-9]{0,17}", identifier) else identifier
