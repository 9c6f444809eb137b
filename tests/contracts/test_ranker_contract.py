"""Every adapter against the conformance kit, over every slot, form and presentation."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from pytest_httpserver import HTTPServer

from c2nav_engine.contract.outcome import Answered, Ordering
from c2nav_engine.contract.prompt import Prompt, Reply
from c2nav_engine.contract.question import Orders, Question, Slot
from c2nav_engine.rankers.conformance import NotConforming, check_adapter, check_same_again
from c2nav_engine.rankers.human import HandOver, Human
from c2nav_engine.rankers.openai_chat import OpenAIChat
from c2nav_engine.rankers.openai_responses import OpenAIResponses
from c2nav_engine.rankers.protocol import Adapter
from c2nav_engine.rankers.random_order import RandomOrder
from c2nav_engine.rankers.reference_cv import ReferenceCv
from c2nav_engine.rankers.replay import Replay, recorded_replies
from c2nav_engine.rankers.scripted import Scripted
from c2nav_engine.rankers.wrapper import AskingRanker
from tests.helpers.model_server import completion, response
from tests.helpers.questions import every_question, question

QUESTIONS = [*every_question(), question(orders=Orders.CYCLIC)]


class Decided(HandOver):
    """A person who answers at once, always in the controller's order."""

    def ask(self, prompt: Prompt) -> Answered:
        return Ordering.of(*prompt.question.keys)


def replay() -> Replay:
    recorded = AskingRanker(RandomOrder(seed=2))
    return Replay(recorded_replies([recorded.rank(asked) for asked in QUESTIONS]))


ADAPTERS: dict[str, Callable[[], Adapter]] = {
    "scripted": lambda: Scripted(lambda prompt: "A"),
    "scripted-nonsense": lambda: Scripted(lambda prompt: "Turn 35 degrees"),
    "scripted-lying": lambda: Scripted(lambda prompt: Ordering.of("elsewhere")),
    "random": lambda: RandomOrder(seed=1),
    "reference-cv": ReferenceCv,
    "human": lambda: Human(Decided()),
    "replay": replay,
}


@pytest.mark.parametrize("asked", QUESTIONS, ids=lambda q: f"{q.slot}-{q.form}-{q.orders}")
@pytest.mark.parametrize("name", ADAPTERS)
def test_an_adapter_conforms(name: str, asked: Question):
    check_adapter(ADAPTERS[name](), asked)
    check_same_again(ADAPTERS[name](), asked)


@pytest.mark.parametrize("said", ["A", "A = B", "Turn 35 degrees", ""])
@pytest.mark.parametrize(
    ("adapter_type", "path", "answered"),
    [
        (OpenAIChat, "/v1/chat/completions", completion),
        (OpenAIResponses, "/v1/responses", response),
    ],
)
def test_a_served_model_conforms(httpserver: HTTPServer, adapter_type, path, answered, said: str):
    httpserver.expect_request(path).respond_with_json(answered(said))
    options = {"base_url": httpserver.url_for("/v1"), "model": "made-up", "probe": "false"}
    adapter = adapter_type.from_options(options)
    for asked in (question(), question(Slot.GROUND), question(orders=Orders.CYCLIC)):
        check_adapter(adapter, asked)
        check_same_again(adapter, asked)
    adapter.close()


def test_the_kit_bites():
    both = Scripted(lambda prompt: Reply(text="A", outcome=Ordering.of("left", "front", "right")))
    with pytest.raises(NotConforming, match="not both"):
        check_adapter(both, question(Slot.SEEING))
    said = iter("ABCABCABC")
    with pytest.raises(NotConforming, match="same reply"):
        check_same_again(Scripted(lambda prompt: next(said)), question())
    with pytest.raises(NotConforming, match="name"):
        check_adapter(Scripted(lambda prompt: "A", name=" "), question())
