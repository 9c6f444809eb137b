"""Our own scripts and styles: a closed list of files, read at start."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

from starlette.applications import Starlette
from starlette.datastructures import Headers
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from c2nav_engine.errors import InternalError

_TYPES = {
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".svg": "image/svg+xml",
}


@dataclass(frozen=True, slots=True)
class Asset:
    """One file as it is served."""

    body: bytes
    media_type: str
    etag: str


def assets() -> dict[str, Asset]:
    """Name below `web_assets` → file; nothing else can ever be asked for."""
    folder = _folder()
    return {
        path.relative_to(folder).as_posix(): _asset(path)
        for path in sorted(folder.rglob("*"))
        if path.suffix in _TYPES
    }


def asset_answer(files: dict[str, Asset], name: str, headers: Headers) -> Response:
    """The answer to a request for one of these files with these headers."""
    found = files.get(name)
    if found is None:
        return Response(status_code=404)
    given = {"ETag": found.etag, "Cache-Control": "no-cache"}
    if headers.get("if-none-match") == found.etag:
        return Response(status_code=304, headers=given)
    return Response(found.body, media_type=found.media_type, headers=given)


def serve_assets(app: Starlette, files: dict[str, Asset]) -> None:
    """Add the route of these files."""

    async def asset(request: Request) -> Response:
        return asset_answer(files, request.path_params["name"], request.headers)

    app.router.routes.append(Route("/web_assets/{name:path}", asset))


def _folder() -> Path:
    """Inside the package where it is installed, beside it in a checkout."""
    app = Path(__file__).resolve().parents[1]
    for folder in (app / "_web_assets", app.parent / "web_assets"):
        if folder.is_dir():
            return folder
    message = f"expected the folder web_assets beside {app}; install the package again"
    raise InternalError(message)


def _asset(path: Path) -> Asset:
    body = path.read_bytes()
    return Asset(body, _TYPES[path.suffix], f'"{hashlib.sha256(body).hexdigest()[:20]}"')
