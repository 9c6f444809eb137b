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
from c2nav_engine.runner.scene_cache import cache_folder, cached_scene
from c2nav_engine.world.builtin import builtin_scene, builtin_source
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
        own_headings: Heading version of the file itself; `file.headings` is the one in use.
    """

    file: EpisodeFile
    scenes: Path | None
    ground_truth: Mapping[str, tuple[Point, ...]]
    ground_truth_name: str
    own_headings: str = ""

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

    def scene(self, scene_id: str, *, cache: Path | None = None) -> Scene:
        """Load a scene (large ones from the cache) or build it; raises `SceneError`."""
        path = self.scene_file(scene_id)
        if path is None:
            return builtin_scene(scene_id)
        return cached_scene(path, cache or cache_folder())

    def missing_scenes(self, chosen: Sequence[Episode]) -> dict[str, tuple[str, ...]]:
        """Scene ids that do not resolve, each with the ids of the episodes that it blocks."""
        missing: dict[str, tuple[str, ...]] = {}
        found: set[str] = set()
        for episode in chosen:
            scene_id = episode.scene_id
            if scene_id in found:
                continue
            if scene_id not in missing and self._has(scene_id):
                found.add(scene_id)
                continue
            missing[scene_id] = (*missing.get(scene_id, ()), episode.episode_id)
        return missing

    def require_scenes(self, chosen: Sequence[Episode]) -> None:
        """Raise one `SceneError` that lists every missing scene with how many episodes it blocks.

        A single missing scene is named with all the places where it was sought.
        """
        missing = self.missing_scenes(chosen)
        if len(missing) == 1:
            self.scene_file(next(iter(missing)))
        if missing:
            blocked = sum(map(len, missing.values()))
            where = f"below {self.scenes}" if self.scenes else "and no scenes folder is named"
            lines = [f"  {scene_id}  ({len(ids)})" for scene_id, ids in sorted(missing.items())]
            message = "\n".join(
                [
                    f"expected {len(missing)} scenes that are not there ({where}); they block "
                    f"{blocked} of {len(chosen)} episodes:",
                    *lines,
                    "name the folder that holds them with --scenes DIR (mp3d/SCAN/SCAN.glb below "
                    "it), or choose other episodes; `c2nav episodes check` says more",
                ]
            )
            raise SceneError(message)

    def facts(self) -> dict[str, str]:
        """What a run record says about where its episode came from, name → text."""
        own = self.own_headings
        told = {"source_headings": own} if own and own != self.file.headings else {}
        return {
            "source": self.file.name,
            "source_sha256": self.file.sha256,
            "ground_truth": self.ground_truth_name,
            **told,
        }

    def _has(self, scene_id: str) -> bool:
        try:
            self.scene_file(scene_id)
        except SceneError:
            return False
        return True

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
    own = read_episodes(path)
    file = own if headings is None else read_headings(headings, own)
    truth = ground_truth or _ground_truth_for(path, file, headings)
    return Source(
        file=file,
        scenes=scenes,
        ground_truth=read_ground_truth(truth) if truth else {},
        ground_truth_name=truth.name if truth else "reference path",
        own_headings=own.headings,
    )


def _ground_truth_for(path: Path, file: EpisodeFile, headings: Path | None) -> Path | None:
    """The ground truth that belongs to the headings in use, which may be another file's.

    With borrowed headings, the file's own `_gt` would be another version's walk: it is not taken.
    """
    if headings is None:
        return ground_truth_beside(path, file)
    return ground_truth_beside(headings, file) or ground_truth_beside(
        path.with_name(headings.name), file
    )
