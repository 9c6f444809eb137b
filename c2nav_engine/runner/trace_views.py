"""What an exchange shows in other people's viewers, beside the message that records it."""

from __future__ import annotations

from c2nav_engine.contract.outcome import Cardinal, Ordering
from c2nav_engine.episodes.profile import Profile
from c2nav_engine.geometry import Pose
from c2nav_engine.navigator.requests import (
    Ask,
    Event,
    LadderState,
    Look,
    Move,
    Moved,
    Note,
    Seen,
    SketchState,
    Stop,
    Unasked,
)
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.traces.topics import log_time_ns
from c2nav_engine.traces.viewer_messages import (
    PATH_POSES,
    body_transform,
    calibration_message,
    camera_transforms,
    log_line,
    path_in_world,
    pose_in_world,
)
from c2nav_engine.traces.words import outcome_words
from c2nav_engine.traces.writer import Outgoing


class Views:
    """Poses, path and log lines as the episode goes on.

    True poses where the shell knows them, else odometry: these topics are for people.
    """

    def __init__(self, profile: Profile) -> None:
        self._profile = profile
        self._path: list[Pose] = []
        self._started = False

    def of(self, exchange: Exchange) -> list[Outgoing]:
        """Messages for `/pose`, `/tf`, `/path`, `/calibration` and `/log`."""
        return [*self._camera(exchange), *self._motion(exchange), *_log(exchange)]

    def _camera(self, exchange: Exchange) -> list[Outgoing]:
        if self._started:
            return []
        self._started = True
        time_ns = log_time_ns(exchange.step, exchange.index)
        calibration = calibration_message(self._profile, time_ns)
        transforms = camera_transforms(self._profile, time_ns)
        return [
            Outgoing("/calibration", calibration, time_ns),
            Outgoing("/tf", transforms, time_ns),
        ]

    def _motion(self, exchange: Exchange) -> list[Outgoing]:
        poses, first_step = _poses(exchange)
        messages: list[Outgoing] = []
        for place, pose in enumerate(poses):
            time_ns = log_time_ns(first_step + place, exchange.index)
            messages.append(Outgoing("/pose", pose_in_world(pose, time_ns), time_ns))
            messages.append(Outgoing("/tf", body_transform(pose, time_ns), time_ns))
        if poses:
            time_ns = log_time_ns(first_step + len(poses) - 1, exchange.index)
            if not self._path or isinstance(exchange.request, Move):
                self._path = [*self._path, *poses][-PATH_POSES:]
                messages.append(Outgoing("/path", path_in_world(self._path, time_ns), time_ns))
        return messages


def _poses(exchange: Exchange) -> tuple[tuple[Pose, ...], int]:
    """Poses of an exchange, and the step of the first of them."""
    known = exchange.truth.poses if exchange.truth else ()
    if isinstance(exchange.response, Seen):
        return known or (exchange.response.odometry,), exchange.step
    if isinstance(exchange.response, Moved):
        believed = tuple(step.odometry for step in exchange.response.steps)
        return known or believed, exchange.step + 1
    return (), exchange.step


def _log(exchange: Exchange) -> list[Outgoing]:
    line = log_text(exchange)
    if line is None:
        return []
    time_ns = log_time_ns(exchange.step, exchange.index)
    name, text, warning = line
    return [Outgoing("/log", log_line(name, text, time_ns=time_ns, warning=warning), time_ns)]


def log_text(exchange: Exchange) -> tuple[str, str, bool] | None:
    """(name, words, is it a warning) of what a person wants to read, or None."""
    request = exchange.request
    if isinstance(request, Ask):
        assert not isinstance(exchange.response, Seen | Moved) and exchange.response is not None
        words = outcome_words(exchange.response)
        by = "" if exchange.override is None else f" (by {exchange.override.who})"
        chosen = isinstance(exchange.response, Ordering | Cardinal)
        return request.facts.slot, f"decision {exchange.decision}: {words}{by}", not chosen
    if isinstance(request, Stop):
        return "stop", "STOP called", False
    if isinstance(request, Note):
        return _note_text(exchange, request)
    assert isinstance(request, Look | Move)
    return None


def _note_text(exchange: Exchange, note: Note) -> tuple[str, str, bool]:
    record = note.record
    if isinstance(record, Unasked):
        elected = f"{record.elected}, unasked" if record.elected else "nothing to elect"
        words = f"decision {exchange.decision}: {elected}"
        return record.facts.slot, words, record.elected is None
    if isinstance(record, SketchState):
        advanced = ", next leg" if record.advanced else ""
        return "sketch", f"{record.entry.words} ({record.entry.cue}{advanced})", False
    if isinstance(record, LadderState):
        evidence = f"({record.ground:+d}, {record.journey:+d}, {record.lookback:+d})"
        words = ", ".join([f"{evidence} {record.verdict}", *record.vetoes, record.event])
        return "ladder", words.removesuffix(", "), bool(record.vetoes)
    assert isinstance(record, Event)
    return "event", f"{record.name}: {record.detail}", record.name in ("fallback", "stalled")
