"""The start-up probe: two solid-colour pictures, so that a long run does not begin blind.

It checks that the server takes several images and these parameters, that it enforces the answer's
schema, and that the model tells red from blue. It warns and changes nothing; a rejected key, an
exhausted quota and a refused connection stop the run from inside `send`.
"""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np

from c2nav_engine.contract.outcome import TransportFailure
from c2nav_engine.contract.prompt import Part, Reply
from c2nav_engine.contract.question import Picture
from c2nav_engine.contract.schemas import Schema

_SIDE_PX = 64
_CHOICES = ("A > B", "B > A")

Send = Callable[[tuple[Part, ...], Schema], Reply]


def probe(send: Send) -> tuple[str, ...]:
    """Ask which of two pictures is red; returns one warning per thing that looks wrong."""
    schema: Schema = {
        "type": "object",
        "properties": {"ranking": {"type": "string", "enum": list(_CHOICES)}},
        "required": ["ranking"],
        "additionalProperties": False,
    }
    reply = send(_parts(), schema)
    if isinstance(reply.outcome, TransportFailure):
        return (f"the probe got no answer: {reply.outcome.reason}",)
    if reply.outcome is not None:
        return (f"the probe's answer was {type(reply.outcome).__name__.lower()}: {reply.text!r}",)
    return tuple(_doubts(reply))


def _doubts(reply: Reply) -> list[str]:
    said = reply.text.strip()
    doubts: list[str] = []
    if not (said.startswith("{") and any(choice in said for choice in _CHOICES)):
        doubts.append(
            f"the server does not enforce the answer's JSON schema; it said {said[:80]!r}"
        )
    if "A > B" in said:
        doubts.append("the model did not tell a red picture from a blue one")
    if reply.tokens_in is None:
        doubts.append("the server reports no token usage")
    return doubts


def _parts() -> tuple[Part, ...]:
    return (
        "Two pictures.\n\nView A:\n",
        _solid(blue=200, red=30),
        "\nView B:\n",
        _solid(blue=30, red=200),
        '\n\nRank the views by how red they are. Answer with one line, "A > B" or "B > A".',
    )


def _solid(*, blue: int, red: int) -> Picture:
    bgr = np.full((_SIDE_PX, _SIDE_PX, 3), (blue, 30, red), np.uint8)
    jpeg = cv2.imencode(".jpg", bgr)[1].tobytes()
    return Picture.of(jpeg, width_px=_SIDE_PX, height_px=_SIDE_PX)
