"""An application served on this machine alone, for as long as a test needs it."""

from __future__ import annotations

import threading
import time
from collections.abc import Generator
from contextlib import contextmanager

import uvicorn

from app.gateway.alone import listen


@contextmanager
def on_loopback(server: uvicorn.Server) -> Generator[str]:
    """Serve on a free port; yields the address, which ends in a slash."""
    listener = listen("127.0.0.1", 0)
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]}, daemon=True)
    thread.start()
    # The server says by a flag alone that it listens.
    while not server.started:
        assert thread.is_alive(), "the server ended before it listened"
        time.sleep(0.02)
    try:
        yield f"http://127.0.0.1:{listener.getsockname()[1]}/"
    finally:
        server.should_exit = True
        thread.join(timeout=30.0)
