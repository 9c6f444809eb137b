from __future__ import annotations

import sqlite3
import threading
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.reviews.events import Event, Kind, event_line, event_of
from app.reviews.state import last_to_redo, last_to_undo, opinions, standing
from app.reviews.store import Store, export_lines, read_lines
from c2nav_engine.contract.outcome import Abstention, Ordering, Tie
from c2nav_engine.errors import UsageError

SHA = "ab" * 32


def event(number: int, kind: Kind = Kind.AGREE, *, author: str = "ann", **changes) -> Event:
    return replace(Event(f"e{number}", kind, author, SHA, decision=3, when_s=1.5), **changes)


ANSWERS = st.sampled_from(
    [Ordering.of("left", "front"), Tie((("left", "front"),)), Abstention("cannot tell")]
)
SAYING = st.one_of(
    st.builds(dict, kind=st.sampled_from([Kind.AGREE, Kind.WRONG])),
    st.builds(dict, kind=st.sampled_from([Kind.RANKING, Kind.BETTER]), said=ANSWERS),
    st.builds(dict, kind=st.just(Kind.NOTE), reason=st.text(max_size=8)),
    st.builds(
        dict, kind=st.just(Kind.TAG), extra=st.builds(dict, tag=st.sampled_from(["dark", "door"]))
    ),
    st.just({"kind": Kind.LEG_END, "extra": {"leg": "1", "at_m": "2.5"}}),
)


@st.composite
def histories(draw: st.DrawFn) -> list[Event]:
    """Things said by two people, with undos and redos in between."""
    events: list[Event] = []
    for number in range(draw(st.integers(0, 12))):
        author = draw(st.sampled_from(["ann", "bob"]))
        what = draw(st.sampled_from(["say", "say", "undo", "redo"]))
        target = None
        if what == "undo":
            target = last_to_undo(events, author)
        elif what == "redo":
            target = last_to_redo(events, author)
        if target is not None:
            kind = Kind.UNDO if what == "undo" else Kind.REDO
            events.append(event(number, kind, author=author, target=target.id))
        else:
            events.append(replace(event(number, author=author), **draw(SAYING)))
    return events


@given(histories())
def test_replaying_what_was_stored_gives_the_same_state(events: list[Event]):
    read = [event_of(event_line(each)) for each in events]
    assert read == events
    assert opinions(read) == opinions(events)


@given(histories(), st.sampled_from(["ann", "bob"]))
def test_undo_then_redo_changes_nothing(events: list[Event], author: str):
    last = last_to_undo(events, author)
    if last is None:
        return
    undone = [*events, event(90, Kind.UNDO, author=author, target=last.id)]
    assert last not in standing(undone)
    back = last_to_redo(undone, author)
    assert back == last
    redone = [*undone, event(91, Kind.REDO, author=author, target=last.id)]
    assert opinions(redone) == opinions(events)


@given(histories())
def test_nobody_takes_back_what_another_said(events: list[Event]):
    theirs = [each for each in standing(events) if each.author == "bob"]
    if theirs:
        foreign = event(92, Kind.UNDO, author="ann", target=theirs[-1].id)
        assert opinions([*events, foreign]) == opinions(events)


def test_an_opinion_says_whether_all_of_it_was_blind():
    seen = [event(1), event(2, Kind.WRONG, blind=False, model_seen=True)]
    (opinion,) = opinions(seen).values()
    assert (opinion.verdict, opinion.blind) == ("wrong", False)


def test_the_database_refuses_to_change_or_delete_an_event(tmp_path: Path):
    with Store(tmp_path / "reviews.sqlite") as store:
        store.append([event(1)])
    connection = sqlite3.connect(tmp_path / "reviews.sqlite")
    for attempt in ("UPDATE events SET line = ''", "DELETE FROM events"):
        with pytest.raises(sqlite3.IntegrityError, match="never"):
            connection.execute(attempt)
    connection.close()


def test_an_event_is_added_once_and_never_replaced(tmp_path: Path):
    with Store(tmp_path / "reviews.sqlite") as store:
        assert store.append([event(1)]) == 1
        assert store.append([event(1), event(2)]) == 1
        with pytest.raises(UsageError, match="another one with the id e2"):
            store.append([event(3), event(2, reason="other")])
        assert [each.id for each in store.events()] == ["e1", "e2"]


def test_concurrent_writers_lose_nothing_and_double_nothing(tmp_path: Path):
    path = tmp_path / "reviews.sqlite"
    Store(path).close()
    start = threading.Barrier(4)

    def write(writer: int) -> None:
        with Store(path) as store:
            start.wait()
            for number in range(25):
                store.append([event(writer * 100 + number), event(1000 + number)])

    threads = [threading.Thread(target=write, args=(writer,)) for writer in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    with Store(path) as store:
        ids = [each.id for each in store.events()]
    assert len(ids) == len(set(ids)) == 4 * 25 + 25


def test_exports_carry_pseudonyms_unless_asked(tmp_path: Path):
    with Store(tmp_path / "reviews.sqlite") as store:
        store.append([event(1, author="Ann Example"), event(2, author="bob"), event(3)])
        lines = export_lines(store)
        named = export_lines(store, names=True)
    assert "Ann" not in "".join(lines)
    assert [each.author for each in read_lines(lines, where="x")] == ["P1", "P2", "P3"]
    assert read_lines(named, where="x")[0].author == "Ann Example"


@pytest.mark.parametrize("line", ["{}", "[1]", "nonsense", '{"id": 3}'])
def test_a_line_that_is_no_event_is_named(line: str):
    with pytest.raises(UsageError, match="expected a review event in f, line 2"):
        read_lines(["", line], where="f")


def test_what_is_no_store_is_refused(tmp_path: Path):
    (tmp_path / "reviews.sqlite").write_bytes(b"not a database at all, by far" * 40)
    with pytest.raises(UsageError, match="expected a store of reviews"):
        Store(tmp_path / "reviews.sqlite")
