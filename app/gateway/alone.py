"""Binding a port, and serving pages that need neither viser nor a session."""

from __future__ import annotations

import errno
import socket
from collections.abc import Callable

import uvicorn
from starlette.types import ASGIApp

from c2nav_engine.errors import UsageError

_LAST_PORT = 65_535
_WAITING = 64
"""Connections that may wait while the server starts."""


class _Until(uvicorn.Server):
    """A server that also ends by itself."""

    def __init__(self, config: uvicorn.Config, over: Callable[[], bool]) -> None:
        super().__init__(config)
        self._over = over

    async def on_tick(self, counter: int) -> bool:
        """Called ten times a second; asks once a second."""
        return await super().on_tick(counter) or (counter % 10 == 0 and self._over())


def serve_alone(
    app: ASGIApp,
    listener: socket.socket,
    *,
    ready: Callable[[str], None],
    over: Callable[[], bool] = lambda: False,
) -> None:
    """Serve an application until interrupted.

    Args:
        app: What to serve.
        listener: Of `listen`; closed at the end.
        ready: Told the address before the first request is served.
        over: Asked once a second whether to end.
    """
    host, port = listener.getsockname()[:2]
    config = uvicorn.Config(
        app,
        ws="none",
        log_level="warning",
        access_log=False,
        timeout_graceful_shutdown=1,
        server_header=False,
    )
    ready(f"http://{host}:{port}/")
    _Until(config, over).run(sockets=[listener])


def listen(host: str, port: int) -> socket.socket:
    """Take the port, 0 any free one; raises `UsageError` for a port or host that cannot be had."""
    if not 0 <= port <= _LAST_PORT:
        message = f"expected a port from 0 to {_LAST_PORT}, came {port}; choose one with --port"
        raise UsageError(message)
    if not host:  # The system would take it for every address of this machine.
        message = "expected an address of this machine, came an empty one; give one with --host"
        raise UsageError(message)
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    # asyncio turns Nagle's algorithm off only where it reads that the protocol is TCP; with it on,
    # the last part of an answer waits for a delayed acknowledgement: 40 ms a step.
    listener = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((host, port))
    except (socket.gaierror, UnicodeError) as error:
        listener.close()
        message = (
            f"expected an address of this machine, came {host}, which does not resolve ({error}); "
            "correct --host"
        )
        raise UsageError(message) from error
    except OSError as error:
        listener.close()
        if error.errno == errno.EADDRNOTAVAIL:
            message = f"expected an address of this machine, came {host} ({error}); correct --host"
            raise UsageError(message) from error
        message = f"expected a free port, came {host}:{port} ({error}); choose another with --port"
        raise UsageError(message) from error
    # Whoever comes between the printed address and the first answer waits, and is not refused.
    listener.listen(_WAITING)
    return listener


def names_of(host: str) -> tuple[str, ...]:
    """Names under which a gateway that is bound beyond loopback may be reached."""
    if host in ("127.0.0.1", "localhost", "::1"):
        return ()
    return (host, socket.gethostname(), socket.getfqdn())
