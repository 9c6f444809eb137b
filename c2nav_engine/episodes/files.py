"""R2R-CE episode files: reading, writing, start headings and ground truth.

The schema is VLN-CE's (`R2R_VLNCE_v1-*`): quaternions are [x, y, z, w], positions are foot
points, Y is up. Tokens and vocabulary are ignored; fields we do not know are kept.
"""

from __future__ import annotations

import gzip
import hashlib
import json
import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from c2nav_engine.episodes.episode import Episode
from c2nav_engine.episodes.fields import Fields, parse_object, read_bytes
from c2nav_engine.episodes.schema import episode_as_json, episode_from_json
from c2nav_engine.errors import EpisodeError
from c2nav_engine.geometry import Point

_VERSION = re.compile(r"v\d+[-_.]\d+")
_SAME_PLACE_M = 0.01

_HEADINGS_BY_SHA256 = {
    # Open-Nav's file carries the older start headings without saying so in its name.
    "742f0d064756fba5b530bf0a682ff51928716f1a93a6521e63ae5c43214f893c": "v1-2",
}


@dataclass(frozen=True, slots=True)
class EpisodeFile:
    """What one episode file holds.

    Attributes:
        name: File name, or `builtin`.
        episodes: In file order, distinct ids.
        sha256: Hex digest of the file's bytes as they lie on disk.
        headings: Which start headings these are: a version where known ("v1-3"), with the file
            that they came from.
        extra: Top-level fields that we do not interpret.
    """

    name: str
    episodes: tuple[Episode, ...]
    sha256: str
    headings: str
    extra: Mapping[str, object] = field(default_factory=dict[str, object])


def read_episodes(path: Path) -> EpisodeFile:
    """Read a plain or gzipped R2R-CE file.

    Raises:
        EpisodeError: Naming the file, the episode's id and the field.
    """
    data = read_bytes(path)
    top = parse_object(data, path.name)
    episodes = tuple(episode_from_json(top.owner, index, item) for index, item in _listed(top))
    _reject_duplicates(top.owner, episodes)
    digest = hashlib.sha256(data).hexdigest()
    return EpisodeFile(
        name=path.name,
        episodes=episodes,
        sha256=digest,
        headings=_headings_name(path.name, digest),
        extra=top.without("episodes", "instruction_vocab"),
    )


def write_episodes(
    path: Path, episodes: Iterable[Episode], *, extra: Mapping[str, object] | None = None
) -> None:
    """Write the R2R-CE schema, one episode a line; gzipped when the name ends in `.gz`.

    Leg ends are one more field of an episode, which other readers of the schema skip.
    """
    vocabulary: dict[str, object] = {"word_list": []}
    top: dict[str, object] = {**(extra or {}), "instruction_vocab": vocabulary}
    lines = ",\n".join(json.dumps(episode_as_json(episode)) for episode in episodes)
    rest = json.dumps(top)[1:]
    data = f'{{"episodes": [\n{lines}\n],\n{rest}\n'.encode()
    path.parent.mkdir(parents=True, exist_ok=True)
    # Without a time stamp the same episodes give the same bytes.
    path.write_bytes(gzip.compress(data, mtime=0) if path.suffix == ".gz" else data)


def with_headings(source: EpisodeFile, other: EpisodeFile) -> EpisodeFile:
    """The same episodes with the start rotations of another file of them.

    Raises:
        EpisodeError: When an episode is missing there, starts elsewhere or has another text.
    """
    found = {episode.episode_id: episode for episode in other.episodes}
    episodes = tuple(_turned(episode, found, other.name) for episode in source.episodes)
    return replace(source, episodes=episodes, headings=other.headings)


def read_headings(path: Path, source: EpisodeFile) -> EpisodeFile:
    """`source` with the start rotations that the file at `path` gives to the same episodes."""
    return with_headings(source, read_episodes(path))


def read_ground_truth(path: Path) -> dict[str, tuple[Point, ...]]:
    """Ground-truth positions by episode id from a `_gt` file; raises `EpisodeError`."""
    top = parse_object(read_bytes(path), path.name)
    locations: dict[str, tuple[Point, ...]] = {}
    for episode_id in top.values:
        entry = Fields(f"{path.name}, episode {episode_id}", top.inner(episode_id).values)
        locations[episode_id] = entry.points("locations")
    return locations


def ground_truth_beside(path: Path, source: EpisodeFile | None = None) -> Path | None:
    """The ground-truth file that belongs to an episode file, or None.

    `NAME_gt.json[.gz]` in the same folder; else the only `_gt` file there whose name carries the
    same version (`v1-2`) as the source's headings. Anything less certain is not guessed.
    """
    stem = path.name.split(".json")[0]
    for suffix in (".json.gz", ".json"):
        exact = path.with_name(f"{stem}_gt{suffix}")
        if exact.is_file():
            return exact
    version = _VERSION.match(source.headings) if source else _VERSION.search(path.name)
    if version is None or not path.parent.is_dir():
        return None
    beside = sorted(path.parent.glob("*_gt.json*"))
    matching = [found for found in beside if version.group() in found.name]
    return matching[0] if len(matching) == 1 else None


def _listed(top: Fields) -> list[tuple[int, object]]:
    items = top.items("episodes")
    if not items:
        raise top.wrong("episodes", "at least one episode")
    return list(enumerate(items))


def _reject_duplicates(owner: str, episodes: tuple[Episode, ...]) -> None:
    seen: set[str] = set()
    for episode in episodes:
        if episode.episode_id in seen:
            message = f"{owner}, episode {episode.episode_id}: expected distinct ids, came it twice"
            raise EpisodeError(message)
        seen.add(episode.episode_id)


def _turned(episode: Episode, found: Mapping[str, Episode], name: str) -> Episode:
    """One episode with another file's heading, if that file means the same episode."""
    owner = f"{name}, episode {episode.episode_id}"
    other = found.get(episode.episode_id)
    if other is None:
        raise EpisodeError(f"{owner}: expected a start rotation, came no such episode")
    if math.dist(episode.start.position_m, other.start.position_m) > _SAME_PLACE_M:
        message = (
            f"{owner}: start_position: expected {episode.start.position_m} (within 1 cm), "
            f"came {other.start.position_m}; take headings from a file of the same episodes"
        )
        raise EpisodeError(message)
    if episode.instruction.split() != other.instruction.split():
        message = (
            f"{owner}: instruction_text: expected {episode.instruction!r}, "
            f"came {other.instruction!r}; take headings from a file of the same episodes"
        )
        raise EpisodeError(message)
    return replace(episode, start=replace(episode.start, yaw_rad=other.start.yaw_rad))


def _headings_name(name: str, digest: str) -> str:
    """A version with its file ("v1-3 (…)") where the version is known, else the file alone."""
    written = _VERSION.search(name)
    version = written.group() if written else _HEADINGS_BY_SHA256.get(digest)
    return f"{version} ({name})" if version else name
