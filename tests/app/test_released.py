"""What was left is let go: a branch holds every picture of its episode."""

from __future__ import annotations

import gc
import threading
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
TRIES = 20
LEFT, NEXT = "an episode that is left", "the next one"
"""Names that no other test of the same process holds on to."""


class Waiting:
    """Waits for snapshots without keeping any."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._changed = threading.Event()
        session.subscribe(lambda _: self._changed.set())

    def until(self, holds: Callable[[Snapshot], bool]) -> None:
        """Return once something holds."""
        while not holds(self._session.snapshot):
            assert self._changed.wait(PATIENCE_S)
            self._changed.clear()


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


def drawn_and_held(shell: Shell, session: Session) -> int:
    """Draw what is open now, and count what is held of what was left."""
    shell.draw(session.snapshot)
    return held(LEFT)


def test_nothing_of_an_episode_that_was_left_stays_in_memory():
    opened = replace(
        stage.opened_live(),
        entries=(Entry(LEFT, "left"), Entry(NEXT, "next")),
        first=Choice(LEFT, "full", "scripted"),
        open=opened_as,
    )
    session = Session(opened)
    waiting = Waiting(session)
    shell = Shell(session)
    session.start()
    try:
        for _ in range(3):
            waiting.until(lambda s: s.proposal is not None)
            shell.draw(session.snapshot)
            made = len(session.snapshot.story.decisions)
            session.dispatch(c.Step())
            waiting.until(lambda s, made=made: len(s.story.decisions) > made)
        assert held(LEFT) > 0
        session.dispatch(c.Open(entry=NEXT))
        waiting.until(lambda s: s.story.header.episode.episode_id == NEXT)
        waiting.until(lambda s: s.proposal is not None)
        # The shell's own thread may still be drawing what was left: it is drawn over, then.
        assert any(drawn_and_held(shell, session) == 0 for _ in range(TRIES))
    finally:
        session.close()
        shell.close()
