"""A trace as a film: plain H.264 in MP4, which plays everywhere."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from types import TracebackType
from typing import Any

import av
import numpy as np
from jaxtyping import UInt8

from c2nav_engine.errors import UsageError
from c2nav_engine.geometry import Point
from c2nav_engine.traces.attachments import Task, task_of
from c2nav_engine.traces.exports.board import Boards
from c2nav_engine.traces.exports.drawing import Easel
from c2nav_engine.traces.moments import moments
from c2nav_engine.traces.reader import TraceFile


@dataclass(frozen=True, slots=True)
class VideoStyle:
    """How the film looks [C].

    Attributes:
        width_px: Columns; even.
        height_px: Rows; even.
        frames_per_s: A low-level step lasts a quarter of a second, a decision 1.25 s.
        quality: x264's constant rate factor; lower is better and larger.
    """

    width_px: int = 1280
    height_px: int = 720
    frames_per_s: int = 4
    quality: int = 23


def export_video(trace: TraceFile, out: Path, *, style: VideoStyle | None = None) -> int:
    """Write views, map and decision words as MP4; returns the number of frames.

    Raises:
        UsageError: The film is too small to read, or of an odd size.
    """
    style = style or VideoStyle()
    if style.width_px % 2 or style.height_px % 2 or style.width_px < 640 or style.height_px < 360:
        message = (
            "expected an even size of at least 640 × 360, came "
            f"{style.width_px} × {style.height_px}"
        )
        raise UsageError(message)
    easel = _easel(trace, style)
    with _Film(out, style) as film:
        for board in Boards(trace, easel.task):
            frames = round(board.hold_s * style.frames_per_s)
            if frames:
                film.show(easel.draw(board), frames=frames)
    return film.count


class _Film:
    """An MP4 under construction; the one class that meets PyAV, whose types are partial."""

    def __init__(self, out: Path, style: VideoStyle) -> None:
        self.count = 0
        options = {"movflags": "faststart"}
        self._container: Any = av.open(str(out), "w", format="mp4", options=options)
        self._stream: Any = self._container.add_stream("libx264", rate=style.frames_per_s)
        self._stream.width, self._stream.height = style.width_px, style.height_px
        self._stream.pix_fmt = "yuv420p"
        self._stream.time_base = Fraction(1, style.frames_per_s)
        self._stream.options = {"crf": str(style.quality), "preset": "veryfast"}

    def show(self, rgb: UInt8[np.ndarray, "rows columns 3"], *, frames: int) -> None:
        """Show a picture for that many frames."""
        frame: Any = av.VideoFrame.from_ndarray(rgb, format="rgb24").reformat(format="yuv420p")
        for _ in range(frames):
            frame.pts = self.count
            self.count += 1
            self._container.mux(self._stream.encode(frame))

    def __enter__(self) -> _Film:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if error is None:
            self._container.mux(self._stream.encode(None))
        self._container.close()


def _easel(trace: TraceFile, style: VideoStyle) -> Easel:
    task = task_of(trace)
    poses = [pair for moment in moments(trace) for pair in moment.poses()]
    return Easel(
        width_px=style.width_px,
        height_px=style.height_px,
        task=task,
        bounds_m=_bounds_m(task, [pose.position_m for _, pose in poses]),
        steps=max((step for step, _ in poses), default=0),
        footer=_footer(trace),
    )


def _bounds_m(task: Task, visited_m: Iterable[Point]) -> tuple[float, float, float, float]:
    episode = task.episode
    points_m = [*visited_m, episode.start.position_m, *episode.reference_path_m]
    if episode.goal_m is not None:
        points_m.append(episode.goal_m)
    xs, zs = [point[0] for point in points_m], [point[2] for point in points_m]
    return min(xs) - 1.0, min(zs) - 1.0, max(xs) + 1.0, max(zs) + 1.0


def _footer(trace: TraceFile) -> str:
    facts = trace.facts
    ranker = f"{facts['ranker']}{' (knows the truth)' if facts['privileged'] == 'yes' else ''}"
    parts = [f"episode {facts['episode']}", facts["scene"], facts["variant"], ranker]
    if facts.get("outcome"):
        parts.append(facts["outcome"])
    if facts.get("licence"):
        parts.append(f"pictures: {facts['licence']}")
    return " · ".join(parts)
