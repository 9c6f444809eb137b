"""Every adapter against the conformance kit, over every slot, form and presentation."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from c2nav_engine.contract.outcome import Ordering
from c2nav_engine.contract.prompt import Reply
from c2nav_engine.contract.question import Orders, Question, Slot
from c2nav_engine.rankers.conformance import NotConforming, check_adapter, check_same_again
from c2nav_engine.rankers.protocol import Adapter
from c2nav_engine.rankers.random_order import RandomOrder
from c2nav_engine.rankers.reference_cv import ReferenceCv
from c2nav_engine.rankers.scripted import Scripted
from tests.helpers.questions import every_question, question

QUESTIONS = [*every_question(), question(orders=Orders.CYCLIC)]
ADAPTERS: dict[str, Callable[[], Adapter]] = {
    "scripted": lambda: Scripted(lambda prompt: "A"),
    "scripted-nonsense": lambda: Scripted(lambda prompt: "Turn 35 degrees"),
    "scripted-lying": lambda: Scripted(lambda prompt: Ordering.of("elsewhere")),
    "random": lambda: RandomOrder(seed=1),
    "reference-cv": ReferenceCv,
}


@pytest.mark.parametrize("asked", QUESTIONS, ids=lambda q: f"{q.slot}-{q.form}-{q.orders}")
@pytest.mark.parametrize("name", ADAPTERS)
def test_an_adapter_conforms(name: str, asked: Question):
    check_adapter(ADAPTERS[name](), asked)
    check_same_again(ADAPTERS[name](), asked)


def test_the_kit_bites():
    both = Scripted(lambda prompt: Reply(text="A", outcome=Ordering.of("left", "front", "right")))
    with pytest.raises(NotConforming, match="not both"):
        check_adapter(both, question(Slot.SEEING))
    said = iter("ABCABCABC")
    with pytest.raises(NotConforming, match="same reply"):
        check_same_again(Scripted(lambda prompt: next(said)), question())
    with pytest.raises(NotConforming, match="name"):
        check_adapter(Scripted(lambda prompt: "A", name=" "), question())
