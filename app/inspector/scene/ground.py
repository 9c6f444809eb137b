"""Floor and walls around a way that was walked, as figures draw them."""

from __future__ import annotations

from app.figures.plan import Plan, Ring, floor_rings, rings_of
from app.inspector.scene.cutting import CUT_M
from app.inspector.scene.section import CELL_M, section_of
from app.session.story import Story
from c2nav_engine.world.scene import Scene
from c2nav_engine.world.surface import Surface


def ground_of(story: Story, scene: Scene, surface: Surface) -> Plan:
    """The floor near the heights that were walked, and the walls cut above the start."""
    heights_m = [footstep.pose.position_m[1] for footstep in story.track.footsteps]
    floor = floor_rings(surface.triangles(), heights_m)
    return Plan(floor, _walls(scene, heights_m[0] + CUT_M))


def _walls(scene: Scene, height_m: float) -> tuple[Ring, ...]:
    groups = [scene.vertices_m[scene.triangles[part.first : part.stop]] for part in scene.parts]
    section = section_of(groups, height_m)
    if section is None:
        return ()
    corner = (
        section.centre_m[0] - section.size_m[0] / 2.0,
        section.centre_m[1] - section.size_m[1] / 2.0,
    )
    return rings_of(section.rgba[:, :, 3] > 0, corner, CELL_M)
