"""Answers of a re-evaluation beside the recorded ones: `c2nav inspect TRACE --with FILE`."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from app.cli import main
from app.commands.sources import opened_traces
from app.inspector.panels.answers import answers_table
from app.session import commands as c
from app.session.differing import disagrees, winner
from app.session.handling import handle
from app.session.reasked import Reasked, shared_until
from app.session.snapshot import Snapshot
from app.session.timeline import timeline_of
from app.session.worker import Session
from c2nav_engine.contract.outcome import Invalid, Ordering
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.reeval import OrderSet, reevaluate
from c2nav_engine.experiments.reeval_table import read_table, record_of, write_table
from c2nav_engine.experiments.spec import Setting
from c2nav_engine.rankers.scripted import Scripted
from c2nav_engine.rankers.wrapper import AskingRanker
from tests.helpers import stage

GOLDEN = Path(__file__).resolve().parents[1] / "golden" / "trace-v1.mcap"


@pytest.fixture(scope="module")
def first_letter(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The golden trace, asked again of a ranker that always says A, in both orders."""
    ranker = AskingRanker(Scripted(lambda prompt: "A"))
    rows = [record_of(each, "letter A") for each in reevaluate([GOLDEN], ranker, OrderSet.REVERSED)]
    path = tmp_path_factory.mktemp("again") / "again.parquet"
    write_table(rows, path)
    return path


@pytest.fixture(scope="module")
def opened(first_letter: Path) -> Snapshot:
    source = opened_traces([GOLDEN], Setting(source="builtin"), beside=[first_letter])
    return Session(source).snapshot


def at(snapshot: Snapshot, number: int) -> Snapshot:
    return replace(snapshot, stop=snapshot.story.stop_of_decision(number))


def asked(snapshot: Snapshot) -> list[int]:
    return [d.number for d in snapshot.story.decisions if snapshot.reasked_at(d.number)]


def test_every_recorded_question_has_its_new_answers(opened: Snapshot, first_letter: Path):
    rows = read_table(first_letter)
    assert asked(opened) == sorted({row["decision"] for row in rows})
    for row in rows:
        said = [
            answer.outcome
            for answer in opened.reasked_at(row["decision"])
            if answer.shown == tuple(row["keys"])
            and answer.letters_kept == (row["labelling"] == "key")
        ]
        assert [winner(outcome) for outcome in said] == [row["winner"]]


def test_the_table_has_a_row_for_each_way_of_lettering(opened: Snapshot):
    number = asked(opened)[0]
    table = answers_table(at(opened, number))
    assert "letter A · asked again<" in table
    assert "letter A · asked again, letters kept<" in table
    # A was said whatever stood there: with moving letters that elects two views.
    assert "orders disagree" in table


def test_cells_that_differ_from_the_recording_are_marked(opened: Snapshot):
    for number in asked(opened):
        here = at(opened, number)
        decision = here.decision
        assert decision is not None
        assert decision.ranked is not None
        recorded = winner(decision.ranked.outcome)
        differing = [a for a in here.reasked_at(number) if winner(a.outcome) != recorded]
        without = answers_table(replace(here, reasked={}))
        assert answers_table(here).count("✕") == without.count("✕") + len(differing)


def test_brackets_and_timeline_find_the_disagreements(opened: Snapshot):
    found = [d.number for d in opened.story.decisions if disagrees(opened, d, "reasked")]
    assert found
    marks = [e for e in timeline_of(opened)["events"] if e["sign"] == "≠"]
    assert [mark["step"] for mark in marks] == [opened.story.decisions[n].step for n in found]


def test_the_bracket_key_goes_to_the_next_one(first_letter: Path):
    source = opened_traces([GOLDEN], Setting(source="builtin"), beside=[first_letter])
    desk = Session(source)._desk
    handle(desk, c.Seek(kind="reasked"))
    wanted = [
        d.number for d in desk.snapshot.story.decisions if disagrees(desk.snapshot, d, "reasked")
    ]
    here = desk.snapshot.here.decision
    handle(desk, c.Jump(to="next_disagreement"))
    assert desk.snapshot.here.decision == min(n for n in wanted if n > here)


def test_an_unusable_answer_is_marked_but_is_no_disagreement():
    plain = Session(stage.opened_recording()).snapshot
    decision = plain.story.decisions[0]
    bad = Reasked("other", tuple(decision.letters), letters_kept=False, outcome=Invalid("prose"))
    snapshot = at(replace(plain, reasked={0: (bad,)}), 0)
    assert "no usable answer: prose <span" in answers_table(snapshot)
    assert not disagrees(snapshot, decision, "reasked")


def test_a_fork_shares_its_questions_up_to_where_it_left():
    plain = Session(stage.opened_recording()).snapshot
    root = plain.branch
    fork = replace(root, branch_id="b1", parent="b0", fork_decision=4)
    again = replace(root, branch_id="b2", parent="b1", fork_decision=7)
    branches = (root, fork, again)
    assert [shared_until(b, branches) for b in branches] == [None, 4, 4]
    said = Reasked("other", ("a",), letters_kept=False, outcome=Ordering.of("a"))
    snapshot = replace(
        plain, branches=branches, branch=again, reasked=dict.fromkeys(range(9), (said,))
    )
    assert [n for n in range(9) if snapshot.reasked_at(n)] == [0, 1, 2, 3, 4]


def test_a_re_evaluation_of_another_trace_is_refused(tmp_path: Path, first_letter: Path):
    rows = [
        row | {"trace_sha256": "0" * 64, "trace": "other.mcap"} for row in read_table(first_letter)
    ]
    strange = tmp_path / "strange.parquet"
    write_table(rows, strange)
    with pytest.raises(UsageError, match=r"which is of other\.mcap"):
        opened_traces([GOLDEN], Setting(source="builtin"), beside=[strange])


def test_live_episodes_have_nothing_to_stand_beside(
    capsys: pytest.CaptureFixture[str], first_letter: Path
):
    with pytest.raises(SystemExit) as ended:
        main(["inspect", "builtin", "--with", str(first_letter)])
    assert ended.value.code == 2
    assert "beside --with" in capsys.readouterr().err
