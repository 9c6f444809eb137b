"""A scene named on the command line: a file, a scene id below a folder, or a built-in house."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from c2nav_engine.episodes.files import EpisodeFile
from c2nav_engine.episodes.profile import Profile
from c2nav_engine.errors import SceneError
from c2nav_engine.runner.source import BUILTIN, Source
from c2nav_engine.runner.worlds import World, Worlds, WorldsConfig


@dataclass(frozen=True, slots=True)
class OpenedScene:
    """A scene made ready.

    Attributes:
        scene_id: What episodes call it, relative to `scenes`.
        scenes: The folder below which that id resolves; None for a built-in house.
        world: Mesh and floor.
    """

    scene_id: str
    scenes: Path | None
    world: World


def opened_scene(name: str, scenes: Path | None, profile: Profile) -> OpenedScene:
    """Open what the words name; raises `SceneError`."""
    scene_id, folder = named_scene(name, scenes)
    worlds = Worlds(scene_source(folder), WorldsConfig(profile))
    return OpenedScene(scene_id, folder, worlds.of(scene_id))


def scene_source(scenes: Path | None) -> Source:
    """A source without episodes, for its scenes."""
    return Source(EpisodeFile("", (), "", ""), scenes, {}, "")


def short_id(scene_id: str) -> str:
    """A scan's name for an id that says it twice."""
    stem = scene_id.rsplit("/", 1)[-1].rsplit(".", 1)[0]
    return stem if scene_id == f"mp3d/{stem}/{stem}.glb" else scene_id


def named_scene(name: str, scenes: Path | None) -> tuple[str, Path | None]:
    """The scene id and the folder below which it resolves; raises `SceneError` for neither."""
    if name.startswith(f"{BUILTIN}/"):
        return name, None
    path = Path(name)
    if not path.is_file():
        if scenes is not None:
            return name, scenes
        message = (
            f"expected a scene file, builtin/NAME, or a scene id with --scenes DIR; came {name!r}"
        )
        raise SceneError(message)
    # A file below the scenes folder keeps its place there: other tools know that id.
    if scenes is not None and path.resolve().is_relative_to(scenes.resolve()):
        return str(path.resolve().relative_to(scenes.resolve())), scenes
    return path.name, path.parent
