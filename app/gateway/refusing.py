"""Routes that say what was wrong with a request without echoing what came."""

from __future__ import annotations

from collections.abc import Callable, Coroutine
from typing import Any

from fastapi import Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse, Response
from fastapi.routing import APIRoute


class RefusingRoute(APIRoute):
    """Answers 422 to what it cannot read.

    FastAPI's own answer repeats the input, which may be no JSON: NaN, half a Unicode symbol.
    """

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        """The handler with that answer around it."""
        handle = super().get_route_handler()

        async def refusing(request: Request) -> Response:
            try:
                return await handle(request)
            except RequestValidationError as error:
                found = [f"{'.'.join(map(str, e['loc']))}: {e['msg']}" for e in error.errors()]
                return JSONResponse({"detail": "; ".join(found)}, 422)

        return refusing
