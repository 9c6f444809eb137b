"""Both adapters against an independent server with real image preprocessing."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

pytest.importorskip("torch")
pytest.importorskip("transformers")

from c2nav_engine.contract.outcome import Ordering
from c2nav_engine.contract.question import Orders, Picture, Slot
from c2nav_engine.experiments.spec import Setting, Task
from c2nav_engine.experiments.working import Simulating, workbench_of
from c2nav_engine.rankers.conformance import check_outcome
from c2nav_engine.rankers.local_model import LocalModel, LocalSettings
from c2nav_engine.rankers.openai_chat import OpenAIChat
from c2nav_engine.rankers.openai_responses import OpenAIResponses
from c2nav_engine.rankers.wrapper import AskingRanker
from c2nav_engine.runner.opening import Workbench
from c2nav_engine.runner.recorded import read_trace
from c2nav_engine.runner.replaying import replay
from c2nav_engine.runner.worlds import Worlds, WorldsConfig
from tests.helpers.questions import question
from tests.helpers.serve_tiny_qwen import serving
from tests.helpers.tiny_qwen import build_tiny_qwen


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build_tiny_qwen(tmp_path_factory.mktemp("served"))


@pytest.fixture(scope="module")
def base_url(folder: Path) -> Iterator[str]:
    with serving(folder) as url:
        yield url


@pytest.mark.parametrize("adapter_type", [OpenAIChat, OpenAIResponses])
def test_words_and_pictures_arrive_and_answers_come_back(
    base_url: str, folder: Path, adapter_type: type[OpenAIChat] | type[OpenAIResponses]
):
    options = {"base_url": base_url, "model": str(folder), "answer_tokens": "12"}
    ranker = AskingRanker(adapter_type.from_options(options))
    warnings = ranker.start()
    assert warnings, "this server enforces no schema, and the probe should say so"
    local = LocalModel(LocalSettings(str(folder), device="cpu"))
    for asked in (question(orders=Orders.CYCLIC), question(Slot.GROUND)):
        ranked = ranker.rank(asked)
        for query in ranked.queries:
            check_outcome(query.prompt, query.outcome)
            # The server counts the same tokens as we do in process: every picture arrived.
            assert query.reply.tokens_in == local.length(local.prepare(query.prompt.parts))
            assert query.reply.tokens_out
    ranker.close()


STEPS = 8
"""Low-level actions: a handful of questions, each with three rendered views."""


def short_bench(setting: Setting, run: Path) -> Workbench:
    """What `c2nav run` makes of a setting, with a small step budget."""
    bench = workbench_of(setting, run)
    profile = replace(bench.profile, max_steps=STEPS)
    return replace(bench, profile=profile, worlds=Worlds(bench.source, WorldsConfig(profile)))


@pytest.mark.parametrize("ranker", ["openai-chat", "openai-responses"])
def test_an_episode_runs_end_to_end_over_http_with_pictures(
    base_url: str, folder: Path, tmp_path: Path, ranker: str
):
    options = {"base_url": base_url, "model": str(folder), "answer_tokens": "12"}
    setting = Setting("builtin", ranker=ranker, ranker_options=options)
    task = Task(setting, "1", "full", 0)
    finished = Simulating(short_bench).work(task, tmp_path)
    assert finished is not None and not finished.error
    row = finished.row
    assert row["outcome"] in {"step_limit", "stalled"} and row["success"] == 0
    assert row["ranker"] == f"{ranker}:{folder}"
    assert int(row["tokens"] or 0) > 0 and float(row["latency_s"] or 0) > 0

    trace = read_trace(task.trace(tmp_path))
    assert trace.header.ranker_options["sampling"] == "greedy"
    queries = [q for e in trace.exchanges if e.ranked is not None for q in e.ranked.queries]
    assert len(queries) == row["queries"]
    assert any(isinstance(part, Picture) for query in queries for part in query.prompt.parts)
    # Without weights it says nothing usable: every answer has its name, and none selects.
    assert not any(isinstance(query.outcome, Ordering) for query in queries)
    assert int(row["invalid"] or 0) + int(row["abstained"] or 0) > 0
    assert int(row["fallbacks"] or 0) > 0
    assert replay(trace.header, trace.exchanges, trace.footer) is None
