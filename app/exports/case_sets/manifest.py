"""`manifest.json` of an exported set: what is in it, with the digest of every file."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

from pydantic import BaseModel, ConfigDict, ValidationError

from c2nav_engine.errors import InputError

FILE = "manifest.json"
SCHEMA = 1


class Member(BaseModel):
    """One case.

    Attributes:
        file: Its trace below the folder.
        trace_sha256: Digest of that trace: what the index knows it by.
        run: The run it came from.
        caption: What the set says of it.
        marks: Manual tags.
        tags: Automatic tags that held.
        licence: Of the scene's pictures, which the trace holds.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    file: str
    trace_sha256: str
    run: str
    caption: str
    marks: tuple[str, ...]
    tags: tuple[str, ...]
    licence: str


class Manifest(BaseModel):
    """As it stands in the file.

    Attributes:
        c2nav_case_set: Schema version.
        name: Of the set.
        note: What it is about.
        made_with: Version of this program.
        cases: In order.
        files: Path below the folder → digest, of every other file.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    c2nav_case_set: int = SCHEMA
    name: str
    note: str
    made_with: str
    cases: tuple[Member, ...]
    files: dict[str, str]

    def write(self, folder: Path) -> None:
        """Write it beside what it names."""
        text = json.dumps(self.model_dump(mode="json"), indent=1, ensure_ascii=False)
        (folder / FILE).write_text(text + "\n", encoding="utf-8")


def read_manifest(folder: Path) -> Manifest:
    """Read an exported set's manifest; raises `InputError` naming what is wrong."""
    path = folder / FILE
    try:
        manifest = Manifest.model_validate_json(path.read_bytes())
    except OSError as error:
        message = f"expected an exported set with {FILE} at {folder}, came: {error.strerror}"
        raise InputError(message) from error
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"]) or "the file"
        message = f"expected the manifest of a set in {path}; {where}: {first['msg']}"
        raise InputError(message) from error
    if manifest.c2nav_case_set != SCHEMA:
        message = f"expected a set of version {SCHEMA}, came {manifest.c2nav_case_set} in {path}"
        raise InputError(message)
    return manifest


def check_files(folder: Path, manifest: Manifest) -> None:
    """Raise `InputError` unless the folder holds every file as it was exported, and no other."""
    held = digests(folder)
    for name, sha256 in manifest.files.items():
        if held.get(name) != sha256:
            came = f"{held[name][:12]}…" if name in held else "no such file"
            message = f"expected {folder / name} with digest {sha256[:12]}…, came {came}"
            raise InputError(message)
    strange = sorted(held.keys() - manifest.files.keys())
    if strange:
        message = f"expected only what {FILE} names in {folder}, came {', '.join(strange[:5])}"
        raise InputError(message)
    if len({Path(case.file).name for case in manifest.cases}) < len(manifest.cases):
        message = f"expected every case of {folder} to have a file name of its own"
        raise InputError(message)
    for case in manifest.cases:
        if manifest.files.get(case.file) != case.trace_sha256:
            message = f"expected {case.file} to be trace {case.trace_sha256[:12]}…; it is another"
            raise InputError(message)


def digests(folder: Path) -> dict[str, str]:
    """Path below a folder → digest, of every file but the manifest."""
    return {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path != folder / FILE
    }
