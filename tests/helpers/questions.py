"""Questions of every slot and form for tests, built as the faculties build them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import cv2
import numpy as np

from c2nav_engine.contract import wording
from c2nav_engine.contract.question import (
    Alternative,
    Form,
    Orders,
    Picture,
    Question,
    Slot,
)

INSTRUCTION = "Walk past the red sofa, turn left at the table and stop by the blue door."
LEGS = ("Walk past the red sofa", "turn left at the table", "stop by the blue door")

PAIRS: dict[Slot, tuple[str, ...]] = {
    Slot.TRANSITION: ("stay", "next"),
    Slot.GROUND: ("here", "ahead"),
    Slot.JOURNEY: ("covered", "missing"),
    Slot.LOOKBACK: ("now", "back"),
}
KEYS: dict[Slot, tuple[str, ...]] = {
    Slot.SEEING: ("left", "front", "right"),
    Slot.GLANCE: tuple(f"sector{index}" for index in range(6)),
    Slot.DIRECT: ("forward", "left", "right"),
    **PAIRS,
}


def flat_picture(red: int, green: int, blue: int, *, side_px: int = 32) -> Picture:
    """One colour all over."""
    return encoded(np.full((side_px, side_px, 3), (red, green, blue), np.uint8))


def encoded(rgb: np.ndarray) -> Picture:
    """JPEG of an RGB array."""
    _, data = cv2.imencode(".jpg", rgb[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, 92])
    return Picture.of(data.tobytes(), width_px=rgb.shape[1], height_px=rgb.shape[0])


GREY = flat_picture(128, 128, 128)


def question(
    slot: Slot = Slot.SEEING,
    *,
    form: Form | None = None,
    orders: Orders | None = None,
    seed: int = 7,
    leg: int | None = None,
    instruction: str = INSTRUCTION,
    legs: tuple[str, ...] = LEGS,
    sketch: str = "It went ahead a few steps, then turned left.",
    keys: tuple[str, ...] | None = None,
    pictures: Mapping[str, Picture] | None = None,
    now: Picture = GREY,
) -> Question:
    """A question of the slot; defaults are the slot's own."""
    keys = keys or KEYS[slot]
    form = form or (Form.ACTION if slot is Slot.DIRECT else Form.ORDINAL)
    if orders is None:
        both = slot in PAIRS and form is Form.ORDINAL
        orders = Orders.BOTH if both else Orders.ONCE
    if leg is None:
        last = slot in {Slot.GROUND, Slot.JOURNEY, Slot.LOOKBACK}
        leg = len(legs) - 1 if last else 0
    quotes = {"stay": legs[leg], "next": legs[min(leg + 1, len(legs) - 1)]}
    pictured = slot in {Slot.SEEING, Slot.GLANCE, Slot.LOOKBACK}
    alternatives = tuple(
        Alternative(
            key,
            wording.text_of(slot, key, quote=quotes.get(key, "")),
            (pictures or {}).get(key, GREY) if pictured else None,
        )
        for key in keys
    )
    if form is Form.DEGREES:
        alternatives = tuple(
            replace(one, caption=wording.heading_caption(45.0 - 45.0 * index))
            for index, one in enumerate(alternatives)
        )
    earlier = (("earlier", GREY),) if slot in {Slot.TRANSITION, Slot.JOURNEY} else ()
    return Question(
        slot=slot,
        form=form,
        orders=orders,
        instruction=instruction,
        legs=legs,
        leg=leg,
        alternatives=alternatives,
        shuffle_seed=seed,
        template=wording.template_of(slot, form),
        sketch=sketch,
        context=() if pictured else (*earlier, ("now", now)),
    )


INVERSIONS = (
    (Slot.SEEING, Form.DEGREES),
    (Slot.GLANCE, Form.DEGREES),
    (Slot.TRANSITION, Form.PROGRESS),
    (Slot.GROUND, Form.YES_NO),
)


def every_question() -> list[Question]:
    """One of every slot, and of every inversion."""
    ordinal = [question(slot) for slot in Slot]
    return [*ordinal, *(question(slot, form=form) for slot, form in INVERSIONS)]
