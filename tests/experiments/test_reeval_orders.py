"""Recorded questions asked again: which orders, which letters, and what the file holds."""

from __future__ import annotations

import itertools
import json
from pathlib import Path

import pytest

from app.cli import main
from c2nav_engine.contract.outcome import Ordering
from c2nav_engine.contract.presentation import seeded_order
from c2nav_engine.contract.question import Form, Slot
from c2nav_engine.errors import InputError, RankerStopped, UsageError
from c2nav_engine.experiments.rankers import ranker_for
from c2nav_engine.experiments.reeval import (
    Labelling,
    OrderSet,
    count_queries,
    presentations_of,
    reevaluate,
)
from c2nav_engine.experiments.reeval_summary import summarise
from c2nav_engine.experiments.reeval_table import (
    COLUMNS,
    Record,
    read_table,
    record_of,
    write_table,
)
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.rankers.accounting import AskingConfig
from c2nav_engine.rankers.scripted import Scripted
from c2nav_engine.rankers.wrapper import AskingRanker
from c2nav_engine.runner.recorded import open_trace
from tests.helpers.questions import question

GOLDEN = Path(__file__).resolve().parents[1] / "golden" / "trace-v1.mcap"
SEEING = question(Slot.SEEING)


def first_letter() -> AskingRanker:
    """Always prefers the letter A, whatever it names and wherever it stands."""
    return AskingRanker(Scripted(lambda prompt: "A"))


def first_shown() -> AskingRanker:
    """Always prefers what stands first."""
    return AskingRanker(Scripted(lambda prompt: prompt.labels[0][0]))


def records(ranker: AskingRanker, orders: OrderSet) -> list[Record]:
    return [record_of(each, ranker.name) for each in reevaluate([GOLDEN], ranker, orders)]


def test_the_recorded_order_comes_first_and_alone() -> None:
    (only,) = presentations_of(SEEING, OrderSet.RECORDED)
    assert only.order == 0
    assert tuple(key for _, key in only.labels) == seeded_order(SEEING)
    assert [label for label, _ in only.labels] == ["A", "B", "C"]


@pytest.mark.parametrize("orders", [OrderSet.REVERSED, OrderSet.ALL])
def test_letters_and_positions_move_apart(orders: OrderSet) -> None:
    found = presentations_of(SEEING, orders)
    letter_of = {key: label for label, key in found[0].labels}
    for order in {each.order for each in found} - {0}:
        by_position, by_key = (
            next(p for p in found if p.order == order and p.labelling is labelling)
            for labelling in (Labelling.POSITION, Labelling.KEY)
        )
        assert [k for _, k in by_position.labels] == [k for _, k in by_key.labels]
        assert [label for label, _ in by_position.labels] == ["A", "B", "C"]
        assert {key: label for label, key in by_key.labels} == letter_of


def test_two_adds_the_reverse_and_all_is_every_permutation() -> None:
    def orders(which: OrderSet) -> list[tuple[str, ...]]:
        found = presentations_of(SEEING, which)
        return list(dict.fromkeys(tuple(key for _, key in p.labels) for p in found))

    shown = seeded_order(SEEING)
    assert orders(OrderSet.REVERSED) == [shown, shown[::-1]]
    assert orders(OrderSet.ALL)[:2] == [shown, shown[::-1]]
    assert sorted(orders(OrderSet.ALL)) == sorted(itertools.permutations(shown))


def test_more_than_four_alternatives_are_rotated_so_that_each_stands_everywhere() -> None:
    six = question(Slot.GLANCE)
    keys = six.keys
    found = presentations_of(six, OrderSet.ALL)
    if len(keys) > 4:
        assert len({p.order for p in found}) == 2 * len(keys)
    for place in range(len(keys)):
        assert {p.labels[place][1] for p in found} == set(keys)


def test_a_cardinal_form_has_no_order_to_change() -> None:
    inverted = question(Slot.SEEING, form=Form.DEGREES)
    assert len(presentations_of(inverted, OrderSet.ALL)) == 1


def test_every_recorded_question_is_asked_in_order() -> None:
    with open_trace(GOLDEN) as trace:
        asked = [e.decision for e in trace.decisions() if isinstance(e.request, Ask)]
    rows = records(first_letter(), OrderSet.RECORDED)
    assert [row["decision"] for row in rows] == asked
    assert count_queries([GOLDEN], OrderSet.RECORDED) == len(rows)
    assert len({row["trace_sha256"] for row in rows}) == 1


def test_the_same_comes_back_however_many_are_asked_at_once() -> None:
    def decided(at_once: int) -> list[tuple[int, int, str | None]]:
        ranker = AskingRanker(Scripted(lambda prompt: prompt.labels[-1][0]))
        found = reevaluate([GOLDEN], ranker, OrderSet.REVERSED, at_once=at_once)
        rows = [record_of(each, "x") for each in found]
        return [(row["decision"], row["order"], row["winner"]) for row in rows]

    assert decided(1) == decided(4)


def test_nothing_is_answered_from_memory() -> None:
    sent: list[str] = []

    def say(prompt: object) -> str:
        sent.append("once")
        return "A"

    for _ in range(2):
        list(reevaluate([GOLDEN], AskingRanker(Scripted(say)), OrderSet.RECORDED))
    assert len(sent) >= 2 * count_queries([GOLDEN], OrderSet.RECORDED)


def test_a_letter_habit_and_a_position_habit_are_told_apart() -> None:
    letters = {s.slot: s for s in summarise(records(first_letter(), OrderSet.ALL))}["seeing"]
    places = {s.slot: s for s in summarise(records(first_shown(), OrderSet.ALL))}["seeing"]
    # Kept letters, other positions: only the position habit changes its mind.
    assert letters.position.estimate == 1.0 and places.position.estimate == 0.0
    # Kept positions, other letters: only the letter habit does.
    assert letters.letter.estimate < 0.5 and places.letter.estimate == 1.0
    assert letters.first_letter is not None and places.first is not None
    assert letters.first_letter.estimate == pytest.approx(places.first.estimate)
    assert places.first.estimate > 0.3


def test_the_file_reads_back_and_says_what_it_is(tmp_path: Path) -> None:
    rows = records(first_letter(), OrderSet.REVERSED)
    write_table(rows, tmp_path / "re.parquet")
    found = read_table(tmp_path / "re.parquet")
    assert [list(row) for row in found] == [list(COLUMNS)] * len(rows)
    assert found == [dict(row) for row in rows]
    assert all(row["open_loop"] for row in found)
    other = tmp_path / "other.parquet"
    other.write_bytes(b"no table")
    with pytest.raises(InputError, match="expected a re-evaluation"):
        read_table(other)


def test_rankings_are_over_keys_in_the_recorded_names() -> None:
    row = records(first_letter(), OrderSet.RECORDED)[0]
    assert row["winner"] == row["keys"][0] == row["ranking"][0][0]
    assert sorted(key for tier in row["ranking"] for key in tier) == sorted(row["keys"])


def test_what_cannot_be_read_gets_one_repair() -> None:
    ranker = AskingRanker(Scripted(lambda prompt: "no idea at all"), AskingConfig(repairs=1))
    rows = records(ranker, OrderSet.RECORDED)
    ordinal = [row for row in rows if row["form"] in ("ordinal", "action")]
    assert {row["outcome"] for row in ordinal} == {"invalid"}
    assert all(row["repaired"] and row["queries"] == 2 for row in ordinal)
    assert all(row["winner"] is None and row["reason"] for row in ordinal)


def test_an_exhausted_ranker_stops_it() -> None:
    ranker = AskingRanker(Scripted({slot: ["A"] for slot in Slot}))
    with pytest.raises(RankerStopped):
        list(reevaluate([GOLDEN], ranker, OrderSet.ALL))


@pytest.mark.parametrize("name", ["human", "simulated", "nobody"])
def test_who_needs_a_running_episode_cannot_answer_a_record(name: str) -> None:
    with pytest.raises(UsageError, match="answers recorded questions"):
        ranker_for(name)


def test_the_command_writes_the_file_and_says_that_it_is_open_loop(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "re.parquet"
    words = ["reeval", str(GOLDEN), "--ranker", "random", "--orders", "2", "--out", str(out)]
    with pytest.raises(SystemExit) as stopped:
        main([*words, "--json"])
    assert stopped.value.code == 0
    said = json.loads(capsys.readouterr().out)
    assert said["rows"] == len(read_table(out)) == count_queries([GOLDEN], OrderSet.REVERSED)
    assert "open-loop" in said["what"]


def test_a_permuted_prompt_still_means_the_same_alternatives() -> None:
    ranker = AskingRanker(
        Scripted(lambda prompt: Ordering.winner_only(prompt.question.keys[0], prompt.question.keys))
    )
    rows = [r for r in records(ranker, OrderSet.ALL) if r["form"] == "ordinal"]
    by_decision: dict[int, set[str | None]] = {}
    for row in rows:
        by_decision.setdefault(row["decision"], set()).add(row["winner"])
    assert all(len(winners) == 1 and None not in winners for winners in by_decision.values())


def test_an_answer_cache_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = str(tmp_path / "re.parquet")
    with pytest.raises(SystemExit) as stopped:
        main(["reeval", str(GOLDEN), "--ranker", "random", "--ranker-opt", "cache=x", "--out", out])
    assert stopped.value.code == 2
    assert "no answer cache" in capsys.readouterr().err
