"""What the source named `builtin` holds: a hundred stored episodes in generated houses.

Episodes are stored, because their texts come from measured shortest paths; houses are generated
when one is opened. Neither needs a file from outside the package.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

from c2nav_engine.episodes.files import EpisodeFile, read_episodes
from c2nav_engine.errors import SceneError
from c2nav_engine.world.scene import Scene

EPISODES_FILE = Path(__file__).with_name("episodes.json")
_PREFIX = "builtin/"


@lru_cache(maxsize=1)
def builtin_source() -> EpisodeFile:
    """The hundred built-in episodes; no house is built for them."""
    return replace(read_episodes(EPISODES_FILE), name="builtin", headings="builtin")


def house_names() -> tuple[str, ...]:
    """Names of the built-in houses, as in scene ids after `builtin/`."""
    from c2nav_engine.world.builtin.houses import PLANS

    return tuple(PLANS)


@lru_cache(maxsize=4)
def builtin_scene(scene_id: str) -> Scene:
    """The scene of `builtin/NAME`; raises `SceneError` for a name that does not exist."""
    # Generating needs numpy's and scipy's heavier parts: only what opens a house pays for them.
    from c2nav_engine.world.builtin.house import house_of, scene_of_house
    from c2nav_engine.world.builtin.houses import PLANS

    name = scene_id.removeprefix(_PREFIX)
    if not scene_id.startswith(_PREFIX) or name not in PLANS:
        known = ", ".join(f"{_PREFIX}{each}" for each in PLANS)
        message = f"expected a built-in scene ({known}), came {scene_id!r}"
        raise SceneError(message)
    return scene_of_house(house_of(PLANS[name]))
