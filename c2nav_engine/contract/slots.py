"""One function per decision slot: the controller's pictures in, a `Question` out.

Faculties call these, so that all words a model reads live in `templates/` and `wording`.
The role inversions take a slot's question and change the answer form, nothing else.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from c2nav_engine.contract.outcome import Key
from c2nav_engine.contract.question import Alternative, Form, Orders, Picture, Question, Slot
from c2nav_engine.contract.wording import heading_caption, template_of, text_of
from c2nav_engine.errors import InternalError


@dataclass(frozen=True, slots=True)
class Route:
    """What every question says about the route.

    Attributes:
        instruction: The whole instruction, verbatim.
        legs: The route ladder, verbatim.
        leg: Index of the active leg.
        sketch: Nonmetric rendering of the sketch ("" in variants without it).
    """

    instruction: str
    legs: tuple[str, ...]
    leg: int
    sketch: str = ""


def seeing(
    route: Route, views: Mapping[Key, Picture], *, seed: int, orders: Orders = Orders.ONCE
) -> Question:
    """Gaze Election over the surviving views of the fan."""
    return _ask(route, Slot.SEEING, _pictured(Slot.SEEING, views), seed=seed, orders=orders)


def glance(route: Route, sectors: Mapping[Key, Picture], *, seed: int) -> Question:
    """Junction Glance over the surviving sectors of the ring."""
    return _ask(route, Slot.GLANCE, _pictured(Slot.GLANCE, sectors), seed=seed, orders=Orders.ONCE)


def transition(
    route: Route, view: Picture, *, seed: int, earlier: Sequence[Picture] = ()
) -> Question:
    """H_stay against H_next, on the current view and the sketch's thumbnails, oldest first.

    Raises `InternalError` in the last leg, which has no next.
    """
    if route.leg + 1 >= len(route.legs):
        message = f"expected a leg before the last of {len(route.legs)}, came index {route.leg}"
        raise InternalError(message)
    hypotheses = (
        Alternative("stay", text_of(Slot.TRANSITION, "stay", quote=route.legs[route.leg])),
        Alternative("next", text_of(Slot.TRANSITION, "next", quote=route.legs[route.leg + 1])),
    )
    return _ask(route, Slot.TRANSITION, hypotheses, seed=seed, context=_seen(view, earlier))


def ground(route: Route, view: Picture, *, seed: int) -> Question:
    """Arriving's first level: is the last leg's place here, or still ahead."""
    return _ask(
        route,
        Slot.GROUND,
        _statements(Slot.GROUND, "here", "ahead"),
        seed=seed,
        context=_seen(view, ()),
    )


def journey(route: Route, view: Picture, *, seed: int, earlier: Sequence[Picture] = ()) -> Question:
    """Arriving's second level: does the recorded journey cover the route."""
    statements = _statements(Slot.JOURNEY, "covered", "missing")
    return _ask(route, Slot.JOURNEY, statements, seed=seed, context=_seen(view, earlier))


def lookback(route: Route, *, now: Picture, back: Picture, seed: int) -> Question:
    """Arriving's third level: the current frame against one from behind; no words tell which."""
    frames = (Alternative("now", picture=now), Alternative("back", picture=back))
    return _ask(route, Slot.LOOKBACK, frames, seed=seed)


def direct(route: Route, view: Picture, *, seed: int) -> Question:
    """Direct action from the front view, for variants without Seeing."""
    actions = _statements(Slot.DIRECT, "forward", "left", "right")
    question = _ask(
        route, Slot.DIRECT, actions, seed=seed, orders=Orders.ONCE, context=_seen(view, ())
    )
    return replace(question, form=Form.ACTION)


def spatial_cardinal(question: Question, headings_deg: Mapping[Key, float]) -> Question:
    """Role inversion of `seeing` or `glance`: the same pictures, captioned; degrees wanted.

    Args:
        question: The slot's ordinal question.
        headings_deg: Key → heading of the picture's middle, degrees, left positive.
    """
    captioned = tuple(
        replace(alternative, caption=heading_caption(headings_deg[alternative.key]))
        for alternative in question.alternatives
    )
    return replace(_inverted(question, Form.DEGREES), alternatives=captioned)


def transition_cardinal(question: Question) -> Question:
    """Role inversion of `transition`: the same pictures and text; progress 0–100 wanted."""
    return _inverted(question, Form.PROGRESS)


def terminal_absolute(question: Question) -> Question:
    """Role inversion of `ground`: the same view; yes or no wanted."""
    return _inverted(question, Form.YES_NO)


def _ask(
    route: Route,
    slot: Slot,
    alternatives: tuple[Alternative, ...],
    *,
    seed: int,
    orders: Orders = Orders.BOTH,
    context: tuple[tuple[str, Picture], ...] = (),
) -> Question:
    return Question(
        slot=slot,
        form=Form.ORDINAL,
        orders=orders,
        instruction=route.instruction,
        legs=route.legs,
        leg=route.leg,
        alternatives=alternatives,
        shuffle_seed=seed,
        template=template_of(slot),
        sketch=route.sketch,
        context=context,
    )


def _inverted(question: Question, form: Form) -> Question:
    # A cardinal form has no order to swap and is asked once.
    return replace(
        question, form=form, orders=Orders.ONCE, template=template_of(question.slot, form)
    )


def _statements(slot: Slot, *keys: Key) -> tuple[Alternative, ...]:
    return tuple(Alternative(key, text_of(slot, key)) for key in keys)


def _pictured(slot: Slot, pictures: Mapping[Key, Picture]) -> tuple[Alternative, ...]:
    return tuple(Alternative(key, text_of(slot, key), picture) for key, picture in pictures.items())


def _seen(view: Picture, earlier: Sequence[Picture]) -> tuple[tuple[str, Picture], ...]:
    return (*(("earlier", picture) for picture in earlier), ("now", view))
