"""Every word of ours that is no template: the texts of alternatives, captions and marked spans.

Faculties name a slot and a key and receive the words, so that all wording stands here and in
`templates/`. It is ordinal or plain; the captions of the spatial inversion are the one exception,
and the prompt lint exempts that form by name.
"""

from __future__ import annotations

from collections.abc import Mapping

from c2nav_engine.contract.outcome import Key
from c2nav_engine.contract.question import Form, Slot
from c2nav_engine.errors import InternalError

_SIDES: Mapping[Key, str] = {
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

_TEXTS: Mapping[tuple[Slot, Key], str] = {
    (Slot.TRANSITION, "stay"): "The robot is still on the part to follow now: {quote}",
    (Slot.TRANSITION, "next"): (
        "The robot has finished that part, and the next part has begun: {quote}"
    ),
    (Slot.GROUND, "here"): "The place that the last part of the route describes is here.",
    (Slot.GROUND, "ahead"): "The place that the last part of the route describes is still ahead.",
    (Slot.JOURNEY, "covered"): "The recorded journey covers the whole route.",
    (Slot.JOURNEY, "missing"): "Part of the route is still missing from the recorded journey.",
    # No words tell the two frames apart: the comparison is between pictures alone.
    (Slot.LOOKBACK, "now"): "",
    (Slot.LOOKBACK, "back"): "",
    (Slot.DIRECT, "forward"): "go forward",
    (Slot.DIRECT, "left"): "turn left, then go forward",
    (Slot.DIRECT, "right"): "turn right, then go forward",
    **{(Slot.SEEING, key): _SIDES[key] for key in ("left", "front", "right")},
    **{(Slot.GLANCE, key): words for key, words in _SIDES.items() if key.startswith("sector")},
}

_INVERSIONS: Mapping[tuple[Slot, Form], str] = {
    (Slot.SEEING, Form.DEGREES): "spatial-cardinal/1",
    (Slot.GLANCE, Form.DEGREES): "glance-cardinal/1",
    (Slot.TRANSITION, Form.PROGRESS): "transition-cardinal/1",
    (Slot.GROUND, Form.YES_NO): "terminal-absolute/1",
}

_CONTEXT: Mapping[str, str] = {
    "now": "What the robot sees now:",
    "earlier": "An earlier view, recorded on the way:",
}

_SKETCH_HEADING = "What the robot has done so far, by its own record:"


def template_of(slot: Slot, form: Form = Form.ORDINAL) -> str:
    """Id of the template that puts this slot in this form."""
    if form in {Form.ORDINAL, Form.ACTION}:
        return f"{slot.value}/1"
    template = _INVERSIONS.get((slot, form))
    if template is None:
        message = f"expected an inverted slot for the form {form.value}, came {slot.value}"
        raise InternalError(message)
    return template


def text_of(slot: Slot, key: Key, *, quote: str = "") -> str:
    """Words of one alternative; "" where its picture is everything.

    Args:
        slot: Which decision.
        key: Which alternative.
        quote: The leg that a Transition hypothesis is about, verbatim.
    """
    text = _TEXTS.get((slot, key))
    if text is None:
        message = f"expected an alternative of {slot.value}, came {key!r}"
        raise InternalError(message)
    return text.replace("{quote}", leg_span(quote))


def context_words(name: str) -> str:
    """What introduces a shared picture: "now", "earlier", or words of the caller's own."""
    return _CONTEXT.get(name, name)


def instruction_span(instruction: str) -> str:
    """The instruction, verbatim, in the span that the lint skips."""
    return f"<instruction>{instruction}</instruction>"


def leg_span(leg: str) -> str:
    """One leg, verbatim, in the span that the lint skips."""
    return f"<leg>{leg}</leg>"


def sketch_block(sketch: str) -> str:
    """The sketch's words under their heading, or nothing in variants without a sketch."""
    return f"{_SKETCH_HEADING}\n{sketch}" if sketch else ""


def heading_caption(heading_deg: float) -> str:
    """Caption of one picture in the spatial inversion; degrees, left positive."""
    rounded = round(heading_deg)
    return f"heading {rounded:+d} degrees" if rounded else "heading 0 degrees"
