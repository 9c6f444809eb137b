"""The API: state, events, commands, pictures."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Body, Path
from fastapi.responses import JSONResponse, Response, StreamingResponse

from app.gateway.feed import Feed
from app.gateway.refusing import RefusingRoute
from app.session.commands import Answering, AnyCommand
from app.session.worker import Session, StaleCommand

_FOREVER = "public, max-age=31536000, immutable"


def api(session: Session, feed: Feed) -> APIRouter:
    """Routes below `/api`."""
    router = APIRouter(prefix="/api", route_class=RefusingRoute)

    @router.get("/state")
    def state() -> Response:
        """Everything that the page draws, as one snapshot."""
        return Response(feed.state(), media_type="application/json")

    @router.get("/events")
    async def events() -> StreamingResponse:
        """The same as server-sent events: all of it first, then the sections that changed."""
        headers = {"Cache-Control": "no-store", "X-Accel-Buffering": "no"}
        return StreamingResponse(feed.events(), media_type="text/event-stream", headers=headers)

    @router.post("/commands", status_code=202)
    async def commands(command: Annotated[AnyCommand, Body()]) -> JSONResponse:
        """Do something; 409 when `id` is not the state's, 422 where an answer lacks its `id`."""
        if isinstance(command, Answering) and command.id is None:
            return _problem(422, "expected the id of the state that is answered")
        try:
            session.dispatch(command)
        except StaleCommand as error:
            return _problem(409, str(error))
        return JSONResponse({"accepted": True, "id": session.snapshot.token}, 202)

    @router.post("/standing", status_code=204)
    async def standing() -> Response:
        """A page shows the decision in view: what it can do without for now may begin."""
        session.first_page.stands()
        return Response(status_code=204)

    @router.post("/standing/scene", status_code=204)
    async def showing() -> Response:
        """A page shows the scene: so may what is looked at last."""
        session.first_page.shown()
        return Response(status_code=204)

    _add_pictures(router, session)
    return router


def _add_pictures(router: APIRouter, session: Session) -> None:
    @router.get("/image/{sha256}.jpg")
    async def image(sha256: Annotated[str, Path(pattern="^[0-9a-f]{64}$")]) -> Response:
        """A picture in the bytes that were sent to the ranker."""
        picture = session.album.get(sha256)
        if picture is None:
            return _problem(404, "expected a picture of what is open")
        headers = {"Cache-Control": _FOREVER, "ETag": f'"{sha256}"'}
        return Response(picture.jpeg, media_type="image/jpeg", headers=headers)

    @router.get("/entry/{index}.jpg")
    def entry(index: Annotated[int, Path(ge=0)]) -> Response:
        """A small picture of something that can be opened."""
        picture = session.thumbnail(index)
        if picture is None:
            return _problem(404, "expected an entry with a picture")
        headers = {"Cache-Control": "no-cache", "ETag": f'"{picture.sha256}"'}
        return Response(picture.jpeg, media_type="image/jpeg", headers=headers)


def _problem(status: int, detail: str) -> JSONResponse:
    body: dict[str, Any] = {"detail": detail}
    return JSONResponse(body, status)
