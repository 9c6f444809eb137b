"""The one table: ranker name → how its seats are made.

`run` and `inspect` resolve here, so that `simulated`, which knows the truth, can be named without
any ranker importing it. Heavy packages are imported by the entry that needs them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from c2nav_engine.errors import UsageError
from c2nav_engine.rankers.protocol import Adapter
from c2nav_engine.rankers.wrapper import AskingRanker
from c2nav_engine.runner.opening import Seat, SeatFor

DEFAULT_RANKER = "reference-cv"

Options = Mapping[str, str]


@dataclass(frozen=True, slots=True)
class RankerEntry:
    """One row of the table.

    Attributes:
        make: Options → what makes each episode's seat; raises `UsageError` for wrong options.
        words: One line for `--help` and the inspector.
        interactive: Needs a person at a page.
    """

    make: Callable[[Options], SeatFor]
    words: str
    interactive: bool = False


def seats_for(name: str, options: Options | None = None) -> SeatFor:
    """The seats of a ranker; raises `UsageError` for an unknown name or option."""
    if name not in RANKERS:
        message = f"expected a ranker ({', '.join(RANKERS)}), came {name!r}"
        raise UsageError(message)
    return RANKERS[name].make(options or {})


def _shared(name: str, adapter: Adapter, options: Options) -> SeatFor:
    """One adapter for all episodes of a process."""
    ranker = AskingRanker(adapter)
    return lambda _stage: Seat(ranker, ranker.name or name, options)


def _reference_cv(options: Options) -> SeatFor:
    from c2nav_engine.rankers.reference_cv import ReferenceCv

    return _shared("reference-cv", ReferenceCv.from_options(options), options)


def _scripted(options: Options) -> SeatFor:
    from c2nav_engine.rankers.scripted import Scripted

    return _shared("scripted", Scripted.from_options(options), options)


def _random(options: Options) -> SeatFor:
    from c2nav_engine.rankers.random_order import RandomOrder

    if options:
        return _shared("random", RandomOrder.from_options(options), options)
    return lambda stage: Seat(AskingRanker(RandomOrder(stage.seed)), "random")


def _human(options: Options) -> SeatFor:
    if options:
        message = f"expected no options for the ranker human, came {', '.join(sorted(options))}"
        raise UsageError(message)
    return lambda _stage: Seat(None, "human")


def _simulated(options: Options) -> SeatFor:
    from c2nav_engine.experiments.simulated_seat import simulated_seat

    return lambda stage: simulated_seat(stage, options)


def _openai_chat(options: Options) -> SeatFor:
    from c2nav_engine.rankers.openai_chat import OpenAIChat

    return _shared("openai-chat", OpenAIChat.from_options(options), options)


def _openai_responses(options: Options) -> SeatFor:
    from c2nav_engine.rankers.openai_responses import OpenAIResponses

    return _shared("openai-responses", OpenAIResponses.from_options(options), options)


def _local(options: Options) -> SeatFor:
    from c2nav_engine.rankers.local import Local

    return _shared("local", Local.from_options(options), options)


RANKERS: Mapping[str, RankerEntry] = {
    "reference-cv": RankerEntry(_reference_cv, "pixels and text only, no weights; the default"),
    "openai-chat": RankerEntry(_openai_chat, "any server that speaks chat completions"),
    "openai-responses": RankerEntry(_openai_responses, "servers that speak the responses API"),
    "local": RankerEntry(_local, "Qwen3-VL in process (extra `local`)"),
    "human": RankerEntry(_human, "a person in the inspector", interactive=True),
    "scripted": RankerEntry(_scripted, "a fixed answer, for tests"),
    "random": RankerEntry(_random, "seeded uniform orders"),
    "simulated": RankerEntry(_simulated, "privileged observer that knows the truth"),
}
"""Every ranker by name."""
