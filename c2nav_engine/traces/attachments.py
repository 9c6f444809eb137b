"""The files inside a trace: who drove where, with which words, and a layout for Foxglove."""

from __future__ import annotations

import json
from dataclasses import dataclass
from importlib.resources import files

from pydantic import TypeAdapter, ValidationError

from c2nav_engine.episodes.episode import Episode
from c2nav_engine.episodes.profile import Profile
from c2nav_engine.errors import TraceError
from c2nav_engine.traces.reader import TraceFile

HEADER_FILE = "header.json"
CONFIG_FILE = "config.json"
EPISODE_FILE = "episode.json"
LAYOUT_FILE = "foxglove-layout.json"
TEMPLATE_FOLDER = "templates/"


@dataclass(frozen=True, slots=True)
class Task:
    """What an export tells of the run beside its messages."""

    episode: Episode
    legs: tuple[str, ...]
    profile: Profile


_TASK = TypeAdapter(Task)


def task_of(trace: TraceFile) -> Task:
    """The task that a trace records; raises `TraceError` naming a wrong field."""
    try:
        plain = json.loads(trace.attachment(HEADER_FILE))
        plain["episode"] = json.loads(trace.attachment(EPISODE_FILE))
        return _TASK.validate_python(plain)
    except (ValueError, ValidationError) as error:
        message = f"expected an episode and a profile attached to {trace.path}, came {error}"
        raise TraceError(message) from error


def foxglove_layout() -> bytes:
    """A layout for Foxglove: import it from the layouts menu, or take it out of the trace."""
    return (files("c2nav_engine.traces") / "foxglove_layout.json").read_bytes()
