"""The instruction as one text, cut where its legs begin and end."""

from __future__ import annotations

from typing import Any

from c2nav_engine.contract.route import leg_spans
from c2nav_engine.errors import C2NavError


def route_segments(instruction: str, legs: tuple[str, ...]) -> list[dict[str, Any]]:
    """Segments in reading order: text, and the leg it belongs to (None between legs).

    Legs that do not stand verbatim in the instruction are listed one after the other instead.
    """
    try:
        spans = leg_spans(instruction, legs)
    except (C2NavError, ValueError):
        return [{"text": leg, "leg": index} for index, leg in enumerate(legs)]
    segments: list[dict[str, Any]] = []
    done = 0
    for index, (start, stop) in enumerate(spans):
        if start > done:
            segments.append({"text": instruction[done:start], "leg": None})
        segments.append({"text": instruction[start:stop], "leg": index})
        done = stop
    if done < len(instruction):
        segments.append({"text": instruction[done:], "leg": None})
    return segments
