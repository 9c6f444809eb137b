"""Hands out a study's questions and takes the answers: what stands behind `/judge`.

Everything that decides who sees what happens inside one transaction of the store, so that two
browsers, or two servers, never get in each other's way. Questions are read ahead of time here and
never sent ahead of time: a later question would tell an earlier answer.
"""

from __future__ import annotations

import threading
import time
from collections import OrderedDict
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace

from app.reviews.events import Event, Kind
from app.reviews.questions import prompt_at
from app.reviews.queues import Place
from app.reviews.state import standing
from app.reviews.store import Store, Writing, store_of
from app.reviews.study import Person, Study
from app.reviews.submissions import Submission, answer_event, checked, undo_event
from c2nav_engine.contract.prompt import Prompt
from c2nav_engine.errors import InputError

LEASE_S = 900.0
"""[C] How long an item that was handed out is kept from others of the same queue."""

_READ_AHEAD = 3
_KEPT = 64


class Taken(InputError):
    """The item was answered already, or is in somebody else's hands; the page moves on."""


@dataclass(frozen=True, slots=True)
class Handed:
    """What one person is shown next.

    Attributes:
        number: Place in their queue, from 0: the only name that the page knows it by.
        total: Places in the queue.
        done: Places of the queue that are answered.
        prompt: What to show.
    """

    number: int
    total: int
    done: int
    prompt: Prompt


class Desk:
    """One study, open for judging; safe to use from several threads.

    Args:
        study: The study.
        clock: Seconds since the epoch.
    """

    def __init__(self, study: Study, *, clock: Callable[[], float] = time.time) -> None:
        self.study = study
        self._store: Store = store_of(study.run)
        self._clock = clock
        self._queues: dict[str, tuple[Place, ...]] = {}
        self._seen = 0
        self._events: list[Event] = []
        self._told: dict[tuple[str, str], int] = {}
        self._prompts: OrderedDict[Place, Future[Prompt]] = OrderedDict()
        self._lock = threading.Lock()
        self._reader = ThreadPoolExecutor(1, thread_name_prefix="c2nav-judge")

    def close(self) -> None:
        """Let go of the store."""
        self._reader.shutdown(wait=True, cancel_futures=True)
        self._store.close()

    def next(self, person: Person) -> Handed | None:
        """What the person is to answer now; None when nothing is left for them."""
        queue = self._queue(person)
        with self._store.writing() as writing:
            answered = self._answered(writing, person.queue)
            number = self._pick(writing, person, answered)
            if number is None:
                return None
            until_s = self._clock() + LEASE_S
            writing.lease(self._queue_id(person), number, holder=person.name, until_s=until_s)
        following = [queue[k] for k in range(number, len(queue)) if k not in answered]
        prompts = [self._prompt(place) for place in following[: 1 + _READ_AHEAD]]
        return Handed(number, len(queue), len(answered), prompts[0].result())

    def submit(self, person: Person, answer: Submission) -> None:
        """Store an answer, once.

        Raises:
            Taken: The place is answered already, or somebody else holds it.
            UsageError: It is no answer to that place.
        """
        place = checked(answer, self._queue(person))
        prompt = self._prompt(place).result()
        event = answer_event(
            self.study, person, answer, place=place, prompt=prompt, when_s=self._clock()
        )
        with self._store.writing() as writing:
            answered = self._answered(writing, person.queue)
            # Whoever walked through this trace in the inspector may know what the model said.
            told = self._told.get((event.author, event.trace_sha256), 0)
            event = replace(event, model_seen=event.decision < told)
            holder = answered.get(answer.number)
            if holder is not None and holder.id == event.id:
                return
            leased = writing.leases(self._queue_id(person), now_s=self._clock())
            if holder is not None or leased.get(answer.number, person.name) != person.name:
                raise Taken("expected an open question, came one that was answered or taken over")
            if not self._open_to(person, answer.number, answered):
                raise Taken("expected the question that is next, came another one")
            writing.append(event)

    def undo(self, person: Person) -> bool:
        """Take the person's last answer back; False when there is none."""
        with self._store.writing() as writing:
            mine = [
                event
                for event in self._answered(writing, person.queue).values()
                if event.author == person.name
            ]
            if not mine:
                return False
            last = max(mine, key=lambda event: self._events.index(event))
            before = sum(event.target == last.id for event in self._events)
            writing.append(undo_event(last, before=before, when_s=self._clock()))
            return True

    def answered(self, person: Person) -> frozenset[int]:
        """Places of the person's queue that are answered."""
        with self._store.writing() as writing:
            return frozenset(self._answered(writing, person.queue))

    def progress(self) -> dict[str, tuple[int, int]]:
        """Queue → answered places and all places."""
        with self._store.writing() as writing:
            names = {person.queue: person for person in self.study.people()}
            return {
                name: (len(self._answered(writing, name)), len(self._queue(person)))
                for name, person in names.items()
            }

    # ------------------------------------------------------------ who sees what

    def _queue(self, person: Person) -> tuple[Place, ...]:
        with self._lock:
            if person.queue not in self._queues:
                self._queues[person.queue] = self.study.queue(person.queue)
            return self._queues[person.queue]

    def _queue_id(self, person: Person) -> str:
        return f"{self.study.name}/{person.queue}"

    def _answered(self, writing: Writing, queue: str) -> dict[int, Event]:
        """Place → its answer, as it stands now."""
        for seq, event in writing.events(after=self._seen):
            self._seen = seq
            if event.model_seen:
                place = (event.author, event.trace_sha256)
                self._told[place] = max(self._told.get(place, 0), event.decision + 1)
            if event.extra.get("study") == self.study.name:
                self._events.append(event)
        return {
            int(event.extra["place"]): event
            for event in standing(self._events)
            if event.kind is Kind.RANKING and event.extra["queue"] == queue
        }

    def _pick(self, writing: Writing, person: Person, answered: dict[int, Event]) -> int | None:
        leases = writing.leases(self._queue_id(person), now_s=self._clock())
        free = (
            number
            for number in range(len(self._queue(person)))
            if number not in answered
            and leases.get(number, person.name) == person.name
            and self._open_to(person, number, answered)
        )
        return next(free, None)

    def _open_to(self, person: Person, number: int, answered: dict[int, Event]) -> bool:
        """Never after a later question of the episode, and a repetition only of one's own."""
        queue = self._queue(person)
        place = queue[number]
        mine = {k for k, event in answered.items() if event.author == person.name}
        if place.again and queue.index(Place(place.item)) not in mine:
            return False
        episode = self.study.items[place.item].episode
        return not any(
            self.study.items[queue[k].item].episode == episode for k in mine if k > number
        )

    # ------------------------------------------------------------ questions and answers

    def _prompt(self, place: Place) -> Future[Prompt]:
        """The place's prompt, read on a thread of its own and kept for a while."""
        with self._lock:
            if place not in self._prompts:
                self._prompts[place] = self._reader.submit(prompt_at, self.study, place)
            self._prompts.move_to_end(place)
            while len(self._prompts) > _KEPT:
                self._prompts.popitem(last=False)
            return self._prompts[place]
