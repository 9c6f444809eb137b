"""A study on disk: a frozen file that says what is asked, and dated amendments beside it."""

from __future__ import annotations

import hashlib
import json
import os
import re
import secrets
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from app.reviews.queues import Place, queue_of, repeated
from app.reviews.sampling import candidates_of, drawn
from app.reviews.store import store_of
from c2nav_engine.errors import UsageError

FROZEN = "study.json"
AMENDMENTS = "amendments.jsonl"
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}")


@dataclass(frozen=True, slots=True)
class Item:
    """One decision that people judge.

    Attributes:
        trace: The trace's file, relative to the study's folder.
        trace_sha256: Its digest when the study was made.
        decision: Decision number in that trace.
        episode: Scene and episode.
        slot: Decision slot.
    """

    trace: str
    trace_sha256: str
    decision: int
    episode: str
    slot: str


@dataclass(frozen=True, slots=True)
class Person:
    """Somebody who judges.

    Attributes:
        name: As it was given; never leaves the study's folder unasked.
        pseudonym: What exports call them.
        queue: Whose order they follow; people of one queue share its items.
        token_sha256: Digest of the token in their link.
    """

    name: str
    pseudonym: str
    queue: str
    token_sha256: str


@dataclass(frozen=True, slots=True)
class Study:
    """A study as it was frozen.

    Attributes:
        folder: Where it lies: `RUN/studies/NAME`.
        sha256: Digest of its frozen file.
        name: Its name.
        seed: Of the draw and of every queue.
        items: What is judged; items of one episode in ascending order.
        repeats: Items that come twice.
    """

    folder: Path
    sha256: str
    name: str
    seed: int
    items: tuple[Item, ...]
    repeats: tuple[int, ...]

    @property
    def run(self) -> Path:
        """The run that the study and its answers lie beside."""
        return self.folder.parent.parent

    def trace(self, item: int) -> Path:
        """The trace of an item."""
        return (self.folder / self.items[item].trace).resolve()

    def queue(self, name: str) -> tuple[Place, ...]:
        """The places of a queue."""
        episodes = [item.episode for item in self.items]
        return queue_of(episodes, self.repeats, seed=self.seed, name=name)

    def people(self) -> tuple[Person, ...]:
        """Everybody who was added, by the newest amendment about them."""
        found: dict[str, Person] = {}
        path = self.folder / AMENDMENTS
        lines = path.read_text("utf-8").splitlines() if path.is_file() else []
        for amendment in map(json.loads, lines):
            if amendment["what"] == "person":
                person = Person(**amendment["person"])
                found[person.name] = person
        return tuple(found.values())

    def holder(self, token: str) -> Person | None:
        """Whose link holds this token."""
        digest = hashlib.sha256(token.encode()).hexdigest()
        matches = (p for p in self.people() if secrets.compare_digest(p.token_sha256, digest))
        return next(matches, None)


def make_study(
    runs: Sequence[Path], *, name: str, per_slot: int, seed: int, repeat: float
) -> Study:
    """Draw decisions and freeze them in the first run's `studies/NAME`.

    Raises:
        UsageError: The name is taken or odd, or the runs hold nothing to judge.
    """
    if not runs or not _NAME.fullmatch(name):
        message = (
            "expected run folders and a name of letters, digits, dots and dashes; came "
            f"{len(runs)} folders and {name!r}"
        )
        raise UsageError(message)
    if per_slot < 1 or not 0.0 <= repeat <= 1.0:
        message = (
            "expected one decision or more a slot and a share of repetitions from 0 to 1; came "
            f"{per_slot} and {repeat:g}"
        )
        raise UsageError(message)
    folder = runs[0].resolve() / "studies" / name
    chosen = drawn(candidates_of(runs), per_slot=per_slot, seed=seed)
    if not chosen:
        message = f"expected recorded questions in {', '.join(map(str, runs))}, found none"
        raise UsageError(message)
    items = [
        Item(
            os.path.relpath(one.trace.resolve(), folder),
            one.trace_sha256,
            one.decision,
            one.episode,
            one.slot,
        )
        for one in chosen
    ]
    frozen = {
        "schema": 1,
        "name": name,
        "made": _now(),
        "per_slot": per_slot,
        "seed": seed,
        "repeat": repeat,
        "runs": [os.path.relpath(run.resolve(), folder) for run in runs],
        "repeats": list(repeated([item.episode for item in items], share=repeat, seed=seed)),
        "items": [asdict(item) for item in items],
    }
    _freeze(folder / FROZEN, frozen)
    return read_study(runs[0], name)


def _freeze(path: Path, frozen: dict[str, Any]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(json.dumps(frozen, ensure_ascii=False, indent=1) + "\n")
    except FileExistsError:
        message = f"expected a new name, came one whose study is frozen at {path}; choose another"
        raise UsageError(message) from None


def read_study(run: Path, name: str) -> Study:
    """A study of a run; raises `UsageError` when it is not there or was edited by hand."""
    folder = run.resolve() / "studies" / name
    try:
        data = (folder / FROZEN).read_bytes()
        frozen = json.loads(data)
        return Study(
            folder=folder,
            sha256=hashlib.sha256(data).hexdigest(),
            name=frozen["name"],
            seed=frozen["seed"],
            items=tuple(Item(**item) for item in frozen["items"]),
            repeats=tuple(frozen["repeats"]),
        )
    except OSError:
        held = ", ".join(study_names(run)) or "none"
        message = f"expected a study of {run}, came {name!r}; it holds {held}"
        raise UsageError(message) from None
    except (ValueError, KeyError, TypeError) as error:
        message = f"expected a frozen study at {folder / FROZEN}, came something else ({error!r})"
        raise UsageError(message) from None


def study_names(run: Path) -> tuple[str, ...]:
    """The studies of a run."""
    return tuple(sorted(path.parent.name for path in run.glob(f"studies/*/{FROZEN}")))


def add_person(study: Study, name: str, *, queue: str = "") -> tuple[Person, str]:
    """Add somebody, or give them a new link; returns them and the token, which is kept nowhere.

    Answers given under an earlier link stay.
    """
    if not name.strip():
        message = "expected the name of a person, came an empty one"
        raise UsageError(message)
    token = secrets.token_urlsafe(24)
    before = {person.name: person for person in study.people()}.get(name)
    if before is not None and queue not in ("", before.queue):
        message = f"expected {name} to stay in queue {before.queue!r}, came {queue!r}"
        raise UsageError(message)
    with store_of(study.run) as store:
        pseudonym = store.pseudonym(name)
    person = Person(
        name,
        pseudonym,
        queue or (before.queue if before else pseudonym),
        hashlib.sha256(token.encode()).hexdigest(),
    )
    amendment = {"when": _now(), "what": "person", "person": asdict(person)}
    with (study.folder / AMENDMENTS).open("a", encoding="utf-8") as file:
        file.write(json.dumps(amendment, ensure_ascii=False) + "\n")
    return person, token


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")
