"""What a run says about itself, apart from its exchanges."""

from __future__ import annotations

import enum
from collections.abc import Mapping
from dataclasses import dataclass, field

from c2nav_engine.episodes.episode import Episode
from c2nav_engine.episodes.profile import Profile


class EpisodeOutcome(enum.StrEnum):
    """How an episode ended; only `stopped` is a stop."""

    STOPPED = "stopped"
    STEP_LIMIT = "step_limit"
    STALLED = "stalled"
    ERROR = "error"
    INTERRUPTED = "interrupted"


@dataclass(frozen=True, slots=True)
class Header:
    """Everything known before the first request.

    Attributes:
        run: Run name.
        episode: The task.
        legs: Route ladder as parsed (K ≥ 1).
        parser: Which parser made the legs, with "fallback: why" where the first choice failed.
        profile: Body and cameras.
        variant: Preset name.
        config: Full config of the loop as plain JSON values.
        config_sha256: Hash of that config.
        ranker: Name with model id.
        ranker_options: Options, keys of services excluded.
        privileged: Whether the ranker knows the truth.
        seed: Run seed.
        surface: "navmesh" or "built".
        headings: Which heading version the starts have.
        scene_licence: Licence of the scene's pictures ("" when unknown).
        code_version: Package version and commit where known.
        parent_sha256: Trace this one was forked from ("" when none).
        fork_decision: Decision at which it left its parent (−1 when none).
        templates: Prompt template id → text.
        extra: More facts, name → text.
    """

    run: str
    episode: Episode
    legs: tuple[str, ...]
    parser: str
    profile: Profile
    variant: str
    config: Mapping[str, object]
    config_sha256: str
    ranker: str
    seed: int
    ranker_options: Mapping[str, str] = field(default_factory=dict[str, str])
    privileged: bool = False
    surface: str = ""
    headings: str = ""
    scene_licence: str = ""
    code_version: str = ""
    parent_sha256: str = ""
    fork_decision: int = -1
    templates: Mapping[str, str] = field(default_factory=dict[str, str])
    extra: Mapping[str, str] = field(default_factory=dict[str, str])


@dataclass(frozen=True, slots=True)
class Footer:
    """Everything known after the last request.

    Attributes:
        outcome: How it ended.
        metrics: Measuring columns of `episodes.csv` (ne_m, os, success, …); missing is None.
        error: The error's text when the outcome is `error`.
    """

    outcome: EpisodeOutcome
    metrics: Mapping[str, float | int | None]
    error: str = ""
