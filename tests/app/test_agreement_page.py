"""The agreement page: the command's figures, the decisions behind a cell, what stays covered."""

from __future__ import annotations

import re
import threading
from collections import Counter
from html import unescape
from pathlib import Path

import pytest
from fastapi import FastAPI
from starlette.testclient import TestClient

from app.commands.sources import opened_traces
from app.gateway import agreement as gateway
from app.gateway import agreement_desk
from app.gateway.agreement import mount_agreement
from app.gateway.agreement_desk import AgreementDesk
from app.pages.page import MENU
from app.reviews.agreement import agreements, order_effects
from app.reviews.answers import Answer, Answers, Rater
from app.reviews.desk import Desk
from app.reviews.reading import Questions, read_answers
from app.reviews.study import Person, Study
from app.reviews.submissions import Submission
from app.reviews.truth import best_elected
from app.session.assessing import Assessor
from app.session.story import story_of
from c2nav_engine.contract.question import Slot
from c2nav_engine.experiments.spec import Setting
from tests.helpers import stage
from tests.helpers.judged import RANKER, judged_run, study_with
from tests.helpers.meshes import slab, surface_of


def judge(study: Study, *people: Person, most: int = 1000) -> None:
    """Everybody answers: the first one always in the order shown, others in turns reversed."""
    desk = Desk(study)
    for who, person in enumerate(people):
        for _ in range(most):
            handed = desk.next(person)
            if handed is None:
                break
            labels = [label for label, _ in handed.prompt.labels]
            turned = labels[::-1] if who and handed.number % 3 == 0 else labels
            tiers = tuple((label,) for label in turned)
            desk.submit(person, Submission(f"{handed.number:032x}", handed.number, tiers))
    desk.close()


@pytest.fixture(scope="module")
def judged(tmp_path_factory: pytest.TempPathFactory) -> Path:
    run = judged_run(tmp_path_factory.mktemp("agreement"), episodes=4, cycles=3)
    study, people = study_with(run, "ann", "bob", per_slot=6)
    judge(study, *(person for person, _ in people))
    return run


def client(run: Path) -> TestClient:
    app = FastAPI()
    traces = sorted((run / "traces").glob("*.mcap"))
    mount_agreement(app, opened_traces(traces, Setting(source="builtin")), menu=tuple(MENU))
    return TestClient(app)


@pytest.fixture(autouse=True)
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """However slow the machine, the page is waited for."""
    monkeypatch.setattr(gateway, "PATIENCE_S", 60.0)


def words(page: str) -> str:
    return " ".join(unescape(re.sub(r"<[^>]+>", " ", page)).split())


def test_the_page_says_how_far_the_reading_is_and_comes_by_itself(
    judged: Path, monkeypatch: pytest.MonkeyPatch
):
    gate = threading.Event()
    read = agreement_desk.of_trace

    def second_waits(path: Path, asked: Questions) -> Answers:
        if asked:
            gate.wait()
        return read(path, asked)

    monkeypatch.setattr(agreement_desk, "of_trace", second_waits)
    monkeypatch.setattr(gateway, "PATIENCE_S", 0.0)
    browser = client(judged)
    page = browser.get("/agreement").text
    assert "data-again" in page
    assert re.search(r"reading traces: [01] of 4", words(page))
    gate.set()
    monkeypatch.setattr(gateway, "PATIENCE_S", 60.0)
    assert "data-again" not in browser.get("/agreement").text


def test_the_page_shows_the_figures_of_the_command(judged: Path):
    answers = read_answers([judged])
    page = client(judged).get("/agreement").text
    text = words(page)
    for row in agreements(answers):
        if row.slot == "all" and row.top1 is not None:
            top1 = row.top1
            assert row.chance is not None
            figure = (
                f"{100 * top1.estimate:.0f} ({100 * top1.low:.0f}–{100 * top1.high:.0f}) "
                f"chance {100 * row.chance:.0f}"
            )
            name = f"{row.a} · {row.b}" if row.a else "all pairs"
            assert f"{name} {row.questions} {row.episodes} episodes {figure}" in text
    for effect in order_effects(answers):
        assert effect.rater.name in text
    assert "People among themselves" in text
    assert "People and models" in text
    assert "ann" not in text.split()


def test_a_cell_opens_exactly_its_decisions(judged: Path):
    page = client(judged)
    answers = read_answers([judged])
    for row in agreements(answers):
        for (a, b), count in row.confusion.items():
            if row.slot == "all" or not row.a:
                continue
            asked = {"kind": row.kind, "a": row.a, "b": row.b, "slot": row.slot}
            behind = page.get("/agreement", params=asked | {"said_a": a, "said_b": b}).text
            opened = re.findall(r'data-open="([^"]+)" data-at="(\d+)"', behind)
            assert len(opened) == count
            assert len(set(opened)) == count
            assert all(Path(trace).is_file() for trace, _ in opened)


def test_every_count_of_the_chosen_pair_is_a_link(judged: Path):
    page = (
        client(judged).get("/agreement", params={"kind": "human-human", "a": "P1", "b": "P2"}).text
    )
    counts = Counter(
        {
            row.slot: sum(row.confusion.values())
            for row in agreements(read_answers([judged]))
            if (row.a, row.b) == ("P1", "P2") and row.slot != "all"
        }
    )
    linked = re.findall(r"said_b=[^\"]+\">(\d+)</a>", page)
    assert sum(map(int, linked)) == sum(counts.values()) > 0


def test_what_people_add_shows_without_reading_traces_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    run = judged_run(tmp_path, episodes=2, cycles=2)
    study, ((ann, _), (bob, _)) = study_with(run, "ann", "bob", per_slot=2)
    page = client(run)
    assert "people 0" in words(page.get("/agreement").text)
    judge(study, ann)

    def never(*_: object) -> Answers:
        raise AssertionError("the traces were read again")

    monkeypatch.setattr(agreement_desk, "of_trace", never)
    assert "people 1" in words(page.get("/agreement").text)
    judge(study, bob, most=1)
    assert "people 2" in words(page.get("/agreement").text)


def test_the_best_alternative_stays_covered_until_everybody_has_answered(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    run = judged_run(tmp_path, episodes=3, cycles=2)
    study, ((ann, _), (bob, _)) = study_with(run, "ann", "bob", per_slot=3)
    judge(study, ann)
    page = client(run)
    asked: list[int] = []

    def best(desk: AgreementDesk) -> dict[str, str]:
        asked.append(1)
        return {answer.question: answer.keys[0] for answer in desk.answers().given}

    monkeypatch.setattr(AgreementDesk, "best", best)
    total = len(study.queue(ann.queue)) + len(study.queue(bob.queue))
    for address in ("/agreement", "/agreement?best=1"):
        text = words(page.get(address).text)
        assert f"{total // 2} of {total} places are" in text
        assert "◆ geodesically best, %" not in text
    assert asked == []
    judge(study, bob)
    assert "Hold everybody against" in words(page.get("/agreement").text)
    assert asked == []
    assert "◆ geodesically best, %" in words(page.get("/agreement?best=1").text)


def test_a_pair_of_one_slot_and_one_episode_stands_under_all_slots_without_an_interval(
    tmp_path: Path,
):
    run = judged_run(tmp_path, episodes=1, cycles=1)
    study, ((ann, _),) = study_with(run, "ann", per_slot=1)
    judge(study, ann, most=1)
    (pair,) = [row for row in agreements(read_answers([run])) if row.kind == "human-model"]
    assert (pair.questions, pair.episodes) == (1, 1)
    assert pair.slot != "all"
    assert pair.top1 is not None
    share = f"{100 * pair.top1.estimate:.0f} chance"
    assert f"P1 · {RANKER} 1 1 episode {share}" in words(client(run).get("/agreement").text)


def test_without_a_floor_it_says_what_to_do(judged: Path):
    text = words(client(judged).get("/agreement?best=1").text)
    assert "◆ geodesically best, %" not in text
    assert "--scenes DIR" in text or "expected" in text


def test_shares_of_the_best_count_what_elected_something():
    ann, model = Rater("P1", human=True), Rater("m", human=False)
    keys = ("front", "left", "right")
    given = [
        Answer(ann, "q1", "e1", "seeing", keys, (("left",), ("front", "right"))),
        Answer(ann, "q2", "e1", "seeing", keys, (("front",), ("left", "right"))),
        Answer(ann, "q3", "e2", "seeing", keys, (("left", "right"),)),
        Answer(ann, "q4", "e2", "seeing", keys, (("left",),)),
        Answer(model, "q1", "e1", "seeing", keys[:2], (("left",), ("front",))),
    ]
    best = {"q1": "left", "q2": "left", "q3": "left"}
    rows = {(r.rater.name, r.slot): r for r in best_elected(Answers(tuple(given), ()), best)}
    assert (rows["P1", "all"].share.estimate, rows["P1", "seeing"].share.n) == (0.5, 2)
    assert rows["P1", "all"].chance == pytest.approx(1 / 3)
    assert (rows["m", "all"].share.estimate, rows["m", "all"].chance) == (1.0, 0.5)


def test_a_run_without_people_shows_its_models_and_no_page_stands_for_episodes(tmp_path: Path):
    run = judged_run(tmp_path, episodes=1, cycles=2)
    alone = client(run).get("/agreement").text
    assert RANKER in alone
    assert "Nobody else has answered" in words(alone)
    assert "all pairs" not in words(alone)
    app = FastAPI()
    source = opened_traces(sorted((run / "traces").glob("*.mcap")), Setting(source="builtin"))
    entries = tuple(type(e)("7", e.label) for e in source.entries)
    named = type(source)(source.title, entries, source.first, source.open)
    mount_agreement(app, named, menu=tuple(MENU))
    assert TestClient(app).get("/agreement").status_code == 404


def test_the_best_offered_alternative_has_no_regret():
    """One floor, two ways of saying it: regret is nothing where the best one was elected."""
    surface = surface_of([slab(-9.0, -6.0, 9.0, 6.0)])
    run = stage.finished_run(8)
    story = story_of(run.header, run.exchanges, pending=None, footer=run.footer)
    assessor = Assessor(run.header, lambda: surface)
    best, assessed = assessor.best_offered(story), assessor.assess(story, ())
    seeing = [one for one in story.decisions if one.slot is Slot.SEEING]
    assert set(best) == {one.number for one in seeing}
    for one in seeing:
        regret_m = assessed[one.number].regret_m
        assert regret_m is not None
        # Two views whose motions end equally near are both best; one of them is named.
        if one.elected == best[one.number]:
            assert regret_m < 0.01
    assert any(one.elected == best[one.number] for one in seeing)
