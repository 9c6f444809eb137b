"""viser's page with our script and style."""

from __future__ import annotations

import gzip
import importlib.util
from functools import cached_property
from pathlib import Path

from starlette.datastructures import Headers
from starlette.responses import Response

from app.gateway.doors import VISER_POLICY
from c2nav_engine.errors import InternalError

_TAGS = (
    b'<script src="web_assets/boot.js"></script>'
    b'<link rel="stylesheet" href="web_assets/app.css">'
    b'<script type="module" src="web_assets/app.js"></script>'
)
"""Relative addresses, so that a path prefix works. `boot.js` is not a module: it must run before
viser's own script reads the address."""


class Page:
    """The page as it is served; read from viser's package, which need not be imported for it."""

    @cached_property
    def _plain(self) -> bytes:
        return with_tags(viser_page().read_bytes())

    @cached_property
    def _packed(self) -> bytes:
        # It is packed already, in letters: more than their entropy cannot be gained.
        return gzip.compress(self._plain, 1)

    def answer(self, headers: Headers) -> Response:
        """The answer to a request with these headers."""
        given = {
            "Cache-Control": "no-cache",
            "Content-Security-Policy": VISER_POLICY,
            "Vary": "Accept-Encoding",
        }
        if "gzip" in headers.get("accept-encoding", ""):
            given["Content-Encoding"] = "gzip"
            return Response(self._packed, media_type="text/html", headers=given)
        return Response(self._plain, media_type="text/html", headers=given)


def viser_page() -> Path:
    """The file that viser serves; raises `InternalError` where the package lacks it."""
    found = importlib.util.find_spec("viser")
    folders = [] if found is None else found.submodule_search_locations or []
    for folder in folders:
        path = Path(folder) / "client" / "build" / "index.html"
        if path.is_file():
            return path
    message = "expected viser's page in its package; its version is not the pinned one"
    raise InternalError(message)


def with_tags(page: bytes) -> bytes:
    """Our tags at the end of the head.

    viser's page carries its code inside the head, which may hold the same letters; so the last
    closing tag counts.
    """
    end = page.rfind(b"</head>")
    if end < 0:
        message = "expected viser's page to have a head; its version is not the pinned one"
        raise InternalError(message)
    return page[:end] + _TAGS + page[end:]
