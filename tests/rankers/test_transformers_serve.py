"""Both adapters against an independent server with real image preprocessing."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

pytest.importorskip("torch")
pytest.importorskip("transformers")

from c2nav_engine.contract.question import Orders, Slot
from c2nav_engine.rankers.conformance import check_outcome
from c2nav_engine.rankers.local_model import LocalModel, LocalSettings
from c2nav_engine.rankers.openai_chat import OpenAIChat
from c2nav_engine.rankers.openai_responses import OpenAIResponses
from c2nav_engine.rankers.wrapper import AskingRanker
from tests.helpers.questions import question
from tests.helpers.serve_tiny_qwen import serving
from tests.helpers.tiny_qwen import build_tiny_qwen

pytestmark = pytest.mark.slow


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
