"""Loaded scenes on disk, keyed by content, so that a large scan opens quickly the second time."""

from __future__ import annotations

import hashlib
import logging
import os
import shutil
from collections.abc import Callable, Iterable
from pathlib import Path

from c2nav_engine.world.lighten import LIGHT_TRIANGLES, LIGHT_VERSION, lightened
from c2nav_engine.world.load import load_scene
from c2nav_engine.world.load_file import is_photographed
from c2nav_engine.world.load_pictures import glb_pictures, is_whole
from c2nav_engine.world.scene import Scene
from c2nav_engine.world.scene_store import FACTS, STORE_VERSION, open_scene, save_scene

log = logging.getLogger(__name__)

SMALLEST_BYTES = 1_000_000
"""Smaller files are read as they are [C]: the loader's import alone takes a second."""


def cache_folder() -> Path:
    """Where scenes and floors are kept: `C2NAV_CACHE`, else the user's cache folder."""
    default = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "c2nav"
    return Path(os.environ.get("C2NAV_CACHE", default))


def cached_scene(path: Path, cache: Path, *, smallest_bytes: int = SMALLEST_BYTES) -> Scene:
    """The scene of a file, from the cache where the same bytes were loaded before.

    Files that lean on others (`.gltf`, `.obj`) and small ones are always loaded.

    Raises:
        SceneError: As `load_scene`.
    """
    large = path.is_file() and path.stat().st_size >= smallest_bytes
    if not large or not _is_whole(path):
        return load_scene(path)
    folder = cache / "scenes" / _key(path)
    return _kept(folder, path.stem, lambda: load_scene(path), lambda: glb_pictures(path))


def display_scene(scene: Scene, cache: Path, *, triangles: int = LIGHT_TRIANGLES) -> Scene:
    """A scene light enough for a browser, split by region; the scene itself where it is already.

    The robot never sees it: only people do.
    """
    if len(scene.triangles) <= triangles:
        return scene
    facts = f"{scene.sha256}/{triangles}/{LIGHT_VERSION}/{STORE_VERSION}"
    folder = cache / "display" / hashlib.sha256(facts.encode()).hexdigest()[:32]
    return _kept(folder, scene.name, lambda: lightened(scene, triangles=triangles), lambda: ())


def _is_whole(path: Path) -> bool:
    """False for a damaged file too: the loader says what is wrong with it."""
    try:
        return is_whole(path)
    except (OSError, ValueError, LookupError, AttributeError):
        return False


def _key(path: Path) -> str:
    """Content of the file with everything else that the loader goes by."""
    with path.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256")
    digest.update(f"/{path.suffix.lower()}/{is_photographed(path)}/{STORE_VERSION}".encode())
    return digest.hexdigest()[:32]


def _kept(
    folder: Path,
    name: str,
    make: Callable[[], Scene],
    pictures: Callable[[], Iterable[bytes]],
) -> Scene:
    """Open a kept scene, or make and keep it; a cache that cannot be written is done without."""
    if (folder / FACTS).is_file():
        try:
            return open_scene(folder, name=name)
        except ValueError as error:
            log.warning("a cached scene is made again: %s", error)
    scene = make()
    # Two workers may make the same one: each writes its own folder, the first rename wins.
    part = folder.with_name(f"{folder.name}.{os.getpid()}.part")
    try:
        save_scene(part, scene, pictures=pictures())
        if folder.exists():
            shutil.rmtree(folder)
        part.rename(folder)
    except OSError as error:
        log.warning("scene %s is not cached: %s", name, error)
    finally:
        shutil.rmtree(part, ignore_errors=True)
    return scene
