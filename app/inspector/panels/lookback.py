"""The look-back pair of the newest look-back question: both frames, both orders, both answers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import viser
from jaxtyping import UInt8

from app.inspector import markup as m
from app.inspector.panels.answers import answers_table
from app.inspector.panels.protocol import Dispatch, Html, Update
from app.inspector.scene.thumbnails import lettered, pixels
from app.session.decisions import Decision
from app.session.snapshot import Snapshot
from c2nav_engine.contract.question import Picture, Slot

_HEAD_PX, _GAP_PX = 26, 8
"""Room for the letters above the frames, and between the frames."""

_EMPTY = np.full((1, 1, 3), 255, np.uint8)


def build(gui: viser.GuiApi, _dispatch: Dispatch) -> Update:
    """Build the panel."""
    gui.add_html("<image-pair></image-pair>")
    words = Html(gui)
    with gui.add_folder("As one picture", expand_by_default=False):
        twin = gui.add_image(_EMPTY, format="jpeg", visible=False)
    shown: list[str] = []

    def update(snapshot: Snapshot) -> None:
        words.show(_words(snapshot))
        pictures = _pictures(snapshot)
        digests = [picture.sha256 for _, picture in pictures]
        if digests != shown:
            shown[:] = digests
            twin.visible = bool(pictures)
            twin.image = side_by_side(pictures) if pictures else _EMPTY

    return update


def _pictures(snapshot: Snapshot) -> list[tuple[str, Picture]]:
    """Letter and frame, in the recorded order; none before the first look-back."""
    decision = lookback_in_view(snapshot)
    if decision is None or decision.question is None:
        return []
    found = [
        (decision.letters.get(alternative.key, ""), alternative.picture)
        for alternative in decision.question.alternatives
        if alternative.picture is not None
    ]
    return sorted(found, key=lambda pair: pair[0])


def side_by_side(pictures: Sequence[tuple[str, Picture]]) -> UInt8[np.ndarray, "rows columns 3"]:
    """Frames in one row on white, each under its letter; uncropped, at their own size."""
    frames = [(letter, pixels(picture)) for letter, picture in pictures]
    rows = max(len(frame) for _, frame in frames) + _HEAD_PX
    parts: list[UInt8[np.ndarray, "rows columns 3"]] = []
    for letter, frame in frames:
        part = np.full((rows, frame.shape[1] + _GAP_PX, 3), 255, np.uint8)
        part[_HEAD_PX : _HEAD_PX + len(frame), : frame.shape[1]] = frame
        parts.append(lettered(part, letter))
    return np.concatenate(parts, axis=1)[:, :-_GAP_PX]


def lookback_in_view(snapshot: Snapshot) -> Decision | None:
    """The newest look-back question at or before the decision in view."""
    number = snapshot.here.decision
    for decision in reversed(snapshot.story.decisions[: number + 1]):
        if decision.slot is Slot.LOOKBACK:
            return decision
    return None


def _words(snapshot: Snapshot) -> str:
    decision = lookback_in_view(snapshot)
    if decision is None:
        return m.padded(
            m.note(
                "No look-back yet: it is asked in the last leg, when ground and journey leave "
                "the evidence open"
            )
        )
    now = snapshot.decision
    if now is not None and now.number == decision.number:
        return m.padded(answers_table(snapshot))
    return m.padded(m.note(f"Asked at decision {decision.number}"))
