"""The runs under one folder as the pages read them: an index that keeps itself up to date."""

from __future__ import annotations

import json
import logging
import threading
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

from app.pages.index.finding import Case, Finder, case_of, choices
from app.pages.index.reading import Courses
from app.pages.index.refresh import Progress, refresh
from app.pages.index.store import Store
from c2nav_engine.contract.outcome import Ordering
from c2nav_engine.contract.question import Picture
from c2nav_engine.errors import C2NavError, InputError
from c2nav_engine.experiments.ledger import states_of
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.recorded import OpenTrace, open_trace

log = logging.getLogger(__name__)

PAUSE_S = 5.0
"""Between two looks at the folder [C]."""


KEPT_OPEN = 4
"""Traces whose pictures are at hand [C]: two pairs."""


@dataclass(frozen=True, slots=True)
class Tasks:
    """How far a run is, by its ledger.

    Attributes:
        total: Tasks.
        done: Finished ones, failed ones included.
        running: Taken by a worker.
        failed: Ended in an error.
    """

    total: int
    done: int
    running: int
    failed: int


class Library:
    """The runs under a folder.

    Args:
        root: The folder: one run, or several beside each other.
        scenes: Scenes folder, for the tags that need the truth.

    Raises:
        InputError: It is no folder, or its index is damaged.
    """

    def __init__(self, root: Path, scenes: Path | None = None) -> None:
        self.root = root
        self.store = Store(root)
        self.finder = Finder(self.store)
        self._courses = Courses(scenes)
        self._retry = scenes is not None
        self._progress = Progress(0, 0)
        self._looked = False
        self._closing = threading.Event()
        self._worker = threading.Thread(target=self._watch, name="c2nav-library", daemon=True)

    @property
    def progress(self) -> Progress:
        """How far the latest look at the folder is."""
        return self._progress

    @property
    def looked(self) -> bool:
        """Whether the whole folder was looked at once: before, what is missing may yet come."""
        return self._looked

    def start(self) -> None:
        """Keep the index up to date until `close`."""
        self._worker.start()

    def refresh(self) -> Progress:
        """Bring the index up to date now."""
        self._progress = refresh(
            self.store, self._courses, heard=self._heard, retry_truth=self._retry
        )
        # A scene that is not there stays away: once is enough to look for it.
        self._retry = False
        self._looked = True
        return self._progress

    def _watch(self) -> None:
        while not self._closing.is_set():
            try:
                self.refresh()
            except C2NavError as error:
                log.warning("the index of %s is not up to date: %s", self.root, error)
            self._closing.wait(PAUSE_S)

    def _heard(self, progress: Progress) -> bool:
        self._progress = progress
        return not self._closing.is_set()

    def close(self) -> None:
        """Stop watching and let go of the index."""
        self._closing.set()
        if self._worker.is_alive():
            self._worker.join(timeout=30.0)
        self.store.close()

    # ------------------------------------------------------------ what it holds

    def runs(self) -> list[str]:
        """Run folders with episodes or a manifest, by name; "." is the folder itself."""
        known = {run for run, _ in choices(self.store, "run")}
        beside = {path.parent for path in self.root.glob("*/manifest.json")}
        known |= {path.relative_to(self.root).as_posix() for path in beside}
        return sorted(known | ({"."} if self.manifest(".") else set()))

    def manifest(self, run: str) -> Mapping[str, Any]:
        """The manifest of a run; empty where it has none. Raises `InputError` for a damaged one."""
        path = self.root / run / "manifest.json"
        if not path.is_file():
            return {}
        try:
            return cast("dict[str, Any]", json.loads(path.read_text(encoding="utf-8")))
        except ValueError as error:
            message = f"expected a manifest at {path}, came: {error}"
            raise InputError(message) from error

    def tasks(self, run: str) -> Tasks | None:
        """How far a run is; None without a ledger."""
        path = self.root / run / "ledger.sqlite"
        if not path.is_file():
            return None
        states = states_of(path)
        failed = states.get("failed", 0)
        return Tasks(
            total=sum(states.values()),
            done=states.get("done", 0) + failed,
            running=states.get("leased", 0),
            failed=failed,
        )

    def case(self, sha256: str) -> Case:
        """An indexed episode; raises `InputError` for a digest that the index does not have."""
        found = case_of(self.store, sha256)
        if found is None:
            message = f"expected the digest of a trace under {self.root}, came {sha256[:16]!r}"
            raise InputError(message)
        return found

    def trace(self, case: Case) -> Path:
        """Where the trace of an episode lies, named as the command line named the folder."""
        return self.root / case.path

    def thumbnail(self, case: Case) -> Picture | None:
        """What the last decision with pictures elected; None where the trace holds no pictures."""
        shown = case.values["shown"]
        if not isinstance(shown, int):
            return None
        with open_trace(self.trace(case)) as trace:
            exchange = trace.decision(shown)
        if not isinstance(exchange.request, Ask):
            return None
        response = exchange.response
        winner = response.winner if isinstance(response, Ordering) else ""
        held = {
            candidate.key: candidate.picture
            for candidate in exchange.request.facts.candidates
            if candidate.picture is not None and candidate.picture.jpeg
        }
        return held.get(winner) or next(iter(held.values()), None)


class OpenedTraces:
    """Pictures of a few traces at a time, kept open while somebody walks along them."""

    def __init__(self, library: Library) -> None:
        self._library = library
        self._lock = threading.Lock()
        self._open: OrderedDict[str, OpenTrace] = OrderedDict()

    def picture(self, trace: str, sha256: str) -> bytes:
        """A picture of a trace by both digests; raises `InputError` or `TraceError`."""
        with self._lock:
            if trace not in self._open:
                self._open[trace] = open_trace(self._library.trace(self._library.case(trace)))
                while len(self._open) > KEPT_OPEN:
                    self._open.popitem(last=False)[1].close()
            self._open.move_to_end(trace)
            return self._open[trace].picture(sha256)
