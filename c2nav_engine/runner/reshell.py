"""The shell of a recorded run, made again from its header and the scene."""

from __future__ import annotations

from pathlib import Path

from c2nav_engine.episodes.files import EpisodeFile
from c2nav_engine.runner.opening import goal_field_of, noise_of, sensors_of, start_on
from c2nav_engine.runner.record import Header
from c2nav_engine.runner.shell import LiveShell
from c2nav_engine.runner.source import Source
from c2nav_engine.runner.worlds import Worlds, WorldsConfig


def source_of_record(header: Header, scenes: Path | None) -> Source:
    """A source that holds the recorded episode alone."""
    file = EpisodeFile("trace", (header.episode,), "", header.headings)
    return Source(file, scenes, {}, "reference path")


def shell_of(header: Header, *, scenes: Path | None) -> LiveShell:
    """A live shell at the recorded start; raises `SceneError` where the scene is not to be had."""
    worlds = Worlds(source_of_record(header, scenes), WorldsConfig(header.profile))
    world = worlds.of(header.episode.scene_id)
    field = goal_field_of(world, header.episode)
    return LiveShell(
        start=start_on(world, header.episode),
        surface=world.surface,
        renderer=world.renderer,
        profile=header.profile,
        goal_distance=None if field is None else field.distance_m,
        sensors=sensors_of(
            noise_of(header), seed=header.seed, episode_id=header.episode.episode_id
        ),
    )
