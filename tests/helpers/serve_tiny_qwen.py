"""`transformers serve` on the tiny Qwen3-VL: an independent OpenAI-style server, without weights.

Run as a script it is that server; `serving` starts it and waits until it answers.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

from tests.helpers.model_server import unused_port

START_LIMIT_S = 240.0


@contextmanager
def serving(folder: Path) -> Generator[str]:
    """The base URL of a server on that model folder."""
    port = unused_port()
    command = [sys.executable, "-m", "tests.helpers.serve_tiny_qwen", "serve", str(folder)]
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "HF_HUB_OFFLINE": "1"}
    server = subprocess.Popen(
        [*command, "--device", "cpu", "--host", "127.0.0.1", "--port", str(port)],
        env=environment,
        cwd=Path(__file__).resolve().parents[2],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        _wait(server, f"http://127.0.0.1:{port}/health")
        yield f"http://127.0.0.1:{port}/v1"
    finally:
        server.terminate()
        server.wait(30.0)


def _wait(server: subprocess.Popen[bytes], url: str) -> None:
    deadline_s = time.monotonic() + START_LIMIT_S
    while time.monotonic() < deadline_s:
        assert server.poll() is None, "transformers serve ended before it answered"
        try:
            urllib.request.urlopen(url, timeout=5.0).close()
            return
        except urllib.error.HTTPError as answered:
            answered.close()
            return
        except OSError:
            time.sleep(0.3)
    raise AssertionError(f"transformers serve did not answer within {START_LIMIT_S:g} s")


def main() -> None:
    """The server; pictures alone need no video library, so none is asked for."""
    from transformers import Qwen3VLProcessor
    from transformers.cli.transformers import main as transformers_main

    attributes = ["image_processor", "tokenizer"]
    Qwen3VLProcessor.get_attributes = staticmethod(lambda: attributes)
    transformers_main()


if __name__ == "__main__":
    main()
