"""The one worker: it owns the engine and the truth; everybody else enqueues and looks.

A question to a ranker may take minutes, so it goes out on a thread of its own and its answer comes
back as one more message: the worker itself never waits for a model, and the page never freezes.
"""

from __future__ import annotations

import logging
import queue
import threading
import time
from collections.abc import Callable
from functools import partial

from app.session import driving, moving
from app.session.commands import Command
from app.session.desk import Desk, Hands, Message
from app.session.first_page import FirstPage
from app.session.handling import handle
from app.session.opened import Opened
from app.session.pictures import Album
from app.session.snapshot import Snapshot
from app.session.veil import answers_shown, veiled
from c2nav_engine.contract.question import Picture
from c2nav_engine.errors import C2NavError
from c2nav_engine.world.scene import Scene
from c2nav_engine.world.surface import Surface

log = logging.getLogger(__name__)

Subscriber = Callable[[Snapshot], None]


class StaleCommand(C2NavError):
    """A command was given to a state that is gone; the page looks again."""


class _Closed(Exception):
    """What a background task waited for came after the session's end."""


class Session:
    """What is open, where one stands, and the thread that changes either."""

    def __init__(
        self,
        opened: Opened,
        *,
        clock: Callable[[], float] = time.time,
        first_page: FirstPage | None = None,
    ) -> None:
        """Open the source's first choice.

        Args:
            opened: What to show.
            clock: Wall clock, seconds since the epoch.
            first_page: What scene, suspects and map wait for; nothing by default.

        Raises:
            C2NavError: When that cannot be opened.
        """
        self.album = Album()
        self.first_page = first_page or FirstPage()
        self._clock = clock
        self._inbox: queue.Queue[Command | Message | None] = queue.Queue()
        self._thumbnails: dict[str, Picture | None] = {}
        self._subscribers: list[Subscriber] = []
        self._closing = threading.Event()
        self._busy = False
        hands = Hands(
            self._background,
            clock,
            post=self._inbox.put,
            after_page=partial(self._after, self.first_page.wait),
            after_scene=partial(self._after, self.first_page.wait_for_scene),
        )
        self._desk = Desk(opened, self.album, hands)
        self._behind: Snapshot = self._desk.snapshot
        self._published: Snapshot = self._drawn()
        self._worker = threading.Thread(target=self._work, name="c2nav-session", daemon=True)

    @property
    def snapshot(self) -> Snapshot:
        """The newest published state."""
        return self._published

    @property
    def busy(self) -> bool:
        """Whether the worker is at a command, so that another snapshot is likely to follow."""
        return self._busy

    @property
    def scene(self) -> Scene | None:
        """The scene of what is open, once it came; `snapshot.scene_serial` says when it changed."""
        return self._desk.scene

    def floor(self) -> Surface | None:
        """The floor of what is open, loaded where it was not yet; None where there is none.

        Raises:
            C2NavError: When it cannot be loaded.
        """
        load = self._desk.floor
        return None if load is None else load()

    def thumbnail(self, index: int) -> Picture | None:
        """A small picture of an entry of what is open; fetched once."""
        entries = self._published.chooser.entries
        if index >= len(entries):
            return None
        entry = entries[index]
        if entry.entry_id not in self._thumbnails:
            fetch = entry.thumbnail
            self._thumbnails[entry.entry_id] = None if fetch is None else fetch()
        return self._thumbnails[entry.entry_id]

    def start(self) -> None:
        """Begin to work; the first pending decision is reached without a command."""
        self._inbox.put(_begin)
        self._worker.start()

    def close(self) -> None:
        """Stop working and let go of the runs."""
        self._closing.set()
        self.first_page.release()
        self._inbox.put(None)
        if self._worker.is_alive():
            self._worker.join(timeout=5.0)
        for run in self._desk.runs.values():
            run.close()

    def subscribe(self, subscriber: Subscriber) -> Callable[[], None]:
        """Be called with every snapshot, on the worker's thread; returns how to stop that."""
        self._subscribers.append(subscriber)
        return lambda: self._subscribers.remove(subscriber)

    def dispatch(self, command: Command) -> None:
        """Enqueue a command; raises `StaleCommand` when its id is not the state's."""
        if command.id is not None and command.id != self._published.token:
            message = (
                f"expected a command for state {self._published.token!r}, came one for "
                f"{command.id!r}; read /api/state again"
            )
            raise StaleCommand(message)
        self._inbox.put(command)

    # ------------------------------------------------------------ the worker's thread

    def _work(self) -> None:
        while not self._closing.is_set():
            try:
                message = self._inbox.get(timeout=self._patience_s())
            except queue.Empty:
                self._guarded(moving.tick)
            else:
                self._busy = True
                self._take(message)
            self._publish()
            self._busy = False

    def _patience_s(self) -> float | None:
        if not self._desk.snapshot.playing:
            return None
        return max(0.001, self._desk.due_s - self._clock())

    def _take(self, message: Command | Message | None) -> None:
        if isinstance(message, Command):
            self._guarded(lambda desk: handle(desk, message))
        elif message is not None:
            self._guarded(message)

    def _guarded(self, work: Message) -> None:
        """Whatever goes wrong is said on the page and ends playing; the worker lives on."""
        try:
            work(self._desk)
            return
        except C2NavError as error:
            problem = str(error)
        except Exception as error:
            log.exception("a command failed")
            problem = f"{type(error).__name__}: {error}"
        self._desk.change(playing="")
        self._desk.say(problem, fault=True)

    def _publish(self) -> None:
        if self._desk.snapshot is self._behind:
            return
        self._desk.change(version=self._published.version + 1)
        self._behind = self._desk.snapshot
        self._published = self._drawn()
        for subscriber in list(self._subscribers):
            subscriber(self._published)

    def _drawn(self) -> Snapshot:
        """What may be drawn; whoever judges later has seen it."""
        drawn = veiled(self._behind)
        self._desk.shelf.note_shown(drawn.branch.branch_id, answers_shown(drawn))
        return drawn

    def _background(self, task: Callable[[], Message]) -> None:
        # Daemon threads: a model that never answers must not keep the program from ending.
        threading.Thread(
            target=lambda: self._inbox.put(self._outcome(task)), name="c2nav-task", daemon=True
        ).start()

    def _after(self, wait: Callable[[], None]) -> None:
        """Return once the wait is over; raises `_Closed` where the session is by then."""
        wait()
        if self._closing.is_set():
            raise _Closed

    @staticmethod
    def _outcome(task: Callable[[], Message]) -> Message:
        try:
            return task()
        except _Closed:
            return lambda _: None
        except Exception as error:
            log.exception("a background task failed")
            problem = f"{type(error).__name__}: {error}"
            return lambda desk: desk.stumbled(problem)


def _begin(desk: Desk) -> None:
    """Go to the first question, and hold what is recorded already against the truth."""
    branch_id = desk.snapshot.branch.branch_id
    driving.settle(desk, branch_id)
    desk.assess(branch_id)
