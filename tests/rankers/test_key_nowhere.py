"""The key goes to the server, and appears in no trace, table, log, page or error."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from pytest_httpserver import HTTPServer
from werkzeug import Request, Response

from app.exports.html import HtmlOptions, export_html
from c2nav_engine.experiments.batch import run_batch
from c2nav_engine.experiments.executors.local import LocalExecutor
from c2nav_engine.experiments.spec import RunSpec, Setting
from c2nav_engine.experiments.working import Simulating, workbench_of
from c2nav_engine.runner.opening import Workbench
from c2nav_engine.runner.recorded import read_trace
from c2nav_engine.runner.worlds import Worlds, WorldsConfig
from c2nav_engine.traces.reader import TraceFile
from tests.helpers.model_server import CANARY, CANARY_ENV, completion, error


def short_bench(setting: Setting, run: Path) -> Workbench:
    bench = workbench_of(setting, run)
    profile = replace(bench.profile, max_steps=3)
    return replace(bench, profile=profile, worlds=Worlds(bench.source, WorldsConfig(profile)))


def contents(trace: TraceFile) -> bytes:
    """Everything in a trace, uncompressed."""
    return b"".join(
        [
            *(stored.data for stored in trace.messages()),
            *(trace.attachment(name) for name in trace.attachments),
            json.dumps(dict(trace.facts)).encode(),
        ]
    )


def test_the_key_stays_out_of_everything_that_is_kept(
    httpserver: HTTPServer,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
    capfd: pytest.CaptureFixture[str],
):
    caplog.set_level("DEBUG")
    monkeypatch.setenv(CANARY_ENV, CANARY)

    def indiscreet(_request: Request) -> Response:
        """Repeats the key in answers and in errors."""
        if len(httpserver.log) % 3 == 2:
            return Response(json.dumps(error(f"busy with {CANARY}")), 503)
        said = json.dumps(completion(f"A, says {CANARY}"))
        return Response(said, content_type="application/json")

    httpserver.expect_request("/v1/chat/completions").respond_with_handler(indiscreet)
    options = {
        "base_url": httpserver.url_for("/v1"),
        "model": "made-up",
        "key_env": CANARY_ENV,
        "probe": "false",
        "cache": str(tmp_path / "answers"),
    }
    setting = Setting("builtin", ranker="openai-chat", ranker_options=options)
    spec = RunSpec(setting, ("1",), ("full",), (0,))
    executor = LocalExecutor(work=Simulating(short_bench).work)
    result = run_batch(spec, tmp_path / "run", executor)

    sent = {request.headers["Authorization"] for request, _ in httpserver.log}
    assert sent == {f"Bearer {CANARY}"}
    traces = sorted((tmp_path / "run" / "traces").glob("*.mcap"))
    assert traces
    export_html([read_trace(traces[0])], tmp_path / "page.html", options=HtmlOptions(no_scene=True))
    kept = b"".join(path.read_bytes() for path in tmp_path.rglob("*") if path.is_file())
    for path in traces:
        with TraceFile(path) as trace:
            kept += contents(trace)
    assert b"[key]" in kept, "the server's words were kept, without the key"
    printed = "".join(capfd.readouterr())
    for text in (kept.decode("latin-1"), caplog.text, printed, repr(result)):
        assert CANARY not in text
