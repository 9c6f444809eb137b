from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

pytest.importorskip("torch")
pytest.importorskip("transformers")

import torch

from c2nav_engine.contract.outcome import ORDERS_DISAGREE, Abstention, Cardinal, Ordering
from c2nav_engine.contract.question import Form, Orders, Slot
from c2nav_engine.contract.render import render
from c2nav_engine.errors import UsageError
from c2nav_engine.rankers.conformance import check_adapter, check_same_again
from c2nav_engine.rankers.local import Local
from c2nav_engine.rankers.reading import read
from c2nav_engine.rankers.token_trie import TokenTrie
from c2nav_engine.rankers.wrapper import AskingRanker
from tests.helpers.questions import every_question, flat_picture, question
from tests.helpers.tiny_qwen import build_tiny_qwen


@pytest.fixture(scope="module", autouse=True)
def one_thread() -> Iterator[None]:
    """A tiny model on many threads mostly waits for them."""
    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    yield
    torch.set_num_threads(threads)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build_tiny_qwen(tmp_path_factory.mktemp("qwen"))


@pytest.fixture(scope="module")
def scoring(folder: Path) -> Local:
    return Local.from_options({"model": str(folder), "device": "cpu"})


@pytest.fixture(scope="module")
def generating(folder: Path) -> Local:
    return Local.from_options({"model": str(folder), "device": "cpu", "mode": "generate"})


def test_the_fixture_is_the_same_bytes_for_the_same_seed(folder: Path, tmp_path: Path):
    again = build_tiny_qwen(tmp_path)
    name = "model.safetensors"
    assert (again / name).read_bytes() == (folder / name).read_bytes()


@pytest.mark.parametrize("asked", every_question(), ids=lambda q: f"{q.slot}-{q.form}")
def test_scoring_conforms_and_repeats_itself(scoring: Local, asked):
    check_adapter(scoring, asked)
    check_same_again(scoring, asked)


def test_generation_conforms(generating: Local):
    for asked in (question(), question(Slot.GROUND), question(form=Form.DEGREES)):
        check_adapter(generating, asked)


def test_every_model_gives_a_full_strict_order(scoring: Local, generating: Local):
    prompt = render(question())
    for local in (scoring, generating):
        outcome = read(prompt, local.answer(prompt))
        assert isinstance(outcome, Ordering)
        assert len(outcome.tiers) == 3


def test_pure_label_bias_abstains_every_time_when_orders_are_swapped(scoring: Local):
    ranker = AskingRanker(scoring)
    for seed in range(6):
        for slot in (Slot.TRANSITION, Slot.GROUND, Slot.JOURNEY, Slot.LOOKBACK):
            assert ranker.rank(question(slot, seed=seed)).outcome == Abstention(ORDERS_DISAGREE)


def test_a_batch_answers_as_one_by_one(scoring: Local):
    asked = question(orders=Orders.CYCLIC)
    prompts = [render(asked, order) for order in range(3)] + [render(question(Slot.GLANCE))]
    together = [reply.text for reply in scoring.answer_all(prompts)]
    assert together == [scoring.answer(prompt).text for prompt in prompts]


def test_the_pictures_reach_the_model(scoring: Local):
    model = scoring._model
    prompts = [render(question(pictures={"front": flat_picture(red, 20, 20)})) for red in (10, 240)]
    prepared = [model.prepare(prompt.parts) for prompt in prompts]
    labels = [[model.first_token(label) for label in "ABC"]] * 2
    dark, bright = model.label_scores(prepared, labels)
    assert dark != bright
    assert scoring.answer(prompts[0]).tokens_in == model.length(prepared[0])


def test_an_inversion_is_answered_within_its_range(scoring: Local):
    for slot, form in ((Slot.SEEING, Form.DEGREES), (Slot.TRANSITION, Form.PROGRESS)):
        prompt = render(question(slot, form=form))
        assert isinstance(read(prompt, scoring.answer(prompt)), Cardinal)


def test_a_missing_model_is_a_usage_error():
    with pytest.raises(UsageError, match="model"):
        Local.from_options({})


def test_the_trie_allows_the_listed_answers_and_nothing_else():
    trie = TokenTrie([[1, 2], [1, 3, 4]], end=9)
    assert trie.allowed([]) == [1]
    assert trie.allowed([1]) == [2, 3]
    assert trie.allowed([1, 2]) == [9]
    assert trie.allowed([5]) == [9]
    assert trie.longest == 4


@pytest.mark.gpu
def test_cuda_is_used_when_there_is_one(folder: Path):
    if not torch.cuda.is_available():
        pytest.skip("no CUDA device")
    local = Local.from_options({"model": str(folder)})
    assert local._model.device == "cuda"
    check_adapter(local, question())
