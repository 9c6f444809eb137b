"""The ranker conformance kit: what every adapter must do, whatever answers behind it.

Ships with the engine so that an adapter written elsewhere is held to the same laws:

```
for question in questions:
    check_adapter(MyAdapter(), question)
```
"""

from __future__ import annotations

from dataclasses import replace

from c2nav_engine.contract.outcome import Answered, Cardinal, Ordering, Tie
from c2nav_engine.contract.presentation import ORDINAL_FORMS, presentations
from c2nav_engine.contract.prompt import Prompt, Reply
from c2nav_engine.contract.question import Question
from c2nav_engine.contract.render import render
from c2nav_engine.rankers.accounting import AskingConfig
from c2nav_engine.rankers.protocol import Adapter, BatchAdapter
from c2nav_engine.rankers.reading import read
from c2nav_engine.rankers.wrapper import AskingRanker


class NotConforming(AssertionError):
    """An adapter broke a law of the contract; the message says which, and with what."""


def check_adapter(adapter: Adapter, question: Question) -> None:
    """Every law on one question; raises `NotConforming` at the first that does not hold."""
    _demand(bool(adapter.name.strip()), "a name for records", adapter.name)
    _demand(adapter.name.isprintable(), "a printable name on one line", adapter.name)
    shown = presentations(question, once=adapter.asks_once)
    prompts = [
        render(question, order, repair=repair) for order in range(len(shown)) for repair in (0, 1)
    ]
    for prompt in prompts:
        check_reply(prompt, adapter.answer(prompt))
    if isinstance(adapter, BatchAdapter):
        replies = adapter.answer_all(prompts)
        _demand(len(replies) == len(prompts), f"{len(prompts)} replies to a batch", len(replies))
        for prompt, reply in zip(prompts, replies, strict=True):
            check_reply(prompt, reply)
    check_ranked(adapter, question)


def check_reply(prompt: Prompt, reply: Reply) -> None:
    """A reply is text or a finished outcome, with sane facts, and reads as a lawful outcome.

    A refusal or a cut-off answer may keep its words for the record; a selection may not.
    """
    selects = isinstance(reply.outcome, Ordering | Tie | Cardinal)
    _demand(not (selects and reply.text), "text or a selection, not both", reply)
    facts = (reply.latency_s, reply.tokens_in, reply.tokens_out, reply.cost_usd)
    _demand(all(fact is None or fact >= 0 for fact in facts), "facts of zero or more", facts)
    check_outcome(prompt, read(prompt, reply))


def check_outcome(prompt: Prompt, outcome: Answered) -> None:
    """Only an ordering over the offered alternatives may select; an inversion only a number."""
    if isinstance(outcome, Ordering | Tie):
        keys = sorted(key for tier in outcome.tiers for key in tier)
        _demand(keys == sorted(prompt.question.keys), "exactly the offered alternatives", keys)
        _demand(prompt.form in ORDINAL_FORMS, "no ordering in an inverted form", outcome)
    if isinstance(outcome, Cardinal):
        _demand(prompt.form not in ORDINAL_FORMS, "no number in an ordinal form", outcome)


def check_ranked(adapter: Adapter, question: Question) -> None:
    """Inside the wrapper: a full record, every presentation in it, a lawful outcome."""
    config = AskingConfig(retries=0)
    ranked = AskingRanker(adapter, config, sleep=lambda _: None).rank(question)
    orders = {query.prompt.order for query in ranked.queries}
    expected = set(range(len(presentations(question, once=adapter.asks_once))))
    _demand(orders == expected, f"a query for each of the orders {expected}", orders)
    _demand(ranked.ranker == adapter.name, f"the record to name {adapter.name}", ranked.ranker)
    check_outcome(ranked.queries[0].prompt, ranked.outcome)


def check_same_again(adapter: Adapter, question: Question) -> None:
    """For adapters that promise it: the same prompt gives the same reply."""
    prompt = render(question)
    first, second = (replace(adapter.answer(prompt), latency_s=0.0) for _ in range(2))
    _demand(first == second, f"the same reply again: {first}", second)


def _demand(holds: bool, expected: str, came: object) -> None:
    if not holds:
        raise NotConforming(f"expected {expected}, came {came!r}")
