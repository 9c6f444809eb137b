"""Scene ids of episode files to files below the scenes folder."""

from __future__ import annotations

from pathlib import Path, PurePosixPath

from c2nav_engine.errors import SceneError

PREFIXES = (
    "",
    "mp3d",
    "data/scene_datasets",
    "data/scene_datasets/mp3d",
    "scene_datasets",
    "scene_datasets/mp3d",
    "v1/tasks",
    "v1/tasks/mp3d",
)
"""Folders that an id may carry, or lack, compared with how the files lie; the last two are where
Matterport's own download script puts them."""

SUFFIXES = (".glb", ".ply", ".gltf", ".obj")


def scene_path(scenes: Path, scene_id: str) -> Path:
    """The file of a scene id, tried under the usual names below the scenes folder.

    An id may come with or without `data/scene_datasets/`, `mp3d/` and its suffix, and as the
    bare name of a scan (`SCAN` stands for `mp3d/SCAN/SCAN.glb`).

    Raises:
        SceneError: No such file, or the id points outside the folder.
    """
    wanted = PurePosixPath(scene_id)
    if not scene_id.strip() or wanted.is_absolute() or ".." in wanted.parts or "\\" in scene_id:
        message = f"expected a scene id below {scenes}, came {scene_id!r}; correct the episode file"
        raise SceneError(message)
    names = _variants(wanted)
    for name in names:
        path = scenes / name
        if path.is_file() and _lies_below(path, scenes):
            return path
    if not scenes.is_dir():
        message = f"expected a folder at {scenes}, found none; name it with --scenes"
        raise SceneError(message)
    message = (
        f"expected scene {scene_id!r} below {scenes}, found none of {_listed(names)}; "
        "put it there, or name another folder with --scenes"
    )
    raise SceneError(message)


def _listed(names: list[str]) -> str:
    """The likeliest places whole; of the other formats, the place that is tried first."""
    suffix = PurePosixPath(names[0]).suffix
    likeliest = [name for name in names if PurePosixPath(name).suffix == suffix]
    others: dict[str, str] = {}
    for name in names:
        others.setdefault(PurePosixPath(name).suffix, name)
    others.pop(suffix)
    return ", ".join([*likeliest, *others.values()])


def _lies_below(path: Path, scenes: Path) -> bool:
    """Whether the path, as written, stays below the folder; links inside it are the user's own."""
    return path.absolute().is_relative_to(scenes.absolute())


def _variants(wanted: PurePosixPath) -> list[str]:
    """Relative paths to try, likeliest first, without repeats."""
    core = _core(wanted)
    stems = [core.with_suffix("") if core.suffix in SUFFIXES else core]
    if len(stems[0].parts) == 1:
        stems.append(stems[0] / stems[0].name)
    elif stems[0].parts[-2] == stems[0].name:
        # SCAN/SCAN.glb may lie flat, as SCAN.glb.
        stems.append(stems[0].parent.parent / stems[0].name)
    suffixes = dict.fromkeys([core.suffix, *SUFFIXES] if core.suffix in SUFFIXES else SUFFIXES)
    tried = [str(wanted)] if wanted.suffix in SUFFIXES else []
    tried += [
        str(PurePosixPath(prefix) / f"{stem}{suffix}")
        for suffix in suffixes
        for prefix in PREFIXES
        for stem in stems
    ]
    return list(dict.fromkeys(tried))


def _core(wanted: PurePosixPath) -> PurePosixPath:
    """The id without a prefix that may or may not be there."""
    for prefix in ("data/scene_datasets/mp3d", "data/scene_datasets", "mp3d"):
        if wanted.is_relative_to(prefix) and wanted != PurePosixPath(prefix):
            return wanted.relative_to(prefix)
    return wanted
