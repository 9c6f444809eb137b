"""Taking an exported set back, on this machine or another."""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path

from app.exports.case_sets.manifest import Manifest, check_files, read_manifest
from app.pages.index import curation
from app.pages.library import Library
from c2nav_engine.errors import UsageError


@dataclass(frozen=True, slots=True)
class Unpacked:
    """A set that was taken in.

    Attributes:
        name: Of the set.
        folder: Its traces, as a run among others.
        cases: How many.
    """

    name: str
    folder: Path
    cases: int


def unpack_set(packed: Path, into: Path, *, scenes: Path | None = None) -> Unpacked:
    """Check an exported set by its hashes, and add its traces, set and marks to a folder of runs.

    Args:
        packed: The exported folder.
        into: The folder of runs, made when absent.
        scenes: Scenes folder, for the tags that need the truth.

    Raises:
        InputError: A file is missing, changed or strange.
        UsageError: The folder holds a run of that name already.
    """
    manifest = read_manifest(packed)
    curation.check_name(manifest.name, "a set")
    check_files(packed, manifest)
    target = into / manifest.name
    if target.exists():
        message = f"expected no run named {manifest.name!r} in {into}, but there is one"
        raise UsageError(message)
    into.mkdir(parents=True, exist_ok=True)
    part = into / f".{manifest.name}.part"
    shutil.rmtree(part, ignore_errors=True)
    (part / "traces").mkdir(parents=True)
    for case in manifest.cases:
        shutil.copyfile(packed / case.file, part / "traces" / Path(case.file).name)
    part.rename(target)
    _enter(manifest, into, scenes)
    return Unpacked(manifest.name, target, len(manifest.cases))


def _enter(manifest: Manifest, into: Path, scenes: Path | None) -> None:
    library = Library(into, scenes)
    try:
        library.refresh()
        store = library.store
        for case in manifest.cases:
            curation.put_in_set(store, manifest.name, case.trace_sha256, caption=case.caption)
            for tag in case.marks:
                curation.mark(store, case.trace_sha256, tag, on=True)
        curation.describe_set(store, manifest.name, manifest.note)
    finally:
        library.close()
