"""Scenes made ready to run in: mesh, renderer and floor, shared by the episodes of one process."""

from __future__ import annotations

import hashlib
import os
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from c2nav_engine.episodes.profile import Profile
from c2nav_engine.geometry import Point
from c2nav_engine.runner.scene_cache import cache_folder
from c2nav_engine.runner.source import Source
from c2nav_engine.sensing.renderer import Renderer
from c2nav_engine.world.scene import Scene
from c2nav_engine.world.surface import DistanceField, Surface

SURFACE_VERSION = 2
"""Counts changes of the surface builder: older cached surfaces are built again."""

KEPT_SCENES = 2
"""Scenes that one process keeps ready; Matterport scans weigh hundreds of megabytes."""


class World:
    """One scene with its floor and, once something looks, its renderer.

    Attributes:
        scene: The mesh.
        surface: The floor for the profile.
        note: What a record should say about that floor: another body's, off-mesh links that were
            left out; "" for nothing.
    """

    def __init__(
        self,
        scene: Scene,
        surface: Surface,
        renderer: Callable[[Scene], Renderer],
        *,
        note: str = "",
    ) -> None:
        self.scene = scene
        self.surface = surface
        self.note = note
        self._make_renderer = renderer
        self._renderer: Renderer | None = None
        self._fields: OrderedDict[Point, DistanceField] = OrderedDict()

    @property
    def renderer(self) -> Renderer:
        """Made at the first look, because it is costly and playback needs none."""
        if self._renderer is None:
            self._renderer = self._make_renderer(self.scene)
        return self._renderer

    def field(self, goal_m: Point) -> DistanceField:
        """Distances to a goal, kept for the episodes that share it."""
        if goal_m not in self._fields:
            self._fields[goal_m] = self.surface.distance_field(goal_m)
            while len(self._fields) > 32:
                self._fields.popitem(last=False)
        return self._fields[goal_m]


def embree(scene: Scene) -> Renderer:
    """The default renderer; imported late because Open3D takes seconds."""
    from c2nav_engine.sensing.embree import EmbreeRenderer

    return EmbreeRenderer(scene)


@dataclass(frozen=True, slots=True)
class WorldsConfig:
    """How worlds are made.

    Attributes:
        profile: The body that walks them.
        renderer: Scene → renderer.
        cache: Folder for loaded scenes and built surfaces; None for `cache_folder()`.
    """

    profile: Profile
    renderer: Callable[[Scene], Renderer] = embree
    cache: Path | None = None


class Worlds:
    """The scenes of a source, made ready on demand and kept for a while."""

    def __init__(self, source: Source, config: WorldsConfig) -> None:
        self._source = source
        self._config = config
        self._kept: OrderedDict[str, World] = OrderedDict()

    def of(self, scene_id: str) -> World:
        """The world of a scene id; raises `SceneError` or `NavMeshError`."""
        if scene_id in self._kept:
            self._kept.move_to_end(scene_id)
            return self._kept[scene_id]
        scene = self._source.scene(scene_id, cache=self._config.cache)
        surface, note = self._surface(scene_id, scene)
        world = World(scene, surface, self._config.renderer, note=note)
        self._kept[scene_id] = world
        while len(self._kept) > KEPT_SCENES:
            self._kept.popitem(last=False)
        return world

    def _surface(self, scene_id: str, scene: Scene) -> tuple[Surface, str]:
        """The `.navmesh` beside the scene where there is one, else a floor built from the mesh."""
        path = self._source.scene_file(scene_id)
        profile = self._config.profile
        if path is not None and path.with_suffix(".navmesh").is_file():
            from c2nav_engine.world.navmesh import profile_note, read_navmesh

            mesh = read_navmesh(path.with_suffix(".navmesh"))
            return mesh, "; ".join(filter(None, (profile_note(mesh, profile), *mesh.notes)))
        return built_surface(scene, profile, self._config.cache or cache_folder()), ""


def built_surface(scene: Scene, profile: Profile, cache: Path) -> Surface:
    """Build the floor of a scene for a body, or take it from the cache keyed by both contents."""
    # The builder's compiled kernels take a second to import; playback never needs them.
    from c2nav_engine.world.walkable import WalkableSurface, build_surface

    body = (profile.height_m, profile.radius_m, profile.climb_m, profile.slope_rad)
    key = hashlib.sha256(f"{scene.sha256}/{body}/{SURFACE_VERSION}".encode()).hexdigest()[:32]
    path = cache / "surfaces" / f"{key}.npz"
    if path.is_file():
        return WalkableSurface.load(path)
    surface = build_surface(
        scene.vertices_m,
        scene.triangles,
        height_m=profile.height_m,
        radius_m=profile.radius_m,
        climb_m=profile.climb_m,
        slope_rad=profile.slope_rad,
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    # Two workers may build the same floor: each writes its own file, the last rename wins.
    part = path.with_name(f"{path.stem}.{os.getpid()}.npz")
    surface.save(part)
    part.replace(path)
    return surface
