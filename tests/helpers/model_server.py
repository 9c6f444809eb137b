"""Answers of an OpenAI-style server, and sockets that misbehave below HTTP."""

from __future__ import annotations

import socket
from collections.abc import Generator
from contextlib import contextmanager
from threading import Thread

CANARY = "sk-canary-7731-never-anywhere"
CANARY_ENV = "C2NAV_TEST_KEY"


def completion(text: str | None, *, finish: str = "stop", **message: object) -> dict[str, object]:
    """A chat completion."""
    return {
        "id": "x",
        "object": "chat.completion",
        "created": 0,
        "model": "served-model",
        "choices": [
            {
                "index": 0,
                "finish_reason": finish,
                "message": {"role": "assistant", "content": text, **message},
            }
        ],
        "usage": {"prompt_tokens": 100, "completion_tokens": 7, "total_tokens": 107},
    }


def response(text: str | None, *, status: str = "completed", **more: object) -> dict[str, object]:
    """A response of the responses interface."""
    content = [] if text is None else [{"type": "output_text", "text": text, "annotations": []}]
    return {
        "id": "r",
        "object": "response",
        "status": status,
        "model": "served-model",
        "output": [
            {"type": "reasoning", "summary": []},
            {"type": "message", "role": "assistant", "content": content},
        ],
        "usage": {"input_tokens": 100, "output_tokens": 7, "total_tokens": 107},
        **more,
    }


def error(message: str, *, code: str | None = None, kind: str = "error") -> dict[str, object]:
    """An error body."""
    return {"error": {"message": message, "type": kind, "code": code, "param": None}}


def unused_port() -> int:
    """A loopback port that nothing listens on."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


@contextmanager
def dropping_server() -> Generator[str]:
    """A server that reads a little of each request and hangs up; yields its base URL."""
    listener = socket.create_server(("127.0.0.1", 0))

    def hang_up() -> None:
        while True:
            try:
                connection, _ = listener.accept()
            except OSError:
                return
            with connection:
                connection.recv(1024)

    thread = Thread(target=hang_up, daemon=True)
    thread.start()
    try:
        yield f"http://127.0.0.1:{listener.getsockname()[1]}/v1"
    finally:
        listener.shutdown(socket.SHUT_RDWR)
        listener.close()
        thread.join(5.0)
