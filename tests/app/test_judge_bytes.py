"""What the judging page is sent: the question, and not one byte that could tell an answer."""

from __future__ import annotations

import base64
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from fastapi import FastAPI
from starlette.testclient import TestClient

from app.gateway.doors import STRICT_POLICY
from app.gateway.judging import desks_of, judging_application, mount_judging
from app.reviews.questions import prompt_at
from app.reviews.study import Person, Study
from c2nav_engine.contract.render import text_of
from tests.helpers.judged import ANSWER, GOAL_M, RANKER, SERVED, judged_run, study_with


@dataclass
class Judging:
    """A study behind its page, and every byte that came out of it."""

    client: TestClient
    study: Study
    person: Person
    token: str
    bytes: list[bytes]

    def post(self, name: str, body: dict[str, Any] | None = None, *, token: str | None = None):
        headers = {"X-Judge-Token": self.token if token is None else token}
        answer = self.client.post(f"/judge/{name}", headers=headers, json=body or {})
        self.bytes.append(answer.content + str(dict(answer.headers)).encode())
        return answer

    def answer(self, number: int, tiers: list[list[str]]):
        return self.post("answer", {"id": f"{number:032x}", "number": number, "tiers": tiers})


@pytest.fixture
def judging(tmp_path: Path) -> Iterator[Judging]:
    run = judged_run(tmp_path, episodes=3, cycles=3)
    study, ((person, token),) = study_with(run, "ann")
    app = judging_application(desks_of([run]))
    with TestClient(app, base_url="http://127.0.0.1:8080") as client:
        yield Judging(client, study, person, token, [])


def sent(question: dict[str, Any]) -> list[str | bytes]:
    return [
        part["text"] if "text" in part else base64.b64decode(part["jpeg"])
        for part in question["parts"]
    ]


def test_no_byte_before_submission_tells_anything(judging: Judging):
    """Everything that is sent is walked through, answer by answer, to the end of the queue."""
    queue = judging.study.queue(judging.person.queue)
    prompts = [prompt_at(judging.study, place) for place in queue]
    for name in ("/judge", "/web_assets/judge.js", "/web_assets/judge.css"):
        page = judging.client.get(name)
        assert page.status_code == 200
        judging.bytes.append(page.content + str(dict(page.headers)).encode())
    shown = judging.post("next").json()
    for number, prompt in enumerate(prompts):
        assert shown["number"] == number
        expected = [part if isinstance(part, str) else part.jpeg for part in prompt.parts]
        assert sent(shown["question"]) == expected
        assert set(shown) == {"number", "done", "total", "question"}
        assert set(shown["question"]) == {"parts", "labels", "one"}
        # Words of a later question of this queue that no earlier one holds.
        before = {text_of(earlier) for earlier in prompts[: number + 1]}
        gone_out = b"".join(judging.bytes)
        for later in prompts[number + 1 :]:
            later_pictures = {
                part.sha256: part for part in later.parts if not isinstance(part, str)
            }
            known = {
                part.sha256
                for earlier in prompts[: number + 1]
                for part in earlier.parts
                if not isinstance(part, str)
            }
            for digest, picture in later_pictures.items():
                if digest not in known:
                    assert base64.b64encode(picture.jpeg) not in gone_out
            if text_of(later) not in before:
                assert json.dumps(text_of(later))[1:-1].encode() not in gone_out
        _tells_nothing(judging, gone_out)
        shown = judging.answer(number, [[shown["question"]["labels"][0]]]).json()
    assert shown == {"done": len(queue), "total": len(queue)}
    _tells_nothing(judging, b"".join(judging.bytes))


def _tells_nothing(judging: Judging, gone_out: bytes) -> None:
    secrets = [ANSWER, RANKER, SERVED, str(GOAL_M), "potoroo", "numbat", str(judging.study.folder)]
    secrets += [item.trace_sha256 for item in judging.study.items]
    secrets += [
        "scripted",
        "Abstention",
        "orders disagree",
        "shuffle",
        "outcome",
        "winner",
        ".mcap",
    ]
    secrets += ["goal_m", "success", '"tag', '"slot"', '"decision"', '"keys"', '"seed"', '"leg"']
    for secret in secrets:
        assert secret.encode() not in gone_out, secret


def test_secrets_are_really_in_the_traces(judging: Judging):
    """The words that the test above looks for do stand in what the study was made from."""
    from c2nav_engine.runner.recorded import read_trace

    whole = str(read_trace(judging.study.trace(0)))
    for secret in (ANSWER, RANKER, SERVED, str(GOAL_M), "potoroo", "numbat"):
        assert secret in whole


def test_without_a_token_that_was_given_out_nothing_is_shown(judging: Judging):
    for token in ("", "x", judging.token[:-1]):
        for name in ("next", "undo"):
            answer = judging.post(name, token=token)
            assert answer.status_code == 403
            assert "question" not in answer.json()
    assert judging.client.post("/judge/next").status_code == 422


def test_the_page_has_the_strict_policy_and_may_not_be_cached(judging: Judging):
    for answer in (judging.client.get("/judge"), judging.post("next")):
        assert answer.headers["content-security-policy"] == STRICT_POLICY
        assert answer.headers["cache-control"] == "no-store"
    page = judging.client.get("/judge").text
    assert "style=" not in page
    assert "<script>" not in page
    assert judging.client.get("/web_assets/app.js").status_code == 404
    assert judging.client.get("/api/state").status_code == 404


def test_an_answer_that_was_given_already_moves_on(judging: Judging):
    assert judging.answer(0, [["A"]]).json()["number"] == 1
    assert judging.answer(0, [["A"]]).json()["number"] == 1
    other = {"id": "f" * 32, "number": 0, "tiers": [["B"]]}
    assert judging.post("answer", other).status_code == 409
    assert judging.post("next").json()["number"] == 1


@pytest.mark.parametrize(
    "body",
    [
        {"id": "f" * 32, "number": 0, "tiers": [["Q"]]},
        {"id": "f" * 32, "number": 0, "tiers": [["A"], ["A"]]},
        {"id": "f" * 32, "number": 99_999, "tiers": [["A"]]},
        {"id": "no hex", "number": 0, "tiers": [["A"]]},
        {"id": "f" * 32, "number": 0, "tiers": [["A"]], "author": "bob"},
    ],
)
def test_what_is_no_answer_is_refused_and_leaves_nothing(judging: Judging, body: dict[str, Any]):
    assert judging.post("answer", body).status_code == 422
    assert judging.post("next").json()["done"] == 0


def test_undo_shows_the_last_question_again(judging: Judging):
    first = judging.post("next").json()
    judging.answer(0, [["A"]])
    assert judging.post("undo").json() == first


def test_the_inspector_has_the_page_where_its_run_has_a_study(judging: Judging, tmp_path: Path):
    for entries, status in (([str(judging.study.trace(0))], 200), (["7", "8"], 404)):
        app = FastAPI()
        mount_judging(app, entries)
        assert TestClient(app).get("/judge").status_code == status
