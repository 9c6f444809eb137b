from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import replace
from html import unescape
from pathlib import Path

import pytest
from starlette.testclient import TestClient

from app.gateway.runs import RunPages, runs_application
from app.pages.compare import compare_page
from app.pages.index.columns import Row
from app.pages.library import Library
from app.pages.matrix import Arm, arms, matrix_of
from app.pages.page import MENU
from app.pages.pair import worded
from c2nav_engine.contract.outcome import Ordering
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.exchange import Exchange
from tests.helpers.cases import VARIANTS, filled, made_rows
from tests.helpers.exchanges import FakeEpisode, fake_episode, write_episode


def otherwise(made: FakeEpisode, decision: int) -> FakeEpisode:
    """The same episode with another winner at one decision, under another seed and variant."""

    def change(exchange: Exchange) -> Exchange:
        if exchange.decision != decision or not isinstance(exchange.request, Ask):
            return exchange
        assert isinstance(exchange.response, Ordering)
        turned = Ordering.of(*reversed(exchange.response.keys))
        return replace(exchange, response=turned)

    header = replace(made.header, variant="no-arriving", code_version="9.9")
    return replace(made, header=header, exchanges=tuple(map(change, made.exchanges)))


@pytest.fixture(scope="module")
def visit(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[TestClient, str, str]]:
    root = tmp_path_factory.mktemp("pairs")
    made = fake_episode(3, side_px=16)
    digests: list[str] = []
    for run, episode in (("one", made), ("two", otherwise(made, 3))):
        (root / run / "traces").mkdir(parents=True)
        path = root / run / "traces" / f"7.{episode.header.variant}.0.mcap"
        digests.append(write_episode(path, episode))
    library = Library(root)
    library.refresh()
    app = runs_application(RunPages(library, menu=tuple(MENU)))
    yield TestClient(app, base_url="http://127.0.0.1"), digests[0], digests[1]
    library.close()


def test_two_episodes_part_where_another_winner_was_committed(visit: tuple[TestClient, str, str]):
    client, a, b = visit
    page = client.get("/compare", params={"a": a, "b": b}).text
    assert "They part at decision 3" in page
    assert "another answer" in page
    assert "Word for word and picture for picture the same" in page
    assert "<td>code_version</td><td>0.1.0</td><td>9.9</td>" in page
    assert 'data-at="3"' in page
    (embedded,) = re.findall(r'id="p-pair">(.*?)</script>', page, re.DOTALL)
    data = json.loads(embedded)
    assert set(data["axes"]) == {"step", "leg", "distance"}
    for side in data["sides"]:
        shown = {step[4] for step in side["steps"]} - {""}
        for sha256 in shown:
            picture = client.get(f"/compare/picture/{side['trace']}/{sha256}.jpg")
            assert picture.content[:2] == b"\xff\xd8"
    missing = client.get(f"/compare/picture/{a}/{'0' * 64}.jpg")
    assert missing.status_code == 404


def test_the_same_episode_never_parts_from_itself(visit: tuple[TestClient, str, str]):
    client, a, _ = visit
    page = client.get("/compare", params={"a": a, "b": a}).text
    assert "They never part" in page
    assert "Nothing but the recording" in page


def test_the_matrix_page_opens_pairs_and_refuses_what_is_not_there(
    visit: tuple[TestClient, str, str],
):
    client, a, b = visit
    page = client.get("/compare").text
    links = [unescape(link) for link in re.findall(r'href="(compare\?a=[0-9a-f]{64}[^"]+)"', page)]
    assert links == [f"compare?a={a}&b={b}"]
    assert client.get("/compare", params={"a": "no/such/arm"}).status_code == 404
    assert client.get("/compare", params={"a": a, "b": "f" * 64}).status_code == 404


def test_each_shared_task_stands_in_one_cell_and_the_test_counts_them(tmp_path: Path):
    won = {"full": (1, 1, 0, 0, 1, 0), "base": (1, 0, 1, 0, 1, None)}
    rows = [
        Row(
            f"run/traces/{episode}.{variant}.0.mcap",
            {
                "run": "run",
                "episode_id": str(episode),
                "variant": variant,
                "ranker": "m",
                "seed": 0,
                "success": success,
                "ending": "success" if success else "stalled",
                "trace_sha256": f"{variant}{episode}".encode().hex().rjust(64, "0"),
            },
        )
        for variant, flags in won.items()
        for episode, success in enumerate(flags)
    ]
    filled(tmp_path, rows).close()
    library = Library(tmp_path)
    matrix = matrix_of(library, Arm("run", "full", "m"), Arm("run", "base", "m"))
    ids = {
        name: [str(one.values["episode_id"]) for one, _ in pairs]
        for name, pairs in matrix.cells.items()
    }
    assert ids == {"both": ["0", "4"], "only_a": ["1"], "only_b": ["2"], "neither": ["3"]}
    assert matrix.test is not None
    assert (matrix.test.both, matrix.test.discordant, matrix.test.p) == (2, 2, 1.0)
    lonely = matrix_of(library, Arm("run", "full", "m"), Arm("run", "none", "m"))
    assert lonely.test is None
    library.close()


def test_who_knows_the_truth_is_marked_beside_a_model(tmp_path: Path):
    made = made_rows(4)
    rows = [
        Row(row.path, {**row.values, "privileged": int(row.values["variant"] == "full")})
        for row in made
    ]
    filled(tmp_path, rows).close()
    library = Library(tmp_path)
    told = {arm.variant: arm.privileged for arm in arms(library)}
    assert told == {name: name == "full" for name in VARIANTS}
    full, base = (
        next(arm for arm in arms(library) if arm.privileged is truth) for truth in (True, False)
    )
    page = compare_page(library, full.name, base.name, menu=tuple(MENU))
    assert "knows the truth" in page
    assert f"◆ {full.run}" in page
    assert "knows the truth" not in compare_page(library, base.name, base.name, menu=tuple(MENU))
    library.close()


def test_a_word_diff_gives_both_texts_back():
    one = "Walk to the red sofa.\n\nStop there."
    other = "Walk past the red  sofa.\nStop there, slowly."
    words = list(worded(one, other))
    assert "".join(word.text for word in words if word.side != "B") == one
    assert "".join(word.text for word in words if word.side != "A") == other
    assert next(word.text for word in words if word.side == "A") == "to "
    assert [word.side for word in worded(one, one)] == [""]
