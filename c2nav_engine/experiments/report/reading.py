"""Run folders as a report needs them: manifest, rows, and where the traces lie."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.asking import asking_from
from c2nav_engine.experiments.columns import Row, read_rows
from c2nav_engine.experiments.rankers import RANKERS

_USUAL = {"odometry_noise": 0.0, "depth_noise": 0.0, "sliding": True, "parser": "english"}


@dataclass(frozen=True, slots=True)
class Protocol:
    """What two runs must share before their figures may stand in one table.

    Attributes:
        source: Name of the episode source.
        source_sha256: Its content.
        headings: Heading version of the starts.
        ground_truth: Name of the nDTW reference.
        profile: Embodiment profile.
        sensing: Noise, sliding and parser where they differ from the default, as words.
    """

    source: str
    source_sha256: str
    headings: str
    ground_truth: str
    profile: str
    sensing: str

    @property
    def words(self) -> str:
        """For a heading."""
        parts = (self.source, f"headings {self.headings}", f"profile {self.profile}", self.sensing)
        return " · ".join(part for part in parts if part)


@dataclass(frozen=True, slots=True)
class Run:
    """One run folder.

    Attributes:
        folder: Where it lies.
        manifest: Its `manifest.json`.
        rows: Its `episodes.parquet`.
        protocol: What it was measured under.
        ranker: Ranker name with model id.
        options: The ranker's options, but for how widely it asks.
        privileged: Whether the ranker knows the truth.
        configs: Variant → hash of its config.
    """

    folder: Path
    manifest: Mapping[str, Any]
    rows: tuple[Row, ...]
    protocol: Protocol
    ranker: str
    options: Mapping[str, str]
    privileged: bool
    configs: Mapping[str, str]


def read_run(folder: Path) -> Run:
    """Read a run folder; raises `UsageError` where it is none."""
    path = folder / "manifest.json"
    if path.is_file() and not (folder / "episodes.parquet").is_file():
        message = (
            f"expected a run that wrote its tables, came {folder}, which goes on or was killed; "
            f"finish it with `c2nav run SOURCE --out {folder} --resume` and the options of before"
        )
        raise UsageError(message)
    if not path.is_file() or not (folder / "episodes.parquet").is_file():
        message = (
            f"expected a run folder with manifest.json and episodes.parquet, came {folder}; "
            "make one with `c2nav run SOURCE --out RUN`"
        )
        raise UsageError(message)
    try:
        manifest = cast("dict[str, Any]", json.loads(path.read_text(encoding="utf-8")))
        rows = tuple(read_rows(folder))
        return _run(folder, manifest, rows)
    except (ValueError, KeyError, TypeError, OSError) as error:
        message = f"expected a manifest of this version at {path}, came: {error!r}; run it again"
        raise UsageError(message) from error


def _run(folder: Path, manifest: dict[str, Any], rows: tuple[Row, ...]) -> Run:
    setting = cast("dict[str, Any]", manifest["spec"]["setting"])
    name = str(manifest["ranker"])
    # The variant `random` answers for itself whatever ranker is named.
    named = [str(row["ranker"]) for row in rows if row["variant"] != "random"]
    entry = RANKERS.get(name)
    return Run(
        folder=folder,
        manifest=manifest,
        rows=rows,
        protocol=Protocol(
            source=str(manifest["source"]),
            source_sha256=str(manifest["source_sha256"]),
            headings=str(manifest["headings"]),
            ground_truth=str(manifest["ground_truth"]),
            profile=str(manifest["profile"]["name"]),
            sensing=_sensing(setting),
        ),
        ranker=named[0] if named else name,
        options=asking_from(manifest["ranker_options"])[1],
        privileged=bool(manifest.get("privileged", entry is not None and entry.privileged)),
        configs={variant: str(facts["sha256"]) for variant, facts in manifest["variants"].items()},
    )


def _sensing(setting: Mapping[str, Any]) -> str:
    odd = [name for name, usual in _USUAL.items() if setting.get(name, usual) != usual]
    return ", ".join(f"{name.replace('_', ' ')} {setting[name]}" for name in odd)
