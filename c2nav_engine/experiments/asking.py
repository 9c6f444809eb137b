"""Options that every ranker takes: how widely and persistently it asks, and when it must stop."""

from __future__ import annotations

from collections.abc import Mapping

from c2nav_engine.rankers.accounting import AskingConfig
from c2nav_engine.rankers.options import OptionReader

ASKING_OPTIONS = ("concurrency", "retries", "max_queries", "max_cost_usd", "cache")
"""Option names that belong to the asking, not to the adapter."""


def asking_from(options: Mapping[str, str]) -> tuple[AskingConfig, dict[str, str]]:
    """How to ask, and the options that are left for the adapter; raises `UsageError`.

    `concurrency` is the number of queries under way at once over all episodes of a process,
    `retries` the further tries after a transport failure; `max_queries` and `max_cost_usd` end
    the run (of one process) when they are used up. `cache` is a folder of kept answers.
    """
    own = {name: text for name, text in options.items() if name in ASKING_OPTIONS}
    rest = {name: text for name, text in options.items() if name not in ASKING_OPTIONS}
    reader = OptionReader("asking", own)
    usual = AskingConfig()
    config = AskingConfig(
        concurrency=max(1, reader.integer("concurrency", usual.concurrency)),
        retries=max(0, reader.integer("retries", usual.retries)),
        max_queries=reader.optional_integer("max_queries"),
        max_cost_usd=reader.optional_number("max_cost_usd"),
        cache=reader.text("cache"),
    )
    return config, rest
