"""`/judge`: its routes, and a server of its own that has no viser and no shared state."""

from __future__ import annotations

import socket
from collections.abc import AsyncGenerator, Callable, Iterable, Sequence
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Annotated, Any

from fastapi import APIRouter, FastAPI, Header
from fastapi.responses import HTMLResponse, JSONResponse, Response
from pydantic import BaseModel, ConfigDict, Field

from app.gateway.alone import listen, serve_alone
from app.gateway.assets import assets
from app.gateway.doors import Doors
from app.gateway.refusing import RefusingRoute
from app.pages.judge import judge_page, question_json
from app.reviews.desk import Desk, Taken
from app.reviews.study import Person, read_study, study_names
from app.reviews.submissions import Submission
from c2nav_engine.errors import InputError

_ASSETS = ("judge.js", "judge.css")

Token = Annotated[str, Header(alias="X-Judge-Token")]


class Answer(BaseModel):
    """An answer as the page sends it."""

    model_config = ConfigDict(extra="forbid")

    id: str = Field(pattern="^[0-9a-f]{16,64}$")
    number: int = Field(ge=0)
    tiers: tuple[tuple[str, ...], ...] = Field(max_length=26)
    response_ms: int = Field(default=0, ge=0, le=10**9)
    hidden_ms: int = Field(default=0, ge=0, le=10**9)


def judging(desks: Sequence[Desk]) -> APIRouter:
    """Routes of the judging page; a token in every call says who asks."""
    router = APIRouter(prefix="/judge", include_in_schema=False, route_class=RefusingRoute)

    @router.get("")
    def page() -> Response:
        return HTMLResponse(judge_page(), headers={"Referrer-Policy": "no-referrer"})

    @router.post("/next")
    def following(token: Token) -> Response:
        return _answered(desks, token)

    @router.post("/answer")
    def answer(token: Token, said: Answer) -> Response:
        submission = Submission(**said.model_dump())
        return _answered(desks, token, lambda desk, person: desk.submit(person, submission))

    @router.post("/undo")
    def undo(token: Token) -> Response:
        return _answered(desks, token, lambda desk, person: desk.undo(person))

    return router


def _answered(
    desks: Sequence[Desk], token: str, act: Callable[[Desk, Person], object] | None = None
) -> Response:
    """Do something for whoever holds the token, then show what is next for them."""
    found = next(
        ((desk, person) for desk in desks if (person := desk.study.holder(token)) is not None), None
    )
    if found is None:
        return _problem(403, "expected the token of a link that was given out, came another one")
    desk, person = found
    try:
        if act is not None:
            act(desk, person)
        return JSONResponse(_shown(desk, person))
    except Taken as error:
        return _problem(409, str(error))
    except InputError as error:
        return _problem(422, str(error))


def _shown(desk: Desk, person: Person) -> dict[str, Any]:
    handed = desk.next(person)
    if handed is None:
        done, total = desk.progress()[person.queue]
        return {"done": done, "total": total}
    return {
        "number": handed.number,
        "done": handed.done,
        "total": handed.total,
        "question": question_json(handed.prompt),
    }


def _problem(status: int, detail: str) -> JSONResponse:
    return JSONResponse({"detail": detail}, status)


def desks_of(runs: Iterable[Path], *, name: str = "") -> list[Desk]:
    """A desk for the named study, or for every study, of these runs."""
    return [
        Desk(read_study(run, each))
        for run in sorted(set(runs))
        for each in ([name] if name else study_names(run))
    ]


def mount_judging(app: FastAPI, traces: Iterable[str]) -> None:
    """Add the judging page to the inspector where the run of its traces has a study."""
    runs = {Path(trace).resolve().parent.parent for trace in traces if trace.endswith(".mcap")}
    desks = desks_of(run for run in runs if study_names(run))
    if desks:
        app.include_router(judging(desks))


def judging_application(desks: Sequence[Desk], *, names: Iterable[str] = ()) -> FastAPI:
    """The judging page alone, behind the same doors as everything else."""

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncGenerator[None]:
        yield
        for desk in desks:
            desk.close()

    app = FastAPI(lifespan=lifespan, openapi_url=None, docs_url=None, redoc_url=None)
    app.include_router(judging(desks))
    files = assets()

    @app.get("/web_assets/{name}")
    def asset(name: str) -> Response:
        if name not in _ASSETS:
            return Response(status_code=404)
        return Response(files[name].body, media_type=files[name].media_type)

    app.add_middleware(Doors, names=names)
    return app


def serve_judging(
    desks: Sequence[Desk], *, host: str, port: int, ready: Callable[[str], None]
) -> None:
    """Serve the judging page until interrupted; raises `UsageError` when the port is taken."""
    app = judging_application(desks, names=(host, socket.gethostname(), socket.getfqdn()))
    serve_alone(app, listen(host, port), ready=lambda url: ready(f"{url}judge"))
