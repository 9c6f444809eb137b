"""What a run will take before it starts: tasks, queries, tokens, cost, time, and who sees pictures.

An estimate from measured means, good to a factor of about two. Where the run folder holds rows of
the same ranker already, their queries, tokens and waiting are used in place of the means.
"""

from __future__ import annotations

import ipaddress
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean
from urllib.parse import urlsplit

from c2nav_engine.experiments.asking import asking_from
from c2nav_engine.experiments.columns import Row
from c2nav_engine.experiments.estimates import number
from c2nav_engine.experiments.executors.choosing import lanes_of
from c2nav_engine.experiments.expected import (
    CHARS_PER_TOKEN,
    Expected,
    ModelMeans,
    VariantMeans,
    expected,
    picture_tokens,
)
from c2nav_engine.experiments.rankers import RANKERS
from c2nav_engine.experiments.spec import RunSpec, Setting, config_sha256
from c2nav_engine.rankers.capabilities import GENERIC, Capabilities

ENOUGH_ROWS = 5
"""Rows of a variant in the run folder from which its own means are used [C]."""
_QWEN_LEAST_TOKENS = 64
"""A picture is scaled up to 256 × 256 at least."""


@dataclass(frozen=True, slots=True)
class Share:
    """What one configuration will take.

    Attributes:
        variants: Its presets.
        tasks: Episodes × seeds.
        queries: Queries.
        tokens_in: Prompt tokens; None for rankers without any.
        tokens_out: Completion tokens.
        wait_s: Sum of all waits for answers.
        core_s: Seconds of one core.
        trace_mb: Size of all traces.
        measured_here: Whether queries, tokens and waits come from rows of this run.
    """

    variants: tuple[str, ...]
    tasks: int
    queries: float
    tokens_in: float | None
    tokens_out: float | None
    wait_s: float
    core_s: float
    trace_mb: float
    measured_here: bool


@dataclass(frozen=True, slots=True)
class Estimate:
    """What the whole run will take.

    Attributes:
        shares: By distinct configuration.
        rows: Rows of its tables; presets that share a configuration have one each.
        workers: Processes, actors or jobs.
        lanes: Queries under way at once in each.
        cost_usd: At list prices; None where none is known.
        host: Where pictures go; "" when they stay on this machine.
        notes: How it was reckoned.
    """

    shares: tuple[Share, ...]
    rows: int
    workers: int
    lanes: int
    cost_usd: float | None
    host: str
    notes: tuple[str, ...]

    @property
    def tasks(self) -> int:
        """Episodes that will be run."""
        return sum(share.tasks for share in self.shares)

    @property
    def queries(self) -> float:
        """Queries that will be sent."""
        return sum(share.queries for share in self.shares)

    @property
    def tokens_in(self) -> float | None:
        """Prompt tokens; None for rankers without any."""
        known = [share.tokens_in for share in self.shares]
        return sum(t for t in known if t is not None) if None not in known else None

    @property
    def tokens_out(self) -> float | None:
        """Completion tokens; None for rankers without any."""
        known = [share.tokens_out for share in self.shares]
        return sum(t for t in known if t is not None) if None not in known else None

    @property
    def time_s(self) -> float:
        """Wall time: cores and waiting overlap where a process has several lanes."""
        core_s = sum(share.core_s for share in self.shares) / self.workers
        wait_s = sum(share.wait_s for share in self.shares) / (self.workers * self.lanes)
        return max(core_s, wait_s) if self.lanes > 1 else core_s + wait_s

    @property
    def trace_gb(self) -> float:
        """Disk for the traces."""
        return sum(share.trace_mb for share in self.shares) / 1000.0


def estimate(spec: RunSpec, *, workers: int = 1, rows: Sequence[Row] = ()) -> Estimate:
    """Reckon a run.

    Args:
        spec: The run.
        workers: Processes, actors or jobs.
        rows: What its folder holds already.
    """
    table = expected()
    setting = spec.setting
    capabilities = _capabilities(setting)
    model = _model(table, setting, capabilities)
    configs: dict[str, list[str]] = {}
    for variant in spec.variants:
        configs.setdefault(config_sha256(variant), []).append(variant)
    tasks = len(spec.episodes) * len(spec.seeds)
    shares = tuple(
        _share(tuple(variants), tasks, (table, model, capabilities), rows)
        for variants in configs.values()
    )
    host = host_of(setting)
    return Estimate(
        shares=shares,
        rows=tasks * len(spec.variants),
        workers=workers,
        lanes=lanes_of(setting),
        cost_usd=_cost_usd(shares, capabilities),
        host=host,
        notes=(table.how, f"{setting.ranker}: {model.how}"),
    )


def host_of(setting: Setting) -> str:
    """Host beyond this machine that pictures go to; "" when they stay here."""
    if not RANKERS[setting.ranker].remote:
        return ""
    host = urlsplit(_settings(setting)[0]).hostname or ""
    return "" if _is_loopback(host) else host


def _share(
    variants: tuple[str, ...],
    tasks: int,
    known: tuple[Expected, ModelMeans, Capabilities | None],
    rows: Sequence[Row],
) -> Share:
    table, model, capabilities = known
    means = table.variants[variants[0]] if variants[0] in table.variants else _twin(table, variants)
    # The variant `random` answers for itself whatever ranker is named.
    free = variants == ("random",)
    own = [row for row in rows if row["variant"] in variants and row["outcome"] != "error"]
    queries = sum(means.queries.values())
    tokens = None if capabilities is None else _tokens(table, means, model, capabilities)
    if free and tokens is not None:
        tokens = (0.0, 0.0)
    wait_s = 0.0 if free else queries * model.latency_s
    measured = len(own) >= ENOUGH_ROWS
    if measured:
        queries = _mean(own, "queries", queries)
        wait_s = _mean(own, "latency_s", wait_s)
        if tokens is not None and sum(tokens):
            scale = _mean(own, "tokens", sum(tokens)) / sum(tokens)
            tokens = (tokens[0] * scale, tokens[1] * scale)
    core_s = means.core_s + (0.0 if free else queries * model.core_s)
    return Share(
        variants=variants,
        tasks=tasks,
        queries=tasks * queries,
        tokens_in=None if tokens is None else tasks * tokens[0],
        tokens_out=None if tokens is None else tasks * tokens[1],
        wait_s=tasks * wait_s,
        core_s=tasks * core_s,
        trace_mb=tasks * means.trace_mb,
        measured_here=measured,
    )


def _twin(table: Expected, variants: Sequence[str]) -> VariantMeans:
    """Means of a preset that was measured under its twin's name, else those of `full`."""
    configs = {config_sha256(name): means for name, means in table.variants.items()}
    return configs.get(config_sha256(variants[0]), table.variants["full"])


def _tokens(
    table: Expected, means: VariantMeans, model: ModelMeans, capabilities: Capabilities
) -> tuple[float, float]:
    """Prompt and completion tokens of a mean episode."""
    least = _QWEN_LEAST_TOKENS if capabilities.name == "qwen3-vl" else 1
    tokens_in = tokens_out = 0.0
    for slot, queries in means.queries.items():
        query = table.slots[slot]
        pictures = sum(
            each.count * picture_tokens(each.width_px, each.height_px, least=least)
            for each in query.pictures
        )
        tokens_in += queries * (query.text_chars / CHARS_PER_TOKEN + pictures)
        answer = model.tokens_out
        tokens_out += queries * (query.answer_chars / CHARS_PER_TOKEN if answer is None else answer)
    return tokens_in, tokens_out


def _mean(rows: Sequence[Row], column: str, otherwise: float) -> float:
    values = [value for row in rows if (value := number(row, column)) is not None]
    return fmean(values) if values else otherwise


def _model(table: Expected, setting: Setting, capabilities: Capabilities | None) -> ModelMeans:
    names = (setting.ranker, capabilities.name if capabilities is not None else "", "other")
    return next(table.models[name] for name in names if name in table.models)


def _capabilities(setting: Setting) -> Capabilities | None:
    """What is known of the model; None for rankers without tokens."""
    if RANKERS[setting.ranker].remote:
        return _settings(setting)[1]
    return GENERIC if setting.ranker == "local" else None


def _settings(setting: Setting) -> tuple[str, Capabilities]:
    """Address and capabilities of a remote ranker; raises `UsageError` for wrong options."""
    from c2nav_engine.rankers.openai_settings import settings_from

    settings = settings_from(setting.ranker, asking_from(setting.ranker_options)[1])
    return settings.base_url, settings.capabilities


def _cost_usd(shares: Sequence[Share], capabilities: Capabilities | None) -> float | None:
    if capabilities is None:
        return None
    tokens: Mapping[str, float] = {
        "in": sum(share.tokens_in or 0.0 for share in shares),
        "out": sum(share.tokens_out or 0.0 for share in shares),
    }
    return capabilities.cost_usd(round(tokens["in"]), round(tokens["out"]))


def _is_loopback(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost" or host.endswith(".localhost")
