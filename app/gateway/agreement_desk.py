"""What the agreement page is made from: everything that people and models answered in some runs."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Sequence
from pathlib import Path

from app.gateway.best_offered import best_of
from app.pages.index.refresh import Progress
from app.reviews.agreement import Agreement, OrderEffects, agreements, order_effects
from app.reviews.answers import Answers
from app.reviews.audit import store_beside
from app.reviews.reading import Questions, merged, of_people, of_reevaluation, of_trace
from app.reviews.store import FILE
from app.session.opened import Opened
from c2nav_engine.contract.outcome import Key
from c2nav_engine.errors import C2NavError


class AgreementDesk:
    """What the page is made from; safe to use from several threads.

    Every trace is read once; those that a run adds meanwhile are read when the page is asked for
    again, and so is what people say, when their store has changed.

    Args:
        opened: What the inspector is open on: its entries are files of traces.
        beside: Re-evaluations, whose rankers stand beside the recorded ones.
    """

    def __init__(self, opened: Opened, beside: Sequence[Path] = ()) -> None:
        self._opened = opened
        self._beside = tuple(beside)
        traces = [Path(entry.entry_id).resolve() for entry in opened.entries]
        self.runs = tuple(sorted({store_beside(path).parent for path in traces}))
        self._folders = sorted({path.parent for path in traces})
        self._entry_of = {
            path: entry.entry_id for path, entry in zip(traces, opened.entries, strict=True)
        }
        self._asked: Questions = {}
        self._models: dict[Path, Answers] = {}
        self._read: tuple[tuple[object, ...], Answers] | None = None
        self._rows: tuple[list[Agreement], list[OrderEffects]] = ([], [])
        self._best: dict[str, Key] | None = None
        self._lock = threading.Lock()
        self._reader = threading.Thread()

    def reading(self, patience_s: float) -> Progress:
        """Read what is new, in the background; returns how far that is.

        Args:
            patience_s: How long to wait for its end, seconds.
        """
        if not self._reader.is_alive():
            # What goes wrong there is raised by whoever asks for the answers afterwards.
            self._reader = threading.Thread(target=self._read_quietly, daemon=True)
            self._reader.start()
        reader = self._reader
        reader.join(patience_s)
        total = len(self._traces())
        return Progress(len(self._models) if reader.is_alive() else total, total)

    def _read_quietly(self) -> None:
        with contextlib.suppress(C2NavError):
            self.answers()

    def answers(self) -> Answers:
        """Everything that was answered until now."""
        with self._lock:
            return self._answers()

    def rows(self) -> tuple[list[Agreement], list[OrderEffects]]:
        """Agreement and order effects of everything until now."""
        with self._lock:
            self._answers()
            return self._rows

    def best(self) -> dict[str, Key]:
        """Question → the geodesically best alternative; worked out once.

        Raises:
            C2NavError: A trace or its scene cannot be read.
        """
        with self._lock:
            if self._best is None:
                self._best = best_of(self._opened, self._entry_of, self._answers())
            return self._best

    def entry_of(self, trace: Path) -> str:
        """What the inspector calls a trace; "" where it is not open."""
        return self._entry_of.get(trace.resolve(), "")

    def _traces(self) -> list[Path]:
        return [path for folder in self._folders for path in sorted(folder.glob("*.mcap"))]

    def _answers(self) -> Answers:
        traces = self._traces()
        said = (_stamp(run / f"{FILE}{end}") for run in self.runs for end in ("", "-wal"))
        stamp = (len(traces), *said)
        if self._read is None or self._read[0] != stamp:
            for path in traces:
                if path not in self._models:
                    self._models[path] = of_trace(path, self._asked)
            people = [of_people(run, self._asked) for run in self.runs]
            again = [of_reevaluation(path, self._asked) for path in self._beside]
            answers = merged([*self._models.values(), *people, *again])
            self._rows = (agreements(answers), order_effects(answers))
            self._read = (stamp, answers)
        return self._read[1]


def _stamp(path: Path) -> object:
    found = path.stat() if path.is_file() else None
    return None if found is None else (found.st_size, found.st_mtime_ns)
