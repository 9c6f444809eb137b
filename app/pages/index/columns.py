"""The columns of the index: what is known of an episode at a glance."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from c2nav_engine.experiments.tags.rules import TAGS

Value = str | int | float | None

TEXTS = (
    "run",
    "episode_id",
    "trajectory_id",
    "scene_id",
    "variant",
    "ranker",
    "profile",
    "outcome",
    "ending",
    "trace_sha256",
    "parent_sha256",
    "config_sha256",
    "code_version",
)
"""Columns of words."""

COUNTS = (
    "seed",
    "privileged",
    "os",
    "success",
    "success_zero_shot",
    "steps",
    "collisions",
    "decisions",
    "queries",
    "invalid",
    "abstained",
    "fallbacks",
    "glances",
    "walkbacks",
    "tokens",
    "legs",
    "fork_decision",
    "shown",
    "truth",
)
"""Columns of whole numbers; `shown` is the decision of the thumbnail, `truth` whether the scene
was there when the tags were made."""

MEASURES = (
    "ne_m",
    "spl",
    "ndtw",
    "sdtw",
    "path_length_m",
    "latency_s",
    "least_goal_m",
)
"""Columns of real numbers."""

COLUMNS: Mapping[str, str] = {
    **dict.fromkeys(TAGS, "integer"),
    **dict.fromkeys(MEASURES, "real"),
    **dict.fromkeys(COUNTS, "integer"),
    **dict.fromkeys(TEXTS, "text"),
}
"""Every column with its SQL type. A tag is 1, 0, or null where it is unknown. What is counted on
every page stands first: SQLite reads a row up to the last column that it needs."""


@dataclass(frozen=True, slots=True)
class Row:
    """One episode of the index.

    Attributes:
        path: Where its trace lies, or should, below the folder; with `/` on every system.
        values: By column; missing is None.
        instruction: What the robot was told.
        error: Why it failed, for an episode that ended in an error.
        drawing: Its way from above, as JSON (`drawing.drawing_of`); "" without a trace.
        health: Counts of its answers, as JSON (`experiments.health`); "" without a trace.
    """

    path: str
    values: Mapping[str, Value]
    instruction: str = ""
    error: str = ""
    drawing: str = field(default="", repr=False)
    health: str = field(default="", repr=False)

    @property
    def sha256(self) -> str:
        """Digest of the trace: what marks and sets know the episode by; "" without one."""
        return str(self.values.get("trace_sha256") or "")
