"""A named ranker with its options, put together: adapter, wrapper, budget, cache.

Options of the wrapper go with every model: `concurrency`, `retries`, `max_queries`,
`max_cost_usd`, `cache` (a folder). All others are the adapter's own. Heavy packages are imported
by the entry that needs them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from c2nav_engine.errors import UsageError
from c2nav_engine.rankers.accounting import AskingConfig
from c2nav_engine.rankers.cache import AnswerCache
from c2nav_engine.rankers.capabilities import PRESETS
from c2nav_engine.rankers.options import OptionReader, Options
from c2nav_engine.rankers.protocol import Adapter
from c2nav_engine.rankers.wrapper import AskingRanker

ASKING_OPTIONS = ("concurrency", "retries", "max_queries", "max_cost_usd", "cache")
"""Options that the wrapper takes."""


def assemble(name: str, options: Options) -> AskingRanker:
    """The ranker of that name; raises `UsageError` for an unknown name or option."""
    if name not in ADAPTERS:
        message = f"expected a ranker among {', '.join(ADAPTERS)}; came {name!r}"
        raise UsageError(message)
    asking = {key: value for key, value in options.items() if key in ASKING_OPTIONS}
    own = {key: value for key, value in options.items() if key not in ASKING_OPTIONS}
    config, folder = _asking(name, asking)
    adapter = ADAPTERS[name](own)
    cache = AnswerCache(folder, {**own, "name": adapter.name}) if folder else None
    return AskingRanker(adapter, config, cache=cache)


def _asking(name: str, options: Options) -> tuple[AskingConfig, Path | None]:
    reader, default = OptionReader(name, options), AskingConfig()
    config = AskingConfig(
        concurrency=reader.integer("concurrency", default.concurrency),
        retries=reader.integer("retries", default.retries),
        max_queries=reader.optional_integer("max_queries"),
        max_cost_usd=reader.optional_number("max_cost_usd"),
    )
    folder = reader.text("cache")
    if config.concurrency < 1 or config.retries < 0:
        message = f"expected concurrency of 1 or more and retries of 0 or more, came {config}"
        raise UsageError(message)
    return config, Path(folder) if folder else None


def _reference_cv(options: Options) -> Adapter:
    from c2nav_engine.rankers.reference_cv import ReferenceCv

    return ReferenceCv.from_options(options)


def _scripted(options: Options) -> Adapter:
    from c2nav_engine.rankers.scripted import Scripted

    return Scripted.from_options(options)


def _random(options: Options) -> Adapter:
    from c2nav_engine.rankers.random_order import RandomOrder

    return RandomOrder.from_options(options)


def _local(options: Options) -> Adapter:
    from c2nav_engine.rankers.local import Local

    return Local.from_options(options)


def _served(name: str, interface: str) -> Callable[[Options], Adapter]:
    def build(options: Options) -> Adapter:
        if interface == "openai-responses":
            from c2nav_engine.rankers.openai_responses import OpenAIResponses

            return OpenAIResponses.from_options(options, name=name)
        from c2nav_engine.rankers.openai_chat import OpenAIChat

        return OpenAIChat.from_options(options, name=name)

    return build


ADAPTERS: Mapping[str, Callable[[Options], Adapter]] = {
    "reference-cv": _reference_cv,
    "openai-chat": _served("openai-chat", "openai-chat"),
    "openai-responses": _served("openai-responses", "openai-responses"),
    **{name: _served(name, preset.ranker) for name, preset in PRESETS.items()},
    "local": _local,
    "random": _random,
    "scripted": _scripted,
}
"""What options alone can build; a person, a replay and the simulated observer need more."""
