"""The report's figures for programs: fractions of one, metres, seconds; missing is empty."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from c2nav_engine.experiments.report.behaviour import Behaviour, SlotUse
from c2nav_engine.experiments.report.comparing import Comparison
from c2nav_engine.experiments.report.content import Chapter, Report
from c2nav_engine.experiments.report.tables import Beside, Line, Table
from c2nav_engine.experiments.report.turning import Turnings
from c2nav_engine.experiments.statistics.intervals import Interval
from c2nav_engine.experiments.statistics.paired import PairedDifference
from c2nav_engine.experiments.turning.flips import TURNING

Value = str | int | float | None
Record = Mapping[str, Value]


def write_csv(report: Report, folder: Path) -> list[Path]:
    """Write one file of each kind that the report holds, `tables.csv` to `turning.csv`."""
    makers = {
        "tables": _table_records,
        "beside": _beside_records,
        "comparisons": _comparison_records,
        "behaviour": _behaviour_records,
        "slots": _slot_records,
        "turning": _turning_records,
    }
    paths: list[Path] = []
    for name, make in makers.items():
        records = [
            {"section": chapter.title, **record}
            for chapter in report.chapters
            for record in make(chapter)
        ]
        if records:
            paths.append(folder / f"{name}.csv")
            _write(paths[-1], records)
    return paths


def _write(path: Path, records: list[dict[str, Value]]) -> None:
    heads = list(dict.fromkeys(name for record in records for name in record))
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, heads, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows({name: _text(value) for name, value in r.items()} for r in records)


def _text(value: Value) -> str:
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return ""
    return repr(value) if isinstance(value, float) else str(value)


def _table_records(chapter: Chapter) -> Iterator[Record]:
    for table in chapter.tables:
        for line in table.lines:
            yield from _line_records(table, line)


def _line_records(table: Table, line: Line) -> Iterator[Record]:
    for measure in table.measures:
        cell = line.cells.get(measure.name)
        if cell is not None:
            yield {
                "table": table.key,
                "row": line.labels[0],
                "kind": "ours" if line.ours else "reported",
                "system": line.system,
                "variant": line.variant,
                "episodes": line.episodes or None,
                "figure": measure.name,
                "value": cell.value,
                **_ends(cell.interval),
                "reported_spread": _share(cell.spread, percent=measure.percent),
            }


def _share(spread: float | None, *, percent: bool) -> float | None:
    return spread if spread is None or not percent else spread / 100.0


def _beside_records(chapter: Chapter) -> Iterator[Record]:
    for table in chapter.tables:
        for each in table.beside:
            yield _beside_record(table, each)


def _beside_record(table: Table, each: Beside) -> Record:
    return {
        "table": table.key,
        "row": each.row,
        "system": each.system,
        "figure": each.measure.name,
        "reported": each.reported,
        "ours": each.ours.estimate,
        **_ends(each.ours),
        "difference": each.difference,
        "reported_is": "inside" if each.inside else "outside",
    }


def _comparison_records(chapter: Chapter) -> Iterator[Record]:
    for each in (*chapter.against_full, *chapter.in_pairs):
        yield _comparison_record(each)


def _comparison_record(each: Comparison) -> Record:
    table = each.success
    return {
        "compared": each.b,
        "with": each.a,
        "episodes": each.episodes,
        "seed": each.seed,
        "both": table.both,
        "only_compared": table.only_b,
        "only_with": table.only_a,
        "neither": table.neither,
        "mcnemar_p": table.p,
        "mcnemar_holm_p": each.holm.get("sr"),
        **_paired("spl", each.spl, each.holm),
        **_paired("ne_m", each.ne_m, each.holm),
        "resolution": each.words,
    }


def _paired(name: str, paired: PairedDifference | None, holm: Mapping[str, float]) -> Record:
    if paired is None:
        return {}
    return {
        f"{name}_difference": paired.difference.estimate,
        **_ends(paired.difference, f"{name}_"),
        f"{name}_n": paired.difference.n,
        f"{name}_p": paired.p,
        f"{name}_holm_p": holm.get(name),
    }


def _behaviour_records(chapter: Chapter) -> Iterable[Record]:
    return [_behaviour_record(each) for each in chapter.behaviours]


def _behaviour_record(each: Behaviour) -> Record:
    conversion = each.conversion
    return {
        "system": each.system,
        "variant": " = ".join(each.variants),
        "episodes": each.episodes,
        "osr_to_sr": None if conversion is None else conversion.estimate,
        **_ends(conversion, "osr_to_sr_"),
        "sr_zero_shot": each.success_zero_shot and each.success_zero_shot.estimate,
        "invalid_share": each.invalid_share,
        **{f"outcome_{name}": count for name, count in sorted(each.outcomes.items())},
        **{f"{name}_per_episode": value for name, value in each.per_episode.items()},
        "tokens_per_episode": each.tokens,
    }


def _slot_records(chapter: Chapter) -> Iterable[Record]:
    return [_slot_record(each) for each in chapter.slots]


def _slot_record(use: SlotUse) -> Record:
    return {
        "system": use.system,
        "slot": use.slot,
        "episodes": use.traces,
        "questions": use.questions,
        "queries": use.queries,
        "unusable": use.unusable,
        "no_winner": use.abstained,
        "latency_p50_s": None if use.latency_s is None else use.latency_s[0],
        "latency_p95_s": None if use.latency_s is None else use.latency_s[1],
        "tokens_in": use.tokens_in,
        "tokens_out": use.tokens_out,
        "cost_usd": use.cost_usd,
    }


def _turning_records(chapter: Chapter) -> Iterator[Record]:
    for each in chapter.turnings:
        for verdict, rate in each.summary.verdicts.items():
            yield _turning_record(each, verdict, "", rate)
        for slot, rate in each.summary.by_slot.items():
            yield _turning_record(each, TURNING, slot.value, rate)


def _turning_record(each: Turnings, verdict: str, slot: str, rate: Interval) -> Record:
    return {
        "system": each.system,
        "variant": " = ".join(each.variants),
        "failures": each.summary.failures,
        "analysed": each.summary.analysed,
        "verdict": verdict,
        "slot": slot,
        "count": round(rate.estimate * rate.n),
        "share": rate.estimate,
        **_ends(rate),
    }


def _ends(interval: Interval | None, prefix: str = "") -> dict[str, Value]:
    ends = (None, None) if interval is None else (interval.low, interval.high)
    return {f"{prefix}low": ends[0], f"{prefix}high": ends[1]}
