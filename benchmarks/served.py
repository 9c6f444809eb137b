"""An inspector in a process of its own, whose processor time and memory are told apart.

A busy machine stretches wall-clock time; the server's own processor time it leaves alone, so the
figures of the page name both.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from c2nav_engine.errors import InternalError, MissingExtra

FLAGS = (
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)
"""Software WebGL: no machine needs a display or a GPU for these figures."""

WINDOW_PX = (1600, 900)
PATIENCE_MS = 180_000

_FILLED = """
() => {
  window.c2bench = {
    strip: () => document.querySelector("rank-strip")?.shadowRoot,
    // The strip shows the decision in view, and every picture of it has arrived.
    filled() {
      const state = window.c2nav?.state, root = this.strip();
      if (!state?.decision || !root) return false;
      const chip = root.querySelector(".chip")?.textContent ?? "";
      const pictures = [...root.querySelectorAll("img")];
      return chip.startsWith(`decision ${state.decision.number} of`)
        && pictures.every((one) => one.complete && one.naturalWidth > 0);
    },
    // Milliseconds from `act` until `arrived` holds, looked at every two milliseconds.
    timed(act, arrived) {
      return new Promise((done) => {
        const begun = performance.now();
        act();
        const look = () => (arrived() ? done(performance.now() - begun) : setTimeout(look, 2));
        look();
      });
    },
    // Whether the map has come to rest; every second viser draws it once all the same.
    drawnMs: 0,
    rested() { return performance.now() - this.drawnMs > 600; },
  };
  const clear = WebGL2RenderingContext.prototype.clear;
  WebGL2RenderingContext.prototype.clear = function (mask) {
    window.c2bench.drawnMs = performance.now();
    return clear.call(this, mask);
  };
}
"""


@dataclass(frozen=True, slots=True)
class Served:
    """A running `c2nav inspect`.

    Attributes:
        url: Where it answers.
        pid: Its process.
        begun_s: `time.perf_counter()` just before the process was started.
    """

    url: str
    pid: int
    begun_s: float

    def memory_mb(self) -> float:
        """Resident memory now, MB."""
        return _status_mb(self.pid, "VmRSS")

    def peak_mb(self) -> float:
        """Most resident memory so far, MB."""
        return _status_mb(self.pid, "VmHWM")

    def processor_s(self) -> float:
        """Processor time spent so far, seconds over all threads."""
        fields = Path(f"/proc/{self.pid}/stat").read_text(encoding="ascii").rpartition(")")[2]
        user, system = fields.split()[11:13]
        return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")


def _status_mb(pid: int, field: str) -> float:
    text = Path(f"/proc/{pid}/status").read_text(encoding="ascii")
    found = re.search(rf"^{field}:\s+(\d+) kB$", text, re.MULTILINE)
    if found is None:
        message = f"expected {field} in the status of process {pid}"
        raise InternalError(message)
    return int(found[1]) / 1024.0


@contextmanager
def served(words: Sequence[str], *, cwd: Path) -> Generator[Served]:
    """Run `c2nav inspect WORDS` on a free loopback port; live traces go below `cwd`."""
    if not Path("/proc/self/status").is_file():
        message = "the page's benchmarks read processor time and memory from /proc"
        raise MissingExtra(message)
    here = str(Path(__file__).resolve().parents[1])
    program = f"import sys; sys.path.insert(0, {here!r}); from app.cli import main; main()"
    command = [sys.executable, "-c", program, "inspect", *words, "--port", "0", "--no-browser"]
    begun_s = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=cwd)
    try:
        yield Served(_address(process), process.pid, begun_s)
    finally:
        process.terminate()
        process.wait(timeout=30.0)


def _address(process: subprocess.Popen[str]) -> str:
    assert process.stdout is not None
    for line in process.stdout:
        found = re.search(r"inspector at (\S+)", line)
        if found is not None:
            return found[1]
    message = f"expected the inspector's address, the program ended with {process.wait()}"
    raise InternalError(message)


@contextmanager
def chromium() -> Generator[Any]:
    """A browser; raises `MissingExtra` where there is none."""
    try:
        from playwright.sync_api import sync_playwright
    except ModuleNotFoundError as error:
        message = "the page's benchmarks need playwright (extra `bench`)"
        raise MissingExtra(message) from error
    path = os.environ.get("CHROMIUM") or shutil.which("chromium") or shutil.which("chrome")
    if path is None:
        message = "the page's benchmarks need a Chromium on PATH, or its path in CHROMIUM"
        raise MissingExtra(message)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=list(FLAGS))
        try:
            yield browser
        finally:
            browser.close()


@contextmanager
def opened(browser: Any, url: str) -> Generator[Any]:
    """A page that stands at a decision with all its pictures and its timeline."""
    width, height = WINDOW_PX
    page = browser.new_page(viewport={"width": width, "height": height})
    page.set_default_timeout(PATIENCE_MS)
    try:
        page.goto(url)
        page.evaluate(_FILLED)
        page.wait_for_function("c2bench.filled() && c2nav.state.timeline.steps >= 0")
        yield page
    finally:
        page.close()
