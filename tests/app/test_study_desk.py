"""A study from freezing to import: nothing lost, nothing doubled, nothing told too early."""

from __future__ import annotations

import json
import threading
from dataclasses import replace
from pathlib import Path

import pytest

from app.cli import main
from app.reviews.desk import LEASE_S, Desk, Taken
from app.reviews.events import Event, Kind
from app.reviews.importing import import_answers
from app.reviews.questions import prompt_at
from app.reviews.queues import Place
from app.reviews.state import standing
from app.reviews.store import Store, shared_events, store_of
from app.reviews.study import Person, Study, add_person, make_study, read_study
from app.reviews.submissions import Submission, said_by
from c2nav_engine.contract.outcome import Abstention, Ordering, Tie
from c2nav_engine.errors import UsageError
from c2nav_engine.runner.recorded import open_trace
from tests.helpers.judged import amendments, judged_run, study_with


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return judged_run(tmp_path_factory.mktemp("judged"), episodes=9, cycles=3)


@pytest.fixture
def run(made: Path, tmp_path: Path) -> Path:
    """A run of its own for each test; the traces are shared."""
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "traces").symlink_to(made / "traces")
    return tmp_path / "run"


def answer(number: int, *, salt: int = 0, tiers: tuple[tuple[str, ...], ...] = (("A",),)):
    return Submission(f"{number * 1000 + salt:032x}", number, tiers, response_ms=1200)


def judge_all(desk: Desk, person: Person, *, salt: int = 0) -> list[int]:
    numbers: list[int] = []
    while (handed := desk.next(person)) is not None:
        desk.submit(person, answer(handed.number, salt=salt))
        numbers.append(handed.number)
    return numbers


def test_a_study_is_frozen_with_hashes_and_amended_with_dates(run: Path):
    study, ((ann, token),) = study_with(run, "Ann Example")
    for number, item in enumerate(study.items):
        with open_trace(study.trace(number)) as trace:
            assert trace.sha256 == item.trace_sha256
    with pytest.raises(UsageError, match="frozen"):
        make_study([run], name="first", per_slot=2, seed=3, repeat=0.0)
    (amendment,) = amendments(study)
    assert str(amendment["when"]).startswith("20")
    assert token not in (study.folder / "amendments.jsonl").read_text("utf-8")
    assert study.holder(token) == ann
    assert study.holder("x" + token) is None
    again, renewed = add_person(study, "Ann Example")
    assert (again.pseudonym, again.queue) == (ann.pseudonym, ann.queue)
    assert study.holder(token) is None
    assert study.holder(renewed) == again


def test_a_question_is_the_recorded_bytes_and_comes_back_reshuffled(run: Path):
    study, _ = study_with(run)
    item = study.items[0]
    with open_trace(study.trace(0)) as trace:
        ranked = trace.decision(item.decision).ranked
    assert ranked is not None
    sent = ranked.queries[0].prompt
    first, again = prompt_at(study, Place(0)), prompt_at(study, Place(0, again=True))
    assert first.parts == sent.parts
    assert {key for _, key in again.labels} == {key for _, key in sent.labels}
    assert all(a != b for a, b in zip(again.labels, sent.labels, strict=True))


def test_a_person_answers_their_whole_queue_once(run: Path):
    study, ((ann, _), (bob, _)) = study_with(run, "ann", "bob")
    desk = Desk(study)
    assert judge_all(desk, ann) == list(range(len(study.queue(ann.queue))))
    assert judge_all(desk, bob) == list(range(len(study.queue(bob.queue))))
    assert len(study.queue(ann.queue)) == len(study.items) + len(study.repeats)
    assert desk.progress()[ann.queue] == (len(study.queue(ann.queue)),) * 2
    desk.close()


def test_an_answer_sent_twice_is_stored_once_and_another_is_refused(run: Path):
    study, ((ann, _),) = study_with(run, "ann")
    desk = Desk(study)
    handed = desk.next(ann)
    assert handed is not None
    desk.submit(ann, answer(0))
    desk.submit(ann, answer(0))
    with pytest.raises(Taken):
        desk.submit(ann, answer(0, salt=1))
    with pytest.raises(UsageError, match="expected a place"):
        desk.submit(ann, answer(10_000))
    assert desk.progress()[ann.queue][0] == 1
    desk.close()


def test_a_queue_goes_on_where_it_stood_after_everything_was_closed(run: Path):
    study, ((ann, _),) = study_with(run, "ann")
    first = Desk(study)
    first.submit(ann, answer(0))
    shown = first.next(ann)
    first.close()
    second = Desk(read_study(run, "first"))
    assert second.next(ann) == shown
    second.close()


def test_undo_brings_the_last_question_back_and_stays_on_record(run: Path):
    study, ((ann, _),) = study_with(run, "ann")
    desk = Desk(study)
    assert not desk.undo(ann)
    for number in range(2):
        desk.submit(ann, answer(number))
    assert desk.undo(ann)
    handed = desk.next(ann)
    assert handed is not None
    assert handed.number == 1
    desk.submit(ann, answer(1, salt=5))
    desk.close()
    with store_of(run) as store:
        kinds = [event.kind for event in store.events()]
    assert kinds == [Kind.RANKING, Kind.RANKING, Kind.UNDO, Kind.RANKING]


def test_people_of_one_queue_never_hold_the_same_item(run: Path):
    study, ((ann, _), (bob, _)) = study_with(run, "ann", "bob", queue="both", repeat=0.0)
    now_s = [1000.0]
    desk = Desk(study, clock=lambda: now_s[0])
    hers, his = desk.next(ann), desk.next(bob)
    assert hers is not None
    assert his is not None
    assert hers.number != his.number
    with pytest.raises(Taken):
        desk.submit(bob, answer(hers.number))
    now_s[0] += LEASE_S + 1.0
    desk.submit(bob, answer(hers.number, salt=1))
    with pytest.raises(Taken):
        desk.submit(ann, answer(hers.number))
    desk.close()


def test_a_shared_queue_is_finished_without_loss_or_doubling(run: Path):
    study, people = study_with(run, "ann", "bob", queue="both", repeat=0.0)
    desks = [Desk(study), Desk(study)]
    threads = [
        threading.Thread(target=judge_all, args=(desk, person), kwargs={"salt": salt})
        for salt, (desk, (person, _)) in enumerate(zip(desks, people, strict=True))
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for desk, (person, _) in zip(desks, people, strict=True):
        judge_all(desk, person, salt=7)
        desk.close()
    with store_of(run) as store:
        places = [event.extra["place"] for event in standing(store.events())]
    assert len(places) == len(set(places))
    assert len(places) >= len(study.items) * 0.9
    _ascending(run)


def _ascending(run: Path) -> None:
    seen: dict[tuple[str, str], int] = {}
    with store_of(run) as store:
        for event in store.events():
            name = (event.author, event.extra["episode"])
            assert event.decision >= seen.get(name, 0)
            seen[name] = event.decision


def test_a_trace_that_was_exchanged_is_not_shown(run: Path, made: Path):
    study, ((ann, _),) = study_with(run, "ann")
    other = replace(study, items=tuple(replace(i, trace_sha256="f" * 64) for i in study.items))
    desk = Desk(other)
    with pytest.raises(UsageError, match="put back the file"):
        desk.next(ann)
    desk.close()


def test_labels_become_keys_and_nothing_else_is_taken(run: Path):
    study, _ = study_with(run)
    prompt = prompt_at(study, Place(0))
    (_, first), *rest = prompt.labels
    assert said_by((("A",),), prompt) == Ordering.winner_only(
        first, tuple(dict(prompt.labels).values())
    )
    assert isinstance(said_by((("A", "B"),), prompt), Tie)
    assert said_by((), prompt) == Abstention("none")
    assert rest
    for odd in ((("A",), ("A",)), (("Z",),), ((),)):
        with pytest.raises(UsageError, match="expected tiers"):
            said_by(odd, prompt)


@pytest.fixture
def returned(run: Path) -> tuple[Study, list[Event]]:
    """A study whose answers were exported and then begun afresh."""
    study, ((ann, _),) = study_with(run, "ann")
    desk = Desk(study)
    for number in range(4):
        desk.submit(ann, answer(number))
    desk.close()
    with store_of(run) as store:
        events = shared_events(store)
    for path in run.glob("reviews.sqlite*"):
        path.unlink()
    return study, events


def test_answers_come_back_under_their_names(returned, run: Path):
    study, events = returned
    with Store(run / "reviews.sqlite") as store:
        assert import_answers(study, store, events, where="f") == 4
        assert {event.author for event in store.events()} == {"ann"}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"trace_sha256": "e" * 64}, "expected decision"),
        ({"decision": 9999}, "expected decision"),
        ({"author": "P99"}, "expected a person"),
        ({"study_sha256": "e" * 64}, "expected study"),
        ({"queue": "elsewhere"}, "expected"),
    ],
)
def test_a_wrong_file_is_refused_whole(returned, run: Path, change: dict[str, str], words: str):
    study, events = returned
    plain = {name: value for name, value in change.items() if name not in ("study_sha256", "queue")}
    extra = {name: value for name, value in change.items() if name not in plain}
    bad = replace(events[2], **plain, extra={**events[2].extra, **extra})
    with Store(run / "reviews.sqlite") as store:
        with pytest.raises(UsageError, match=words):
            import_answers(study, store, [*events[:2], bad], where="f")
        assert store.events() == []


def test_what_was_said_in_the_inspector_comes_along(returned, run: Path):
    study, events = returned
    said = Event("x1", Kind.WRONG, "P9", study.items[0].trace_sha256, 2, blind=False)
    undo = Event("x2", Kind.UNDO, "P9", said.trace_sha256, 2, target="x1")
    with Store(run / "reviews.sqlite") as store:
        assert import_answers(study, store, [*events, said, undo], where="f") == 6
        assert store.events()[-2:] == [said, undo]


def test_doubled_items_are_refused(returned, run: Path):
    study, events = returned
    double = replace(events[1], id="another")
    with Store(run / "reviews.sqlite") as store:
        with pytest.raises(UsageError, match="already"):
            import_answers(study, store, [*events, double], where="f")
        import_answers(study, store, events, where="f")
        with pytest.raises(UsageError, match="already"):
            import_answers(study, store, events, where="f")
        assert len(store.events()) == 4


def command(*words: str | Path) -> int:
    with pytest.raises(SystemExit) as stopped:
        main([str(word) for word in words])
    return int(stopped.value.code or 0)


def test_the_command_makes_adds_tells_and_exports(run: Path, tmp_path: Path, capsys):
    made = ("study", "make", run, "--name", "n", "--per-slot", "2", "--seed", "3", "--json")
    assert command(*made) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["items"] == sum(told["slots"].values())
    assert command("study", "add-person", run, "--name", "n", "--person", "ann", "--json") == 0
    assert "/judge?token=" in json.loads(capsys.readouterr().out)["link"]
    assert command("study", "status", run, "--name", "n", "--json") == 0
    (person,) = json.loads(capsys.readouterr().out)["people"]
    assert (person["answered"], person["pseudonym"]) == (0, "P1")
    out = tmp_path / "out.jsonl"
    assert command("study", "export", run, "--out", out, "--json") == 0
    assert out.read_text("utf-8") == ""
    assert command(*made) == 2
    assert command("study", "status", run, "--name", "other") == 2
    assert command("study", "status", tmp_path / "nowhere", "--name", "n") == 2


def test_who_shares_a_queue_or_is_unknown_gets_no_page(run: Path, tmp_path: Path, capsys):
    study_with(run, "ann", "bob", queue="both")
    packing = ("study", "pack", run, "--name", "first", "--out", tmp_path / "out")
    assert command(*packing) == 2
    assert "share one" in capsys.readouterr().err
    assert command(*packing, "--person", "eve") == 2
    assert "it has ann, bob" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
