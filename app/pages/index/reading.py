"""A trace, or a task that never made one, as a row of the index."""

from __future__ import annotations

import math
from collections import OrderedDict
from pathlib import Path, PurePosixPath

from app.pages.index.columns import COLUMNS, Row, Value
from app.pages.index.drawing import drawing_of
from c2nav_engine.episodes.profile import Profile
from c2nav_engine.errors import C2NavError
from c2nav_engine.experiments.columns import Row as TaskRow
from c2nav_engine.experiments.health import health_of
from c2nav_engine.experiments.tags.account import Account
from c2nav_engine.experiments.tags.endings import Ending, ending_of
from c2nav_engine.experiments.tags.rules import tags_of
from c2nav_engine.experiments.truth import Course, course_of
from c2nav_engine.navigator.config import LoopConfig
from c2nav_engine.runner.opening import goal_field_of
from c2nav_engine.runner.record import Header
from c2nav_engine.runner.recorded import open_trace
from c2nav_engine.runner.reshell import source_of_record
from c2nav_engine.runner.worlds import Worlds, WorldsConfig

_KEPT_PROFILES = 2


class Courses:
    """The truth of recorded episodes, where their scenes are to be had.

    Args:
        scenes: Scenes folder; None for built-in houses alone.
    """

    def __init__(self, scenes: Path | None) -> None:
        self._scenes = scenes
        self._worlds: OrderedDict[Profile, Worlds] = OrderedDict()

    def of(self, header: Header) -> Course | None:
        """The course of an episode; None without its scene or a reachable goal."""
        try:
            world = self._of(header).of(header.episode.scene_id)
            return course_of(
                header.episode,
                start=header.episode.start,
                surface=world.surface,
                field=goal_field_of(world, header.episode),
                profile=header.profile,
                controller=LoopConfig.from_json(header.config).controller,
            )
        except C2NavError:
            return None

    def _of(self, header: Header) -> Worlds:
        found = self._worlds.get(header.profile)
        if found is None:
            source = source_of_record(header, self._scenes)
            found = self._worlds[header.profile] = Worlds(source, WorldsConfig(header.profile))
            while len(self._worlds) > _KEPT_PROFILES:
                self._worlds.popitem(last=False)
        return found


def row_of_trace(path: Path, *, name: str, run: str, courses: Courses) -> Row:
    """Read a finished trace.

    Args:
        path: The file.
        name: What the index calls it.
        run: Its run folder, as the index calls it.
        courses: Where the truth of its scene may be had.

    Raises:
        TraceError: It is unfinished or damaged.
    """
    with open_trace(path) as trace:
        header, footer = trace.header, trace.footer
        exchanges = tuple(trace.exchanges())
        sha256 = trace.sha256
    account = Account(header, footer, exchanges, courses.of(header))
    episode = header.episode
    tags = {tag: None if held is None else int(held) for tag, held in tags_of(account).items()}
    values: dict[str, Value] = {
        **{key: _stored(value) for key, value in footer.metrics.items() if key in COLUMNS},
        **tags,
        "run": run,
        "episode_id": episode.episode_id,
        "trajectory_id": episode.trajectory_id,
        "scene_id": episode.scene_id,
        "variant": header.variant,
        "ranker": header.ranker,
        "profile": header.profile.name,
        "outcome": footer.outcome.value,
        "ending": ending_of(account).value,
        "trace_sha256": sha256,
        "parent_sha256": header.parent_sha256,
        "config_sha256": header.config_sha256,
        "code_version": header.code_version,
        "seed": header.seed,
        "privileged": int(header.privileged),
        "legs": len(header.legs),
        "fork_decision": header.fork_decision if header.fork_decision >= 0 else None,
        "shown": _shown(account),
        "truth": int(account.course is not None),
        "least_goal_m": _stored(min(account.goal_distances_m, default=None)),
    }
    health = health_of(exchanges).as_json()
    return Row(name, values, episode.instruction, footer.error, drawing_of(account), health)


def row_of_task(name: str, row: TaskRow, *, run: str, error: str) -> Row:
    """A task of a ledger that left no trace: its episode or scene could not be opened."""
    known = {key: _stored(value) for key, value in row.items() if key in COLUMNS}
    missing: dict[str, Value] = {"run": run, "ending": Ending.ERROR.value, "trace_sha256": ""}
    return Row(name, {**known, **missing}, error=error)


def run_of(name: str) -> str:
    """The run folder of a trace, both below the folder: "." where it is the folder itself."""
    parent = PurePosixPath(name).parent
    return str(parent.parent if parent.name == "traces" else parent)


def _stored(value: str | float | int | None) -> Value:
    """SQLite keeps an infinity, but turns nan into null by itself: said here on purpose."""
    return None if isinstance(value, float) and math.isnan(value) else value


def _shown(account: Account) -> int | None:
    """The last decision with pictures: what the robot chose among at the end."""
    return next(
        (
            exchange.decision
            for exchange, ask in reversed(list(account.questions()))
            if any(candidate.picture for candidate in ask.facts.candidates)
        ),
        None,
    )
