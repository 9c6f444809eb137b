"""Reviews through the session: what is kept beside the run, and what a covered answer lets out."""

from __future__ import annotations

import inspect
import json
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import fields, replace
from pathlib import Path

import pytest

from app.reviews.audit import AuditBook, store_beside
from app.reviews.events import Event, Kind
from app.reviews.store import Store
from app.session import commands as c
from app.session import veil
from app.session.cards import winner_of
from app.session.snapshot import WHOLE, Snapshot
from app.session.state_json import state_json
from app.session.story import story_of
from app.session.veil import answers_shown
from app.session.worker import Session
from c2nav_engine.contract.outcome import Ordering
from tests.helpers import stage
from tests.helpers.watched import Watched

SHA = "ab" * 32
FILE = "reviews.sqlite"


@contextmanager
def opened(folder: Path, *, blind: bool = False) -> Generator[Watched]:
    """The play's recording with its reviews in a folder."""
    source = stage.opened_recording(
        blind=blind, book=lambda _, sha: AuditBook(folder / FILE, sha, clock=lambda: 7.0)
    )
    session = Session(source)
    yield Watched(session)
    session.close()


def stored(folder: Path) -> list[Event]:
    with Store(folder / FILE) as store:
        return store.events()


def judged(number: int, **wanted: object) -> Callable[[Snapshot], bool]:
    """Whether the judgement of a decision has these values."""

    def holds(snapshot: Snapshot) -> bool:
        said = snapshot.judgements.get(number)
        return said is not None and all(getattr(said, k) == v for k, v in wanted.items())

    return holds


def test_everything_said_is_there_when_the_trace_is_opened_again(tmp_path: Path):
    with opened(tmp_path) as seen:
        for command in (
            c.Name(who="ann"),
            c.Go(decision=2),
            c.Verdict(value="wrong"),
            c.Better(key="left"),
            c.Tag(value="wrong object"),
            c.Flag(),
            c.Remark(text="the door is left"),
            c.LegEnd(leg=0, step=9),
        ):
            seen.do(command)
        before = seen.until(lambda s: WHOLE in s.judgements).reviews["b0"]
    with opened(tmp_path) as seen:
        now = seen.session.snapshot
        assert now.reviews["b0"] == before
        said = before["ann", 2]
        assert (said.verdict, said.better, said.tags) == ("wrong", "left", ("wrong object",))
        assert (said.flagged, said.note, said.blind) == (True, "the door is left", False)
        assert before["ann", WHOLE].leg_ends == {0: 9}
        # Somebody else sits there now: these are the words of another.
        assert now.judgements == {}
        seen.do(c.Go(decision=2))
        assert seen.until(lambda s: s.here.decision == 2).others == {"ann": said}
    assert all(event.trace_sha256 == SHA for event in stored(tmp_path))
    assert all(event.when_s == 7.0 for event in stored(tmp_path))


def test_what_was_answered_cannot_be_the_better_one(tmp_path: Path):
    with opened(tmp_path) as seen:
        seen.do(c.Go(decision=2))
        snapshot = seen.until(lambda s: s.here.decision == 2)
        assert snapshot.decision is not None
        elected = winner_of(snapshot, snapshot.decision)
        letter = snapshot.decision.letters[elected]
        seen.do(c.Better(key=elected))
        assert seen.until(lambda s: bool(s.notice.text)).notice.text.startswith(
            f"{letter} is what was"
        )
        assert seen.session.snapshot.judgements == {}
        other = next(key for key in snapshot.decision.letters if key != elected)
        seen.do(c.Better(key=other))
        seen.until(judged(2, better=other))


def test_undo_and_redo_are_events_and_reach_over_sessions(tmp_path: Path):
    with opened(tmp_path) as seen:
        seen.do(c.Go(decision=2))
        seen.do(c.Verdict(value="wrong"))
        seen.do(c.Verdict(value="acceptable"))
        seen.until(judged(2, verdict="acceptable"))
    with opened(tmp_path) as seen:
        seen.do(c.Go(decision=5))
        seen.do(c.Undo())
        assert seen.until(judged(2, verdict="wrong")).here.decision in (2, 5)
        seen.do(c.Redo())
        seen.until(judged(2, verdict="acceptable"))
    kinds = [event.kind for event in stored(tmp_path)]
    assert kinds == [Kind.WRONG, Kind.ACCEPTABLE, Kind.UNDO, Kind.REDO]


def test_the_same_verdict_again_takes_it_back(tmp_path: Path):
    with opened(tmp_path) as seen:
        seen.do(c.Verdict(value="wrong"))
        seen.do(c.Verdict(value="agree"))
        seen.until(judged(0, verdict="agree"))
        seen.do(c.Verdict(value="agree"))
        seen.until(lambda s: s.judgements == {})
    assert [event.kind for event in stored(tmp_path)[2:]] == [Kind.UNDO, Kind.UNDO]


def test_nobody_undoes_an_answer_to_a_study_or_of_another(tmp_path: Path):
    with Store(tmp_path / FILE) as store:
        answer = Event("s1", Kind.RANKING, "ann", SHA, 1, said=Ordering.of("left"))
        store.append([Event("x", Kind.WRONG, "bob", SHA, 1)])
        store.append([replace(answer, extra={"study": "first"})])
    with opened(tmp_path) as seen:
        seen.do(c.Name(who="ann"))
        seen.do(c.Undo())
        assert "Nothing to undo" in seen.until(lambda s: bool(s.notice.text)).notice.text
        assert list(seen.session.snapshot.reviews["b0"]) == [("bob", 1)]
    assert len(stored(tmp_path)) == 2


def test_the_list_of_tags_is_edited_beside_the_run(tmp_path: Path):
    with opened(tmp_path) as seen:
        assert "wrong object" in seen.session.snapshot.tags
        seen.do(c.Tags(names=("mirror", " stairs ", "", "mirror")))
        assert seen.until(lambda s: s.tags[0] == "mirror").tags == ("mirror", "stairs")
    with opened(tmp_path) as seen:
        assert seen.session.snapshot.tags == ("mirror", "stairs")


def test_a_leg_that_is_not_there_has_no_end(tmp_path: Path):
    with opened(tmp_path) as seen:
        seen.do(c.LegEnd(leg=7, step=1))
        notice = seen.until(lambda s: bool(s.notice.text)).notice
        assert notice.fault
        assert "expected a leg from 1 to 3, came 8" in notice.text


def test_a_store_that_cannot_be_read_is_said_and_opens_nothing_but_the_reviews(tmp_path: Path):
    (tmp_path / FILE).write_bytes(b"not a database at all, by far" * 40)
    with opened(tmp_path) as seen:
        assert "expected a store of reviews" in seen.session.snapshot.notice.text
        seen.do(c.Move(by="decision", count=1))
        seen.until(lambda s: s.here.decision == 1)


def test_a_live_episode_is_reviewed_in_memory_until_it_has_a_trace(tmp_path: Path):
    book = AuditBook(tmp_path / "new" / FILE)
    book.add("wrong", 0, who="ann", seen=True)
    book.add("note", 0, who="ann", seen=True, words="dark")
    assert book.undo("ann") == 0
    assert not (tmp_path / "new").exists()
    book.bind(SHA)
    book.bind("0" * 64)
    again = AuditBook(tmp_path / "new" / FILE, SHA)
    assert again.opinions() == book.opinions()
    assert again.opinions()["ann", 0].verdict == "wrong"
    assert store_beside(tmp_path / "run" / "traces" / "a.mcap") == tmp_path / "run" / FILE
    assert store_beside(tmp_path / "a.mcap") == tmp_path / FILE


# ---------------------------------------------------------------- covered answers


def test_a_covered_answer_is_in_nothing_that_is_drawn(tmp_path: Path):
    """What is published at a covered decision is a function of what happened before it."""
    run = stage.finished_run()
    with opened(tmp_path, blind=True) as seen:
        number = 3
        seen.do(c.Go(decision=number))
        drawn = seen.until(lambda s: s.here.decision == number)
        assert drawn.covered
        assert answers_shown(drawn) == number
        exchange = next(e for e in run.exchanges if e.decision == number)
        asked = story_of(
            run.header, run.exchanges[: exchange.index], pending=exchange.request, footer=None
        )
        assert (drawn.story.decisions, drawn.story.stops) == (asked.decisions, asked.stops)
        assert (drawn.story.events, drawn.story.sketches) == (asked.events, asked.sketches)
        assert (drawn.story.ladders, drawn.story.length) == (asked.ladders, asked.length)
        ways = [
            [(f.step, f.pose, f.action) for f in story.track.footsteps]
            for story in (drawn.story, asked)
        ]
        assert ways[0] == ways[1]
        assert drawn.story.track.glimpses == asked.track.glimpses
        assert drawn.decision is not None
        assert drawn.decision.pending
        assert (drawn.shown, drawn.branch.footer) == (None, None)
        # Neither the answer nor anything after it reaches a page.
        text = json.dumps(state_json(drawn))
        for later in run.exchanges[exchange.index :]:
            for query in later.ranked.queries if later.ranked else ():
                assert query.reply.text not in text
        shown = json.loads(text)
        assert (shown["timeline"]["last"], shown["timeline"]["curve"]) == (exchange.step, [])
        assert max(mark["decision"] for mark in shown["timeline"]["marks"]) == number
        assert shown["branch"]["label"] == "blind · the answer is covered"


HARMLESS = {
    "version",
    "stop",
    "asking",
    "let_go",
    "draft",
    "why",
    "offer",
    "playing",
    "tags",
    "revealed",
    "notice",
    "driver",
    "who",
    "working",
    "consent_to",
    "no_scene",
    "scene_serial",
    "overlays",
}
"""Parts of a snapshot that know nothing of what was answered, or only what the person did."""

CUT = {
    "chooser",
    "branches",
    "branch",
    "story",
    "proposals",
    "view",
    "reviews",
    "covered",
    "parent",
    "place",
    "assessed",
    "reasked",
    "turning",
}
"""Parts that covering cuts or empties."""


def test_whoever_adds_to_a_snapshot_decides_what_covering_does_to_it():
    names = {field.name for field in fields(Snapshot)}
    assert names == HARMLESS | CUT
    source = inspect.getsource(veil.veiled)
    assert all(f"{name}=" in source for name in CUT)


def test_an_answer_before_revealing_is_blind_and_what_follows_is_seen(tmp_path: Path):
    with opened(tmp_path, blind=True) as seen:
        seen.do(c.Go(decision=1))
        seen.until(lambda s: s.here.decision == 1)
        seen.do(c.Verdict(value="agree"))
        assert "covered" in seen.until(lambda s: bool(s.notice.text)).notice.text
        seen.do(c.Press(key="left"))
        seen.until(lambda s: not s.draft.empty)
        seen.do(c.Commit())
        drawn = seen.until(lambda s: not s.covered)
        assert drawn.shown is not None
        seen.do(c.Verdict(value="wrong"))
        seen.until(judged(1, verdict="wrong", blind=False))
        seen.do(c.Go(decision=0))
        seen.until(lambda s: s.here.decision == 0)
        seen.do(c.Tag(value="dark"))
        seen.until(judged(0, tags=("dark",)))
    ranking, reveal, wrong, tag = stored(tmp_path)
    assert (ranking.kind, ranking.blind, ranking.model_seen) == (Kind.RANKING, True, False)
    assert (reveal.kind, reveal.blind, reveal.model_seen) == (Kind.REVEAL, False, True)
    assert (wrong.blind, wrong.model_seen) == (False, True)
    # Decision 1 told what decision 0 was answered, whether it is covered again or not.
    assert (tag.decision, tag.blind) == (0, False)


def test_covering_what_was_on_the_page_does_not_make_it_unseen(tmp_path: Path):
    with opened(tmp_path) as seen:
        seen.do(c.Cover(on=True))
        seen.until(lambda s: s.covered)
        seen.do(c.Verdict(value="cannot tell"))
        seen.until(judged(0, verdict="cannot tell", blind=False))


def test_that_an_answer_was_seen_is_known_for_ever(tmp_path: Path):
    with opened(tmp_path, blind=True) as seen:
        seen.do(c.Reveal())
        seen.until(lambda s: not s.covered)
        seen.do(c.Undo())
        assert "Nothing to undo" in seen.until(lambda s: bool(s.notice.text)).notice.text
    with opened(tmp_path, blind=True) as seen:
        seen.do(c.Tag(value="dark"))
        seen.until(judged(0, blind=False))


def test_suspects_and_outcomes_stay_covered(tmp_path: Path):
    with opened(tmp_path, blind=True) as seen:
        seen.do(c.Layer(name="goal", on=True))
        seen.do(c.Jump(to="worst_suspect"))
        drawn = seen.until(lambda s: bool(s.notice.text))
        assert drawn.here.decision == 0
        assert (drawn.suspects, drawn.assessed) == ((), {})
        assert "goal" not in drawn.view.layers
        assert {(e.outcome, e.success) for e in drawn.chooser.entries} == {("", None)}


@pytest.mark.parametrize("last", [False, True])
def test_between_decisions_the_way_ends_where_the_next_question_stands(tmp_path: Path, last: bool):
    with opened(tmp_path, blind=True) as seen:
        whole = stage.finished_run()
        full = story_of(whole.header, whole.exchanges, pending=None, footer=whole.footer)
        step = full.track.last_step if last else full.decisions[1].step - 1
        seen.do(c.Go(step=step))
        drawn = seen.until(lambda s: s.here.step == step)
        assert not drawn.covered
        assert drawn.story.track.last_step == (step if last else full.decisions[1].step)
        assert (drawn.branch.footer is not None) == last
