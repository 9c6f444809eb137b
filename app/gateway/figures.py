"""Figures of the branch in view: seen in the page, taken away as PDF, SVG or recipe."""

from __future__ import annotations

import tempfile
import threading
from pathlib import Path
from typing import Annotated, Literal

from fastapi import APIRouter, Query
from fastapi.responses import JSONResponse, Response

from app.figures.figure import FigureSpec, Kind, inches
from app.figures.plan import Plan
from app.figures.recipe import Run, write_figure
from app.gateway.refusing import RefusingRoute
from app.inspector.scene.ground import ground_of
from app.session.snapshot import Snapshot
from app.session.story import Story
from app.session.worker import Session
from c2nav_engine.errors import C2NavError, UsageError

Format = Literal["svg", "pdf", "json"]

_TYPES: dict[str, str] = {
    "svg": "image/svg+xml",
    "pdf": "application/pdf",
    "json": "application/json",
}

# Matplotlib's figures share fonts and settings: one is drawn at a time.
_DRAWING = threading.Lock()


def figures(session: Session) -> APIRouter:
    """The route below `/api`."""
    router = APIRouter(prefix="/api", route_class=RefusingRoute)
    grounds = _Grounds(session)

    @router.get("/figure.{file}")
    def figure(
        *,
        file: Format,
        kind: Kind = Kind.STRIP,
        decisions: Annotated[str, Query(max_length=200)] = "",
        width: Annotated[str, Query(max_length=20)] = "7.16in",
        recipe_of: Literal["svg", "pdf"] = "pdf",
    ) -> Response:
        """A figure of the branch in view; 422 says what does not fit."""
        snapshot = session.snapshot
        try:
            spec = FigureSpec(kind, _numbers(decisions), inches(width))
            if file == "json" and not snapshot.branch.trace_sha256:
                message = "expected a finished recording for a recipe; this branch has none yet"
                raise UsageError(message)
            plan = grounds.of(snapshot) if kind in (Kind.MAP, Kind.COMPARE) else Plan()
            body = _drawn(spec, _runs(snapshot, kind), plan, wanted=(file, recipe_of))
        except C2NavError as error:
            return JSONResponse({"detail": str(error)}, 422)
        name = f"{kind.value}.{file}"
        headers = {"Content-Disposition": f'inline; filename="{name}"'}
        return Response(body, media_type=_TYPES[file], headers=headers)

    return router


def _numbers(text: str) -> tuple[int, ...]:
    words = [word.strip() for word in text.split(",") if word.strip()]
    if not all(word.isdecimal() for word in words):
        message = f"expected decisions as whole numbers (3, 9, 14), came {text!r}"
        raise UsageError(message)
    return tuple(int(word) for word in words)


def _runs(snapshot: Snapshot, kind: Kind) -> list[Run]:
    """The branch in view; to compare, after the one that it left."""
    own = _run(snapshot.story, snapshot.branch.source, snapshot.branch.trace_sha256)
    if kind is not Kind.COMPARE:
        return [own]
    if snapshot.parent is None:
        message = "expected a fork in view: it is compared with the branch that it left"
        raise UsageError(message)
    parent = next(b for b in snapshot.branches if b.branch_id == snapshot.branch.parent)
    return [_run(snapshot.parent, parent.source, parent.trace_sha256), own]


def _run(story: Story, source: str, sha256: str) -> Run:
    """A recipe is taken away from the machine: it names its trace as lying beside it."""
    return Run(Path(source or "run.mcap"), sha256, story)


def _drawn(spec: FigureSpec, runs: list[Run], plan: Plan, *, wanted: tuple[str, str]) -> bytes:
    file, recipe_of = wanted
    with _DRAWING, tempfile.TemporaryDirectory() as folder:
        beside = [Run(Path(folder) / run.path, run.sha256, run.story) for run in runs]
        suffix = recipe_of if file == "json" else file
        written = write_figure(
            spec, beside, Path(folder) / f"{spec.kind.value}.{suffix}", plan=plan
        )
        return (written.recipe if file == "json" else written.figure).read_bytes()


class _Grounds:
    """Floor and walls of the scene that is open, outlined once."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._known: tuple[Story, int, Plan] | None = None

    def of(self, snapshot: Snapshot) -> Plan:
        """Empty until the scene is there, and where it is not to be had."""
        scene, floor = self._session.scene, self._session.floor()
        if scene is None or floor is None:
            return Plan()
        known, story = self._known, snapshot.story
        if known is None or known[0] is not story or known[1] != snapshot.scene_serial:
            known = (story, snapshot.scene_serial, ground_of(story, scene, floor))
            self._known = known
        return known[2]
