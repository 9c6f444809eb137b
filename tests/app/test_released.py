"""What was left is let go: a branch holds every picture of its episode."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable
from dataclasses import replace

from app.inspector.shell import Shell
from app.session import commands as c
from app.session.branches import Branch
from app.session.opened import Choice, Entry, Opening
from app.session.snapshot import Snapshot
from app.session.worker import Session
from tests.helpers import stage

PATIENCE_S = 20.0
LEFT, NEXT = "an episode that is left", "the next one"
"""Names that no other test of the same process holds on to."""


def until(session: Session, holds: Callable[[Snapshot], bool]) -> None:
    """Wait without keeping any snapshot."""
    give_up = time.monotonic() + PATIENCE_S
    while not holds(session.snapshot):
        assert time.monotonic() < give_up
        time.sleep(0.01)


def opened_as(choice: Choice) -> Opening:
    """A live episode that is named as it was chosen."""
    run = stage.live_run()
    episode = replace(run.header.episode, episode_id=choice.entry_id)
    run.header = replace(run.header, episode=episode)
    return Opening(run.header, run=run)


def held(episode_id: str) -> int:
    """How many states of an episode's branches somebody still holds."""
    gc.collect()
    found = [thing for thing in gc.get_objects() if isinstance(thing, Branch)]
    return sum(branch.header.episode.episode_id == episode_id for branch in found)


def test_nothing_of_an_episode_that_was_left_stays_in_memory():
    opened = replace(
        stage.opened_live(),
        entries=(Entry(LEFT, "left"), Entry(NEXT, "next")),
        first=Choice(LEFT, "full", "scripted"),
        open=opened_as,
    )
    session = Session(opened)
    shell = Shell(session)
    session.start()
    try:
        for _ in range(3):
            until(session, lambda s: s.proposal is not None)
            shell.draw(session.snapshot)
            made = len(session.snapshot.story.decisions)
            session.dispatch(c.Step())
            until(session, lambda s, made=made: len(s.story.decisions) > made)
        assert held(LEFT) > 0
        session.dispatch(c.Open(entry=NEXT))
        until(session, lambda s: s.story.header.episode.episode_id == NEXT)
        until(session, lambda s: s.proposal is not None)
        shell.draw(session.snapshot)
        until(session, lambda _: held(LEFT) == 0)
    finally:
        session.close()
        shell.close()
