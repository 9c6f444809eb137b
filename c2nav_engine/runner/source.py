"""Where episodes come from: `builtin`, or an R2R-CE file with a scenes folder."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from c2nav_engine.episodes.episode import Episode
from c2nav_engine.episodes.files import (
    EpisodeFile,
    ground_truth_beside,
    read_episodes,
    read_ground_truth,
    read_headings,
)
from c2nav_engine.errors import EpisodeError, SceneError, UsageError
from c2nav_engine.geometry import Point
from c2nav_engine.metrics.ground_truth import follower_positions
from c2nav_engine.world.builtin import builtin_scene, builtin_source
from c2nav_engine.world.load import load_scene
from c2nav_engine.world.load_paths import scene_path
from c2nav_engine.world.scene import Scene

BUILTIN = "builtin"


@dataclass(frozen=True, slots=True)
class Source:
    """Episodes with the way to their scenes and ground truth.

    Attributes:
        file: The episodes, with the name and hash of where they came from.
        scenes: Folder below which scene ids resolve; None for built-in houses.
        ground_truth: Positions by episode id, where a file gives them.
        ground_truth_name: That file's name, else "reference path".
    """

    file: EpisodeFile
    scenes: Path | None
    ground_truth: Mapping[str, tuple[Point, ...]]
    ground_truth_name: str

    def episode(self, episode_id: str) -> Episode:
        """The episode of that id; raises `UsageError` naming some that exist."""
        for episode in self.file.episodes:
            if episode.episode_id == episode_id:
                return episode
        some = ", ".join(episode.episode_id for episode in self.file.episodes[:8])
        message = f"expected an episode id of {self.file.name} ({some}, …), came {episode_id!r}"
        raise UsageError(message)

    def chosen(self, ids: Sequence[str]) -> tuple[Episode, ...]:
        """The episodes of those ids in file order, or all of them."""
        if not ids:
            return self.file.episodes
        wanted = {self.episode(episode_id).episode_id for episode_id in ids}
        return tuple(e for e in self.file.episodes if e.episode_id in wanted)

    def scene_file(self, scene_id: str) -> Path | None:
        """The scene's file; None for a built-in house. Raises `SceneError` when it is missing."""
        if scene_id.startswith(f"{BUILTIN}/"):
            return None
        if self.scenes is None:
            message = f"scene {scene_id}: expected a scenes folder; name it with --scenes DIR"
            raise SceneError(message)
        return scene_path(self.scenes, scene_id)

    def scene(self, scene_id: str) -> Scene:
        """Load or build a scene; raises `SceneError`."""
        path = self.scene_file(scene_id)
        return builtin_scene(scene_id) if path is None else load_scene(path)

    def ground_truth_of(self, episode: Episode) -> tuple[Point, ...]:
        """Reference positions for nDTW: the file's, else the densified reference path."""
        known = self.ground_truth.get(episode.episode_id)
        return known if known is not None else follower_positions(episode.reference_path_m)


def open_source(
    name: str,
    *,
    scenes: Path | None = None,
    headings: Path | None = None,
    ground_truth: Path | None = None,
) -> Source:
    """Open `builtin` or an episode file.

    Args:
        name: `builtin`, or the path of a `.json` or `.json.gz` file.
        scenes: Folder below which scene ids resolve.
        headings: Another file of the same episodes whose start rotations are taken.
        ground_truth: A `_gt` file; by default the one beside the source.

    Raises:
        EpisodeError: A file is missing or wrong.
    """
    if name == BUILTIN:
        return Source(builtin_source(), scenes, {}, "reference path")
    path = Path(name)
    if not path.is_file():
        message = f"expected `builtin` or an R2R-CE file (.json, .json.gz), came {name!r}: no file"
        raise EpisodeError(message)
    file = read_episodes(path)
    if headings is not None:
        file = read_headings(headings, file)
    truth = ground_truth or ground_truth_beside(path, file)
    return Source(
        file=file,
        scenes=scenes,
        ground_truth=read_ground_truth(truth) if truth else {},
        ground_truth_name=truth.name if truth else "reference path",
    )
