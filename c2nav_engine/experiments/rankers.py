"""The one table: ranker name → how its seats are made.

`run` and `inspect` resolve here, so that `simulated`, which knows the truth, can be named without
any ranker importing it. Heavy packages are imported by the entry that needs them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from c2nav_engine.contract.route_model import Complete
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.asking import asking_from
from c2nav_engine.rankers.capabilities import PRESETS, Preset
from c2nav_engine.rankers.completing import completion_through
from c2nav_engine.rankers.protocol import Adapter, Told
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
        privileged: Knows the truth, and says so in every record.
        remote: Waits for a server, so that episodes may overlap in one process.
        adapter: Options → an adapter that needs no running episode; None where there is none.
    """

    make: Callable[[Options], SeatFor]
    words: str
    interactive: bool = False
    privileged: bool = False
    remote: bool = False
    adapter: Callable[[Options], Adapter] | None = None


def seats_for(name: str, options: Options | None = None) -> SeatFor:
    """The seats of a ranker; raises `UsageError` for an unknown name or option."""
    if name not in RANKERS:
        message = f"expected a ranker ({', '.join(RANKERS)}), came {name!r}"
        raise UsageError(message)
    return RANKERS[name].make(options or {})


def check_unattended(name: str) -> None:
    """Reject a ranker that needs a person at the inspector; raises `UsageError`."""
    if name in RANKERS and RANKERS[name].interactive:
        message = (
            f"expected a ranker that answers by itself, came {name}, which needs the inspector; "
            "use `c2nav inspect`"
        )
        raise UsageError(message)


def ranker_for(name: str, options: Options | None = None) -> AskingRanker:
    """A ranker for questions that exist already; raises `UsageError` where there can be none."""
    seats_for_name = RANKERS.get(name)
    if seats_for_name is None or seats_for_name.adapter is None:
        able = ", ".join(each for each, entry in RANKERS.items() if entry.adapter is not None)
        message = f"expected a ranker that answers recorded questions ({able}), came {name!r}"
        raise UsageError(message)
    asking, rest = asking_from(options or {})
    return AskingRanker(seats_for_name.adapter(rest), asking)


def completion_for(name: str, options: Options) -> Complete:
    """A ranker's language model as a function; raises `UsageError` where it has none."""
    entry = RANKERS.get(name)
    if entry is None or entry.adapter is None:
        message = f"expected a ranker with a language model to parse routes, came {name!r}"
        raise UsageError(message)
    asking, rest = asking_from(options)
    return completion_through(entry.adapter(rest), asking)


def _shared(adapter: Callable[[Options], Adapter]) -> Callable[[Options], SeatFor]:
    """One adapter for all episodes of a process."""

    def make(options: Options) -> SeatFor:
        asking, rest = asking_from(options)
        answering = adapter(rest)
        ranker = AskingRanker(answering, asking)
        # Defaults and a preset's choices stand in the record too: they shape the answers.
        told = {**options, **answering.options} if isinstance(answering, Told) else options
        return lambda _stage: Seat(ranker, ranker.name, told)

    return make


def _reference_cv(options: Options) -> Adapter:
    from c2nav_engine.rankers.reference_cv import ReferenceCv

    return ReferenceCv.from_options(options)


def _scripted(options: Options) -> Adapter:
    from c2nav_engine.rankers.scripted import Scripted

    return Scripted.from_options(options)


def _random_adapter(options: Options) -> Adapter:
    from c2nav_engine.rankers.random_order import RandomOrder

    return RandomOrder.from_options(options)


def _random(options: Options) -> SeatFor:
    from c2nav_engine.rankers.random_order import RandomOrder

    if options:
        return _shared(_random_adapter)(options)
    return lambda stage: Seat(AskingRanker(RandomOrder(stage.seed)), "random")


def _human(options: Options) -> SeatFor:
    if options:
        message = f"expected no options for the ranker human, came {', '.join(sorted(options))}"
        raise UsageError(message)
    return lambda _stage: Seat(None, "human")


def _simulated(options: Options) -> SeatFor:
    from c2nav_engine.experiments.simulated_seat import simulated_seat

    return lambda stage: simulated_seat(stage, options)


def _replay(options: Options) -> SeatFor:
    from c2nav_engine.experiments.replayed import Recordings

    return Recordings(options).seat


def _replay_adapter(options: Options) -> Adapter:
    from c2nav_engine.experiments.replayed import Recordings, replay_of

    return replay_of(Recordings(options).all)


def _openai_chat(options: Options, name: str = "") -> Adapter:
    from c2nav_engine.rankers.openai_chat import OpenAIChat

    return OpenAIChat.from_options(options, name=name)


def _openai_responses(options: Options, name: str = "") -> Adapter:
    from c2nav_engine.rankers.openai_responses import OpenAIResponses

    return OpenAIResponses.from_options(options, name=name)


def _preset(name: str, preset: Preset) -> RankerEntry:
    """A known model under its short name; its options are those of its interface."""
    interface = {"openai-chat": _openai_chat, "openai-responses": _openai_responses}[preset.ranker]
    words = f"{preset.model} through {preset.ranker}"
    return _entry(lambda options: interface(options, name), words, remote=True)


def _local(options: Options) -> Adapter:
    from c2nav_engine.rankers.local import Local

    return Local.from_options(options)


def _entry(
    adapter: Callable[[Options], Adapter], words: str, *, remote: bool = False
) -> RankerEntry:
    return RankerEntry(_shared(adapter), words, remote=remote, adapter=adapter)


RANKERS: Mapping[str, RankerEntry] = {
    "reference-cv": _entry(_reference_cv, "pixels and text only, no weights; the default"),
    "openai-chat": _entry(_openai_chat, "any server that speaks chat completions", remote=True),
    "openai-responses": _entry(
        _openai_responses, "servers that speak the responses API", remote=True
    ),
    **{name: _preset(name, preset) for name, preset in PRESETS.items()},
    "local": _entry(_local, "Qwen3-VL in process (extra `local`)"),
    "human": RankerEntry(_human, "a person in the inspector", interactive=True),
    "replay": RankerEntry(
        _replay, "recorded answers, by the exact request", adapter=_replay_adapter
    ),
    "scripted": _entry(_scripted, "a fixed answer, for tests"),
    "random": RankerEntry(_random, "seeded uniform orders", adapter=_random_adapter),
    "simulated": RankerEntry(
        _simulated, "privileged observer that knows the truth", privileged=True
    ),
}
"""Every ranker by name."""
