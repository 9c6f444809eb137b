"""Rankings made in the inspector: blind ones are a person's answers, others stand apart."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from fastapi import FastAPI
from starlette.testclient import TestClient

from app.cli import main
from app.commands.sources import opened_traces
from app.gateway.agreement import mount_agreement
from app.pages.page import MENU
from app.reviews.agreement import agreements, kind_of
from app.reviews.agreement_grids import human_study
from app.reviews.answers import Answer
from app.reviews.audit import AuditBook, store_beside
from app.reviews.desk import Desk
from app.reviews.events import Event
from app.reviews.reading import read_answers
from app.reviews.store import export_lines, store_of
from app.reviews.submissions import Submission
from app.session import commands as c
from app.session.worker import Session
from c2nav_engine.contract.outcome import Ordering
from c2nav_engine.experiments.reeval import OrderSet, reevaluate
from c2nav_engine.experiments.reeval_table import record_of, write_table
from c2nav_engine.experiments.spec import Setting
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.rankers.scripted import Scripted
from c2nav_engine.rankers.wrapper import AskingRanker
from c2nav_engine.runner.recorded import open_trace
from tests.helpers.judged import RANKER, judged_run, study_with
from tests.helpers.watched import Watched


@pytest.fixture
def run(tmp_path: Path) -> Path:
    return judged_run(tmp_path, episodes=1, cycles=3)


def trace_of(run: Path) -> Path:
    return run / "traces" / "0.full.0.mcap"


def book_of(run: Path) -> AuditBook:
    with open_trace(trace_of(run)) as trace:
        return AuditBook(store_beside(trace.path), trace.sha256)


def asked_in(run: Path) -> dict[int, tuple[str, ...]]:
    """Decision → keys, of every recorded question that asked for an order."""
    with open_trace(trace_of(run)) as trace:
        return {
            exchange.decision: exchange.request.question.keys
            for exchange in trace.decisions()
            if isinstance(exchange.request, Ask)
            and exchange.ranked is not None
            and exchange.decision is not None
        }


def of_people(run: Path) -> list[Answer]:
    return [answer for answer in read_answers([run]).given if answer.rater.human]


def told(capsys: pytest.CaptureFixture[str], *what: Path) -> dict[str, Any]:
    with pytest.raises(SystemExit) as stopped:
        main(["agree", *map(str, what), "--json"])
    assert stopped.value.code == 0
    return json.loads(capsys.readouterr().out)


def test_a_ranking_under_a_cover_is_counted_like_an_answer(run: Path):
    opened = opened_traces([trace_of(run)], Setting(source="builtin"))
    session = Session(replace(opened, blind=True))
    seen = Watched(session)
    seen.do(c.Name(who="ann"))
    drawn = seen.until(lambda s: s.covered and s.who == "ann")
    assert drawn.decision is not None
    best = next(iter(drawn.decision.letters))
    seen.do(c.Press(key=best))
    seen.until(lambda s: not s.draft.empty)
    seen.do(c.Commit())
    seen.until(lambda s: not s.covered)
    session.close()
    (answer,) = of_people(run)
    model = next(a for a in read_answers([run]).given if a.rater.name == RANKER)
    assert (answer.winner, answer.rater.name, answer.beside_map) == (best, "P1", True)
    assert (answer.question, answer.episode, answer.slot, answer.keys) == (
        *(model.question, model.episode),
        *(model.slot, model.keys),
    )
    annex = human_study([run])
    assert annex is not None
    assert "1 of their rankings were made blind in the inspector" in " ".join(annex.notes)


def test_what_was_ranked_after_seeing_is_no_humans_answer_without_its_mark(run: Path, capsys):
    book = book_of(run)
    (first, keys), (second, others) = list(asked_in(run).items())[:2]
    book.add("ranking", first, who="ann", seen=False, said=Ordering.of(*keys))
    book.add("ranking", second, who="ann", seen=True, said=Ordering.of(*others))
    book.add("ranking", first, who="bob", seen=True, said=Ordering.of(*keys))
    raters = {answer.rater.name: answer.rater for answer in of_people(run)}
    assert {name: rater.seen for name, rater in raters.items()} == {
        "P1": False,
        "P1, answer seen": True,
        "P2, answer seen": True,
    }
    pairs = {(r["kind"], r["a"], r["b"]) for r in told(capsys, run)["agreement"] if r["a"]}
    assert {kind for kind, _, _ in pairs} == {"human-model", "seen"}
    assert [names for kind, *names in pairs if kind == "human-model"] == [["P1", RANKER]]
    assert read_answers([run]).people == ("P1",)
    assert kind_of(raters["P1"], raters["P2, answer seen"]) == "seen"


def test_undone_rankings_and_direct_actions_are_no_answers(run: Path):
    book = book_of(run)
    number, keys = next(iter(asked_in(run).items()))
    book.add("ranking", number, who="ann", seen=False, said=Ordering.of(*keys))
    assert len(of_people(run)) == 1
    book.undo("ann")
    assert of_people(run) == []
    book.add("ranking", 999, who="ann", seen=False, said=Ordering.of("left"))
    assert of_people(run) == []


def test_an_export_of_reviews_is_understood_beside_its_run_in_any_order(run: Path, capsys):
    number, keys = next(iter(asked_in(run).items()))
    book_of(run).add("ranking", number, who="ann", seen=False, said=Ordering.of(*keys))
    out = run.parent / "people.jsonl"
    with store_of(run) as store:
        out.write_text("".join(f"{line}\n" for line in export_lines(store)), encoding="utf-8")
    (run / "reviews.sqlite").rename(run / "elsewhere.sqlite")
    assert of_people(run) == []
    both = told(capsys, out, run)
    assert both["agreement"] == told(capsys, run, out)["agreement"]
    assert {row["kind"] for row in both["agreement"]} == {"human-model"}
    assert both["beside_map"] == 1


def test_an_answer_in_a_study_outranks_one_in_the_inspector(run: Path):
    study, ((ann, _),) = study_with(run, "ann", per_slot=1)
    item = study.items[study.queue(ann.queue)[0].item]
    keys = asked_in(run)[item.decision]
    book_of(run).add("ranking", item.decision, who="ann", seen=False, said=Ordering.of(keys[-1]))
    desk = Desk(study)
    handed = desk.next(ann)
    assert handed is not None
    labels = [label for label, _ in handed.prompt.labels]
    desk.submit(ann, Submission("0" * 16, handed.number, tuple((label,) for label in labels)))
    desk.close()
    (answer,) = of_people(run)
    assert not answer.beside_map
    assert answer.winner == handed.prompt.labels[0][1]


def test_who_had_seen_the_answer_in_the_inspector_is_marked_in_a_study_too(run: Path):
    study, ((ann, _), (bob, _)) = study_with(run, "ann", "bob", per_slot=1)
    last = max(item.decision for item in study.items)
    book_of(run).add("reveal", last, who="ann", seen=True)
    desk = Desk(study)
    for person in (ann, bob):
        handed = desk.next(person)
        assert handed is not None
        best = handed.prompt.labels[0][0]
        desk.submit(person, Submission("0" * 16, handed.number, ((best,),)))
    desk.close()
    assert {a.rater.name for a in of_people(run)} == {"P1, answer seen", "P2"}
    said = [event for event in _events(run) if "study" in event.extra]
    assert [(event.author, event.blind, event.model_seen) for event in said] == [
        ("ann", True, True),
        ("bob", True, False),
    ]


def _events(run: Path) -> list[Event]:
    with store_of(run) as store:
        return store.events()


def test_reevaluations_beside_a_run_are_raters_of_its_page(run: Path, capsys):
    ranker = AskingRanker(Scripted(lambda prompt: "A"))
    paths = [trace_of(run)]
    rows = [record_of(each, "letter A") for each in reevaluate(paths, ranker, OrderSet.REVERSED)]
    again = run.parent / "again.parquet"
    write_table(rows, again)
    opened = opened_traces(paths, Setting(source="builtin"), beside=[again])
    app = FastAPI()
    mount_agreement(app, opened, menu=tuple(MENU), beside=[again])
    page = TestClient(app).get("/agreement").text
    assert "letter A" in page
    pair = next(
        row
        for row in agreements(read_answers([run, again]))
        if {row.a, row.b} == {"letter A", RANKER} and row.slot == "seeing"
    )
    assert pair.top1 is not None
    assert pair.chance is not None
    words = f"{100 * pair.top1.estimate:.0f} <small>chance {100 * pair.chance:.0f}"
    asked = {"slot": "seeing", "kind": "model-model", "a": pair.a, "b": pair.b}
    assert words in TestClient(app).get("/agreement", params=asked).text
    assert {pair.a, pair.b} <= {row["rater"] for row in told(capsys, run, again)["orders"]}
