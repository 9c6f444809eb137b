"""`/run`, `/cases` and `/compare`: their routes, beside the inspector or on their own."""

from __future__ import annotations

import re
import socket
from collections.abc import AsyncGenerator, Callable, Iterable
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Annotated

from fastapi import APIRouter, FastAPI, HTTPException, Path, Query
from fastapi.responses import HTMLResponse, RedirectResponse, Response
from pydantic import BaseModel, ConfigDict, Field

from app.exports.case_sets.packing import fresh_folder, pack_set
from app.figures.plan import Plan
from app.gateway.alone import names_of, serve_alone
from app.gateway.assets import assets, serve_assets
from app.gateway.doors import Doors
from app.gateway.refusing import RefusingRoute
from app.pages.cases import cases_page
from app.pages.compare import compare_page, pair_page
from app.pages.index import curation, query
from app.pages.index.refresh import EXPORTS
from app.pages.library import Library, OpenedTraces
from app.pages.page import ABOUT_RUNS
from app.pages.run import run_page, stamp
from app.session.story import Story
from c2nav_engine.errors import C2NavError, InputError

_SHA = "^[0-9a-f]{64}$"
_IS_SHA = re.compile(_SHA)
Digest = Annotated[str, Field(pattern=_SHA)]
Digests = Annotated[tuple[Digest, ...], Field(min_length=1, max_length=1000)]
Words = Annotated[str, Field(min_length=1, max_length=60)]
_FOREVER = "public, max-age=31536000, immutable"


@dataclass(frozen=True, slots=True)
class RunPages:
    """What the pages show, and what an export draws its maps on.

    Attributes:
        library: The runs.
        plan_of: Floor and walls around a recorded episode; empty where its scene is not there.
        menu: Names of `page.MENU` that stand behind the same port.
    """

    library: Library
    plan_of: Callable[[Story], Plan] = lambda _: Plan()
    menu: tuple[str, ...] = ABOUT_RUNS


class Said(BaseModel):
    """Base of what a page sends."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Marking(Said):
    """Set a manual tag, or take it off."""

    traces: Digests
    tag: Words
    on: bool


class Gathering(Said):
    """Put episodes in a set, or take them out."""

    traces: Digests
    name: Words
    on: bool


class Saving(Said):
    """Keep a query as a view."""

    name: Words
    query: str = Field(max_length=2000)
    sort: str = Field(max_length=60)


class Named(Said):
    """A view or a set by its name."""

    name: Words


class Note(Said):
    """What a set is about."""

    name: Words
    note: str = Field(max_length=2000)


class Caption(Said):
    """What a set says of an episode."""

    name: Words
    trace: Digest
    caption: str = Field(max_length=2000)


def run_pages(pages: RunPages) -> APIRouter:
    """Routes of the pages about the runs of a library."""
    router = APIRouter(include_in_schema=False, route_class=RefusingRoute)
    _reading(router, pages)
    _comparing(router, pages)
    _changing(router, pages)
    return router


def _reading(router: APIRouter, pages: RunPages) -> None:
    library, menu = pages.library, pages.menu

    @router.get("/run")
    def run(run: str = "", against: str = "") -> Response:
        name = run or next(iter(library.runs()), ".")
        return _page(lambda: run_page(library, name, against=against, menu=menu))

    @router.get("/run/stamp")
    def run_stamp(run: str) -> dict[str, str]:
        counted = library.store.column("select count(*) from episodes where run = ?", (run,))
        return {"stamp": stamp(library.tasks(run) if run in library.runs() else None, counted[0])}

    @router.get("/cases")
    def cases(
        q: Annotated[str, Query(max_length=2000)] = "", sort: str = "run", page: int = 1
    ) -> Response:
        return _page(lambda: cases_page(library, query.Query(q, sort), page=page, menu=menu))

    @router.get("/cases/picture/{sha256}.jpg")
    def picture(sha256: Annotated[str, Path(pattern=_SHA)]) -> Response:
        try:
            found = library.thumbnail(library.case(sha256))
        except C2NavError as error:
            raise HTTPException(404, str(error)) from error
        if found is None:
            raise HTTPException(404, "this trace holds no pictures")
        headers = {"Cache-Control": _FOREVER, "ETag": f'"{found.sha256}"'}
        return Response(found.jpeg, media_type="image/jpeg", headers=headers)


def _comparing(router: APIRouter, pages: RunPages) -> None:
    library, menu = pages.library, pages.menu
    opened = OpenedTraces(library)

    @router.get("/compare")
    def compare(a: str = "", b: str = "", cell: str = "") -> Response:
        if _IS_SHA.fullmatch(a) and _IS_SHA.fullmatch(b):
            return _page(lambda: pair_page(library, a, b, menu=menu))
        return _page(lambda: compare_page(library, a, b, cell=cell, menu=menu))

    @router.get("/compare/picture/{trace}/{sha256}.jpg")
    def picture(
        trace: Annotated[str, Path(pattern=_SHA)], sha256: Annotated[str, Path(pattern=_SHA)]
    ) -> Response:
        try:
            jpeg = opened.picture(trace, sha256)
        except C2NavError as error:
            raise HTTPException(404, str(error)) from error
        headers = {"Cache-Control": _FOREVER, "ETag": f'"{sha256}"'}
        return Response(jpeg, media_type="image/jpeg", headers=headers)


def _changing(router: APIRouter, pages: RunPages) -> None:
    library, store = pages.library, pages.library.store

    @router.post("/cases/marks")
    def marks(said: Marking) -> dict[str, bool]:
        return _done(curation.mark(store, trace, said.tag, on=said.on) for trace in said.traces)

    @router.post("/cases/sets")
    def sets(said: Gathering) -> dict[str, bool]:
        act = curation.put_in_set if said.on else curation.take_from_set
        return _done(act(store, said.name, trace) for trace in said.traces)

    @router.post("/cases/caption")
    def caption(said: Caption) -> dict[str, bool]:
        words = said.caption
        return _done([curation.put_in_set(store, said.name, said.trace, caption=words)])

    @router.post("/cases/note")
    def note(said: Note) -> dict[str, bool]:
        return _done([curation.describe_set(store, said.name, said.note)])

    @router.post("/cases/views")
    def views(said: Saving) -> dict[str, bool]:
        kept = query.Query(said.query, said.sort)
        return _done(curation.save_view(store, name, kept) for name in [said.name])

    @router.post("/cases/views/drop")
    def drop(said: Named) -> dict[str, bool]:
        return _done([curation.drop_view(store, said.name)])

    @router.post("/cases/export")
    def export(said: Named) -> dict[str, str]:
        folder = fresh_folder(library.root / EXPORTS / said.name)
        try:
            packed = pack_set(library, said.name, folder, plan_of=pages.plan_of)
            return {"folder": str(packed.folder)}
        except C2NavError as error:
            raise HTTPException(422, str(error)) from error


def _page(make: Callable[[], str]) -> Response:
    try:
        return HTMLResponse(make())
    except C2NavError as error:
        raise HTTPException(404, str(error)) from error


def _done(acts: Iterable[None]) -> dict[str, bool]:
    """Do them all; what is refused is said in words for a person."""
    try:
        for _ in acts:
            pass
    except InputError as error:
        raise HTTPException(422, str(error)) from error
    return {"done": True}


def mount_runs(app: FastAPI, pages: RunPages) -> None:
    """Add the pages to an application; the caller starts and closes the library."""
    app.include_router(run_pages(pages))


def runs_application(pages: RunPages, *, names: Iterable[str] = ()) -> FastAPI:
    """The pages alone, for a run of which no trace is finished yet."""

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncGenerator[None]:
        pages.library.start()
        yield
        pages.library.close()

    app = FastAPI(lifespan=lifespan, openapi_url=None, docs_url=None, redoc_url=None)
    mount_runs(app, pages)

    @app.get("/")
    def first() -> Response:
        return RedirectResponse("run")

    serve_assets(app, assets())
    app.add_middleware(Doors, names=names)
    return app


def serve_runs(
    pages: RunPages,
    listener: socket.socket,
    *,
    host: str,
    ready: Callable[[str], None],
    over: Callable[[], bool],
) -> None:
    """Serve the pages alone, on a listener that stays open.

    Who asks between the end and whatever serves next waits, and is not refused.

    Args:
        pages: What to serve.
        listener: Of `listen`.
        host: The name or address that it was bound to.
        ready: Told the address before the first request is served.
        over: Asked once a second whether to end.
    """
    app = runs_application(pages, names=names_of(host))
    serve_alone(app, listener.dup(), ready=ready, over=over)
