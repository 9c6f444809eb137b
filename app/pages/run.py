"""The Run page: what a run came to, what it may be held against, and whether to trust it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

from app.pages.index.finding import health, rows
from app.pages.index.query import term
from app.pages.library import Library, Tasks
from app.pages.page import framed
from app.pages.turned import Turned, turned_of
from c2nav_engine.errors import InputError
from c2nav_engine.experiments.columns import Row
from c2nav_engine.experiments.estimates import figure
from c2nav_engine.experiments.health import SlotHealth
from c2nav_engine.experiments.report.reported import (
    ABLATED_BACKBONE,
    OPENNAV_100_SHA256,
    Reported,
    backbone_of,
    reported_beside,
)
from c2nav_engine.experiments.report.tables import SR, Beside
from c2nav_engine.experiments.statistics.intervals import Interval, wilson
from c2nav_engine.experiments.tags.endings import FAILURES, RULES, Ending
from c2nav_engine.navigator.variants import PRESETS, preset

_FIGURES = (
    ("osr", "OSR", True),
    ("spl", "SPL", True),
    ("ne_m", "NE, m", False),
    ("ndtw", "nDTW", True),
    ("steps", "steps", False),
    ("queries", "queries", False),
)


@dataclass(frozen=True, slots=True)
class Block:
    """One block of the failure budget.

    Attributes:
        words: What it is called.
        rule: What it means.
        count: Episodes in it.
        query: Which cases they are.
        kind: "success", "fault" or "plain": its sign.
    """

    words: str
    rule: str
    count: int
    query: str
    kind: str


@dataclass(frozen=True, slots=True)
class Shown:
    """A figure with its interval, in words."""

    head: str
    value: str
    interval: str


@dataclass(frozen=True, slots=True)
class ArmView:
    """One variant of a run with one ranker.

    Attributes:
        variant: Preset.
        ranker: Name with model id.
        privileged: Whether it knows the truth.
        episodes: Rows behind it.
        rate: Success in percent; "" where nothing was measured.
        sentence: What it may be held against.
        figures: Further figures.
        budget: Every episode once.
        turned: What one other answer would have made of the failures; None where none was tried.
    """

    variant: str
    ranker: str
    privileged: bool
    episodes: int
    rate: str
    sentence: str
    figures: tuple[Shown, ...]
    budget: tuple[Block, ...]
    turned: Turned | None


def run_page(library: Library, run: str, *, against: str = "", menu: Sequence[str]) -> str:
    """The page; raises `InputError` for a run that is not there.

    Args:
        library: The runs.
        run: Which of them.
        against: Another run to hold its manifest against; "" for the presets.
        menu: As in `framed`.
    """
    for each in (run, *([against] if against else [])):
        if each not in library.runs():
            known = ", ".join(library.runs())
            message = f"expected a run of {library.root} ({known}), came {each!r}"
            raise InputError(message)
    manifest = library.manifest(run)
    found = rows(library.store, run)
    counted = health(library.store, run)
    return framed(
        "run.html.j2",
        here="run",
        menu=menu,
        run=run,
        name=run if run != "." else library.root.resolve().name,
        runs=library.runs(),
        against=against,
        recorded=bool(manifest),
        tasks=library.tasks(run),
        unread=library.progress,
        looked=library.looked,
        facts=_facts(manifest),
        arms=[_arm(library.root, run, members, manifest) for members in _arms(found)],
        differs=differences(manifest, library.manifest(against))
        if against
        else from_presets(manifest),
        slots=[_slot(name, counts) for name, counts in sorted(counted.slots.items())],
        models=sorted(counted.models.items(), key=lambda item: -item[1]),
        asked_model=str(manifest.get("ranker_options", {}).get("model", "")),
        stamp=stamp(library.tasks(run), len(found)),
    )


def stamp(tasks: Tasks | None, indexed: int) -> str:
    """Changes whenever the page would say something else: what a page that waits asks for."""
    return f"{indexed}/{tasks.done if tasks else 0}/{tasks.total if tasks else 0}"


# ---------------------------------------------------------------- results


def _arms(found: Sequence[Row]) -> Iterator[list[Row]]:
    groups: dict[tuple[str, str], list[Row]] = {}
    for row in found:
        groups.setdefault((str(row["variant"]), str(row["ranker"])), []).append(row)
    order = {variant: place for place, variant in enumerate(PRESETS)}
    return iter(
        groups[key] for key in sorted(groups, key=lambda key: (order.get(key[0], 99), key[1]))
    )


def _arm(root: Path, run: str, members: Sequence[Row], manifest: Mapping[str, Any]) -> ArmView:
    first = members[0]
    variant, ranker = str(first["variant"]), str(first["ranker"])
    privileged = any(row["privileged"] for row in members)
    rate = figure(members, "sr")
    reported = None if privileged else _reported(variant, ranker)
    same = manifest.get("source_sha256") == OPENNAV_100_SHA256
    return ArmView(
        variant=variant,
        ranker=ranker,
        privileged=privileged,
        episodes=len(members),
        rate="" if rate is None else percent(rate.estimate),
        sentence=sentence(rate, reported, same_episodes=same, recorded=bool(manifest)),
        figures=tuple(_figures(members)),
        budget=tuple(_budget(run, members)),
        turned=turned_of(root / run, members),
    )


def _reported(variant: str, ranker: str) -> Reported | None:
    """The paper's row for this variant, where it speaks of this ranker's model."""
    backbone = backbone_of(ranker)
    if backbone is None:
        return None
    ablated = backbone.labels[0].startswith(ABLATED_BACKBONE)
    return reported_beside([variant], ranker) if ablated or variant == "full" else None


def sentence(
    rate: Interval | None,
    reported: Reported | None,
    *,
    same_episodes: bool,
    recorded: bool = True,
) -> str:
    """What a success rate may be held against, and what follows.

    Args:
        rate: The rate; None where nothing was scored.
        reported: The paper's row; None where it has none.
        same_episodes: Whether that row is of these episodes.
        recorded: Whether a manifest says which episodes were to be run: without one somebody may
            have chosen them by how they ended.
    """
    if rate is None:
        return "No episode of it was scored yet."
    of = f"{round(rate.estimate * rate.n)} of {rate.n}"
    ours = f"{of}, {100 * rate.low:.0f}–{100 * rate.high:.0f} %"
    if not recorded:
        return f"{ours}; no manifest says how these were chosen, so nothing follows from the rate."
    value = None if reported is None else reported.value("sr")
    if reported is None or value is None:
        return f"{ours}; the paper reports no such row, so this run stands alone."
    theirs = f"the reported {100 * value:g}"
    if not same_episodes:
        return f"{ours}; {theirs} is of other episodes, so nothing follows from it."
    if Beside(reported.labels[0], "", SR, value, rate).inside:
        return f"{ours}; {theirs} lies inside, so this run cannot tell them apart."
    return f"{ours}; {theirs} lies outside, so this run differs from it."


def _figures(members: Sequence[Row]) -> Iterator[Shown]:
    for name, head, share in _FIGURES:
        interval = figure(members, name)
        if interval is not None:
            scale, digits = (100.0, 1) if share else (1.0, 2 if name == "ne_m" else 0)
            ends = f"{scale * interval.low:.{digits}f}–{scale * interval.high:.{digits}f}"
            unbounded = interval.n < 2
            value = f"{scale * interval.estimate:.{digits}f}{' %' if share else ''}"
            yield Shown(head, value, "" if unbounded else ends)


def _budget(run: str, members: Sequence[Row]) -> Iterator[Block]:
    base = f"{term('run', run)} {term('variant', str(members[0]['variant']))}"
    counts = dict.fromkeys(Ending, 0)
    for row in members:
        counts[Ending(str(row["ending"]))] += 1
    for ending in (Ending.SUCCESS, *FAILURES, Ending.UNKNOWN):
        if counts[ending] or ending is not Ending.UNKNOWN:
            kind = {Ending.SUCCESS: "success", Ending.ERROR: "fault"}.get(ending, "plain")
            query = f"{base} {term('ending', ending.value)}"
            yield Block(ending.value, RULES[ending], counts[ending], query, kind)


def percent(share: float) -> str:
    """A share as a page says it."""
    return f"{100 * share:.1f} %"


# ---------------------------------------------------------------- what it is, and what differs


def _facts(manifest: Mapping[str, Any]) -> list[tuple[str, str]]:
    if not manifest:
        return []
    setting = manifest["spec"]["setting"]
    noise = [name for name in ("odometry_noise", "depth_noise") if setting.get(name)]
    return [
        ("source", str(manifest["source"])),
        ("ranker", str(manifest["ranker"])),
        ("profile", str(manifest["profile"]["name"])),
        ("headings", str(manifest["headings"])),
        ("nDTW against", str(manifest["ground_truth"])),
        ("seeds", ", ".join(str(seed) for seed in manifest["seeds"])),
        ("noise", ", ".join(f"{name} {setting[name]}" for name in noise)),
        ("code", str(manifest["code_version"])),
    ]


Difference = tuple[str, str, str]
"""(name, ours, theirs)."""

_SAYS_NOTHING = ("spec", "spec_sha256")
"""Parts of a manifest that only list tasks, or repeat what stands elsewhere."""


def differences(ours: Mapping[str, Any], theirs: Mapping[str, Any]) -> list[Difference]:
    """Where two manifests differ, by dotted name."""
    a, b = (dict(_flat(_told(manifest))) for manifest in (ours, theirs))
    return [
        (name, a.get(name, "–"), b.get(name, "–"))
        for name in sorted({*a, *b})
        if a.get(name) != b.get(name)
    ]


def from_presets(manifest: Mapping[str, Any]) -> list[Difference]:
    """Where the recorded configuration of a variant is not this version's preset."""
    found: list[Difference] = []
    for name, facts in manifest.get("variants", {}).items():
        if name in PRESETS and "config" in facts:
            theirs = {name: preset(name).as_json()}
            found += differences({name: facts["config"]}, theirs)
    return found


def _told(manifest: Mapping[str, Any]) -> dict[str, Any]:
    told = {name: value for name, value in manifest.items() if name not in _SAYS_NOTHING}
    setting = manifest.get("spec", {}).get("setting", {})
    return told | {"setting": setting} if setting else told


def _flat(value: Any, name: str = "") -> Iterator[tuple[str, str]]:
    if isinstance(value, Mapping) and value:
        for key, inner in cast("Mapping[str, Any]", value).items():
            yield from _flat(inner, f"{name}.{key}" if name else str(key))
    else:
        yield name, str(cast("object", value))


# ---------------------------------------------------------------- health


@dataclass(frozen=True, slots=True)
class SlotView:
    """The health of one slot, in words.

    Attributes:
        slot: Its name.
        questions: Questions put.
        queries: Queries they took.
        unusable: Answers that could not be used, by kind.
        consistency: Share of questions in several orders with one winner, with its interval.
        tokens: Prompt tokens a query, measured over expected.
        fault: Whether any answer could not be used.
    """

    slot: str
    questions: int
    queries: int
    unusable: str
    consistency: str
    tokens: str
    fault: bool


def _slot(name: str, counts: SlotHealth) -> SlotView:
    kinds = ("invalid", "refused", "truncated", "empty", "failed")
    bad = [f"{getattr(counts, kind)} {kind}" for kind in kinds if getattr(counts, kind)]
    order = wilson(counts.consistent, counts.reordered)
    consistency = (
        f"{percent(order.estimate)} of {order.n} ({100 * order.low:.0f}–{100 * order.high:.0f})"
        if order.n
        else "asked in one order"
    )
    tokens = "not told"
    if counts.counted:
        mean, expected = (
            total / counts.counted for total in (counts.tokens_in, counts.expected_tokens_in)
        )
        tokens = f"{mean:.0f}, expected {expected:.0f} (×{mean / max(expected, 1.0):.2f})"
    return SlotView(
        slot=name,
        questions=counts.questions,
        queries=counts.queries,
        unusable=", ".join(bad) or "none",
        consistency=consistency,
        tokens=tokens,
        fault=bool(bad),
    )
