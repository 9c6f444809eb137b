"""What lies around a recorded run, where its scene is to be had: mesh, floor, walls."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from app.figures.plan import Plan
from app.inspector.scene.ground import ground_of
from app.session.story import Story
from c2nav_engine.errors import NavMeshError, SceneError
from c2nav_engine.runner.reshell import source_of_record
from c2nav_engine.runner.worlds import Worlds, WorldsConfig
from c2nav_engine.world.scene import Scene
from c2nav_engine.world.surface import Surface


@dataclass(frozen=True, slots=True)
class Surroundings:
    """A scene as far as it is to be had.

    Attributes:
        scene: The mesh; None where it is not to be had.
        surface: The floor that was measured on; None likewise.
        plan: Floor and walls from above.
        why_not: Why there is no scene, and what to do about it; "" where there is one.
    """

    scene: Scene | None = None
    surface: Surface | None = None
    plan: Plan = field(default_factory=Plan)
    why_not: str = ""


def surroundings_of(story: Story, scenes: Path | None) -> Surroundings:
    """Load the scene of a run and take its floor plan; never raises for a missing scene."""
    header = story.header
    try:
        worlds = Worlds(source_of_record(header, scenes), WorldsConfig(header.profile))
        world = worlds.of(header.episode.scene_id)
    except (SceneError, NavMeshError) as error:
        return Surroundings(why_not=str(error))
    return Surroundings(world.scene, world.surface, ground_of(story, world.scene, world.surface))
