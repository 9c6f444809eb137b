"""Every word of ours that is no template: the texts of alternatives, captions and marked spans.

All of it is ordinal or plain; the captions of the spatial inversion are the one exception, and
the prompt lint exempts that form by name.
"""

from __future__ import annotations

from collections.abc import Mapping

from c2nav_engine.contract.outcome import Key

SIDES: Mapping[Key, str] = {
    "left": "to the left",
    "front": "ahead",
    "right": "to the right",
    "sector0": "ahead and to the left",
    "sector1": "to the left",
    "sector2": "behind, to the left",
    "sector3": "behind, to the right",
    "sector4": "to the right",
    "sector5": "ahead and to the right",
}
"""Where a view lies from the body, in ordinal words: an instruction says "turn left", and the
seeded shuffle hides which view that is. Sector k joins the ring views at 60k° and 60k + 30°."""

ACTIONS: Mapping[Key, str] = {
    "forward": "go forward",
    "left": "turn left, then go forward",
    "right": "turn right, then go forward",
}
HERE = "The place that the last part of the route describes is here."
AHEAD = "The place that the last part of the route describes is still ahead."
COVERED = "The recorded journey covers the whole route."
MISSING = "Part of the route is still missing from the recorded journey."

CURRENT_VIEW = "What the robot sees now:"
EARLIER_VIEW = "An earlier view, recorded on the way:"
SKETCH_HEADING = "What the robot has done so far, by its own record:"


def instruction_span(instruction: str) -> str:
    """The instruction, verbatim, in the span that the lint skips."""
    return f"<instruction>{instruction}</instruction>"


def leg_span(leg: str) -> str:
    """One leg, verbatim, in the span that the lint skips."""
    return f"<leg>{leg}</leg>"


def sketch_block(sketch: str) -> str:
    """The sketch's words under their heading, or nothing in variants without a sketch."""
    return f"{SKETCH_HEADING}\n{sketch}" if sketch else ""


def stay(leg: str) -> str:
    """H_stay of the transition contrast (paper, eq. 5)."""
    return f"The robot is still on the part to follow now: {leg_span(leg)}"


def next_leg(leg: str) -> str:
    """H_next of the transition contrast (paper, eq. 5)."""
    return f"The robot has finished that part, and the next part has begun: {leg_span(leg)}"


def heading_caption(heading_deg: float) -> str:
    """Caption of one picture in the spatial inversion; degrees, left positive."""
    return f"heading {round(heading_deg):+d} degrees" if round(heading_deg) else "heading 0 degrees"
