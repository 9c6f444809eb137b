"""The pages about runs, over made-up and over real episodes, as a browser would ask for them."""

from __future__ import annotations

import csv
import json
import re
import shutil
import sqlite3
import subprocess
from collections.abc import Iterator
from html import unescape
from pathlib import Path

import pytest
from PIL import Image
from starlette.testclient import TestClient

from app.exports.case_sets.latex import Plate, appendix, escaped
from app.exports.case_sets.packing import fresh_folder
from app.exports.case_sets.unpacking import unpack_set
from app.gateway.runs import RunPages, runs_application
from app.pages.index import curation
from app.pages.index.finding import everything
from app.pages.index.query import Query
from app.pages.library import Library
from app.pages.run import differences, sentence
from c2nav_engine.errors import InputError, UsageError
from c2nav_engine.experiments.report.reported import reported_beside
from c2nav_engine.experiments.spec import Setting
from c2nav_engine.experiments.statistics.intervals import wilson
from c2nav_engine.experiments.working import workbench_of
from c2nav_engine.runner.opening import OpenSpec
from c2nav_engine.runner.record import EpisodeOutcome
from tests.helpers.cases import failed_task, fake_run
from tests.helpers.runs import by_chance, make_run

DECISIONS = 5
Visit = tuple[TestClient, Library]


def walked(folder: Path) -> None:
    """A run folder of two built-in episodes in one house, a few decisions each."""
    bench = workbench_of(Setting("builtin", ranker="random"), folder)
    for episode in ("1", "2"):
        trace = folder / "traces" / f"{episode}.full.0.mcap"
        trace.parent.mkdir(parents=True, exist_ok=True)
        run = bench.open(OpenSpec(episode, "full", run=folder.name, trace=trace))
        while (
            run.pending is not None
            and sum(e.decision is not None for e in run.exchanges) < DECISIONS
        ):
            run.advance()
        run.end(EpisodeOutcome.STEP_LIMIT)
        run.close()


@pytest.fixture(scope="module")
def visit(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Visit]:
    root = tmp_path_factory.mktemp("runs")
    walked(root / "walked")
    make_run(root / "made", ["full"], by_chance({"full": 0.3}), episodes=3)
    fake_run(root / "made", episodes=2, cycles=4)
    failed_task(root / "made", "9.full.0")
    library = Library(root)
    library.refresh()
    app = runs_application(RunPages(library))
    # Without the lifespan nobody watches the folder: the test says when it is read.
    yield TestClient(app, base_url="http://127.0.0.1:8080"), library
    library.close()


def words(html: str) -> str:
    return " ".join(unescape(re.sub(r"<[^>]+>", " ", html)).split())


# ---------------------------------------------------------------- the run page


def test_the_run_page_tells_the_budget_and_each_block_opens_its_cases(visit: Visit):
    client, library = visit
    page = client.get("/run", params={"run": "walked"})
    assert page.status_code == 200
    said = words(page.text)
    assert "Where 2 episodes went" in said
    assert "nothing follows from the rate" in said
    counted = 0
    for href, count in re.findall(
        r'href="(cases\?[^"]+)"[^>]*>.*?<b>(\d+)</b>', page.text, re.DOTALL
    ):
        cases = client.get(f"/{unescape(href)}").text
        assert len(re.findall(r'class="p-case"', cases)) == int(count)
        counted += int(count)
    assert counted == len(everything(library.store, Query("run:walked"))) == 2


def test_health_counts_every_slot_that_was_asked(visit: Visit):
    client, _ = visit
    said = words(client.get("/run", params={"run": "made"}).text)
    assert "Health of the answers" in said
    assert "served by scripted-1" in said
    assert "invalid" in said
    assert "expected" in said


def test_a_run_in_progress_says_how_far_it_is(tmp_path: Path):
    run = tmp_path / "run"
    make_run(run, ["full"], by_chance({"full": 0.3}), episodes=3)
    library = Library(run)
    client = TestClient(runs_application(RunPages(library)), base_url="http://127.0.0.1")
    # While the folder was not looked at, that nothing has ended would be a guess.
    assert "Reading the traces of this folder" in words(client.get("/").text)
    library.refresh()
    assert "No episode has ended yet" in words(client.get("/").text)
    first = client.get("/run/stamp", params={"run": "."}).json()
    with sqlite3.connect(run / "ledger.sqlite") as db:
        db.execute("create table tasks (key text, name text, state text, row text, error text)")
        states = ("done", "leased", "waiting")
        db.executemany("insert into tasks values ('k', 'n', ?, null, '')", [(s,) for s in states])
    db.close()
    fake_run(run, episodes=1)
    library.refresh()
    said = words(client.get("/run").text)
    assert "in progress: 1 of 3 tasks ended, 1 under way" in said
    assert "Where 1 episode went" in said
    assert client.get("/run/stamp", params={"run": "."}).json() != first
    library.close()


def test_the_sentence_says_what_follows_and_no_more():
    row = reported_beside(["full"], "openai-chat:Qwen/Qwen3-VL-8B-Instruct")
    inside = sentence(wilson(26, 100), row, same_episodes=True)
    assert inside == (
        "26 of 100, 18–35 %; the reported 31 lies inside, so this run cannot tell them apart."
    )
    assert "lies outside" in sentence(wilson(5, 100), row, same_episodes=True)
    assert "of other episodes" in sentence(wilson(26, 100), row, same_episodes=False)
    assert "stands alone" in sentence(wilson(1, 2), None, same_episodes=True)
    assert "scored yet" in sentence(None, row, same_episodes=True)
    gathered = sentence(wilson(0, 9), row, same_episodes=True, recorded=False)
    assert "nothing follows from the rate" in gathered


def test_what_differs_between_two_manifests_is_named_where_it_lies():
    ours = {"seeds": [0], "profile": {"name": "vlnce", "hfov": 90}, "spec": {"setting": {}}}
    theirs = {"seeds": [0, 1], "profile": {"name": "vlnce", "hfov": 79}, "code_version": "2"}
    assert differences(ours, theirs) == [
        ("code_version", "–", "2"),
        ("profile.hfov", "90", "79"),
        ("seeds", "[0]", "[0, 1]"),
    ]
    assert differences(ours, ours) == []


def test_a_run_that_is_not_there_is_named(visit: Visit):
    client, _ = visit
    for params in ({"run": "../elsewhere"}, {"run": "walked", "against": "../elsewhere"}):
        answer = client.get("/run", params=params)
        assert answer.status_code == 404
        assert "walked" in answer.json()["detail"]


# ---------------------------------------------------------------- the cases page


def test_cases_show_pictures_maps_and_unknown_tags(visit: Visit):
    client, library = visit
    page = client.get("/cases").text
    assert "no scene" in page  # the task that never left a trace
    for case in everything(library.store, Query("run:walked")):
        assert case.values["truth"] == 1
        picture = client.get(f"/cases/picture/{case.sha256}.jpg")
        assert picture.content[:2] == b"\xff\xd8"
        assert case.sha256 in page
    assert page.count('class="p-way"') == 4
    assert 'title="unknown for ' in page
    assert client.get(f"/cases/picture/{'0' * 64}.jpg").status_code == 404


def test_a_line_that_is_not_understood_is_said_above_all_episodes(visit: Visit):
    client, _ = visit
    page = client.get("/cases", params={"q": "colour:red"}).text
    assert "expected a field among" in words(page)
    assert page.count('class="p-case"') == 5


def test_nothing_of_a_trace_can_write_into_the_page(visit: Visit):
    client, library = visit
    (case, *_) = everything(library.store, Query("run:walked"))
    for path, body in (
        ("/cases/marks", {"traces": [case.sha256], "tag": "<b>bold", "on": True}),
        ("/cases/sets", {"traces": [case.sha256], "name": "a/../b", "on": True}),
        ("/cases/sets", {"traces": ["x"], "name": "fine", "on": True}),
    ):
        assert client.post(path, json=body).status_code == 422
    page = client.get("/cases", params={"q": '"<script>alert(1)</script>"'}).text
    assert "<script>alert" not in page
    foreign = {"Origin": "https://evil.example"}
    body = {"traces": [case.sha256], "tag": "mine", "on": True}
    assert client.post("/cases/marks", json=body, headers=foreign).status_code == 403


def test_a_set_is_gathered_exported_and_opens_elsewhere(visit: Visit, tmp_path: Path):
    client, library = visit
    chosen = [case.sha256 for case in everything(library.store, Query("run:walked"))]

    def post(path: str, **body: object) -> None:
        assert client.post(path, json=body).status_code == 200, path

    post("/cases/marks", traces=chosen[:1], tag="glass door", on=True)
    post("/cases/sets", traces=chosen, name="failures", on=True)
    post("/cases/caption", name="failures", trace=chosen[1], caption="50 % & a #1_miss.")
    post("/cases/note", name="failures", note="What went wrong.")
    post("/cases/views", name="doors", query='tag:"glass door"', sort="-ne_m")
    page = words(client.get("/cases", params={"q": "set:failures"}).text)
    assert "failures 2" in page
    assert "in failures" in words(client.get("/cases").text)
    assert "doors" in page
    told = client.post("/cases/export", json={"name": "failures"}).json()
    folder = Path(told["folder"])
    assert fresh_folder(folder) == folder.with_name("failures-2")
    appendix = (folder / "appendix.tex").read_text(encoding="utf-8")
    assert appendix.count(r"\includegraphics") == appendix.count(r"\caption{") == 2
    assert r"50 \% \& a \#1\_miss." in appendix
    figures = re.findall(r"\\includegraphics\[.*?\]\{(.*?)\}", appendix)
    assert all((folder / figure).read_bytes()[:5] == b"%PDF-" for figure in figures)
    with (folder / "cases.csv").open(encoding="utf-8") as file:
        table = list(csv.DictReader(file))
    assert [row["trace_sha256"] for row in table] == chosen
    assert library.refresh().total == 4  # the copies are no runs

    taken = unpack_set(folder, tmp_path / "fresh")
    assert taken.cases == 2
    there = Library(tmp_path / "fresh")
    members = curation.members(there.store, "failures")
    assert [sha256 for case, sha256, _ in members if case is not None] == chosen
    assert members[1][2] == "50 % & a #1_miss."
    assert members[0][0] is not None
    assert members[0][0].marks == ("glass door",)
    client_there = TestClient(runs_application(RunPages(there)), base_url="http://127.0.0.1")
    assert client_there.get(f"/cases/picture/{chosen[0]}.jpg").status_code == 200
    there.close()
    with pytest.raises(UsageError, match="no run named"):
        unpack_set(folder, tmp_path / "fresh")

    trace = next((folder / "traces").iterdir())
    trace.write_bytes(trace.read_bytes()[:-1] + b"\0")
    with pytest.raises(InputError, match=trace.name):
        unpack_set(folder, tmp_path / "other")
    assert not (tmp_path / "other").exists()
    facts = json.loads((folder / "manifest.json").read_text("utf-8"))
    (folder / "manifest.json").write_text(json.dumps(facts | {"name": "../up"}), "utf-8")
    with pytest.raises(InputError, match="a name for a set"):
        unpack_set(folder, tmp_path / "other")
    strange = json.loads((folder / "manifest.json").read_text("utf-8")) | {"more": 1}
    (folder / "manifest.json").write_text(json.dumps(strange), "utf-8")
    with pytest.raises(InputError, match="more"):
        unpack_set(folder, tmp_path / "other")


def test_latex_names_every_special_sign_and_keeps_accents():
    assert escaped("a_b & 5 % of {x}^2 ~ \\") == (
        r"a\_b \& 5 \% of \{x\}\textasciicircum{}2 \textasciitilde{} \textbackslash{}"
    )
    assert escaped("Möbel ✕ “so” …") == r"Möbel $\times$ ``so'' \ldots{}"
    assert escaped("λ ≥ 3, Δ ệ 中") == r"$\lambda$ $\geq$ 3, $\Delta$ e [U+4E2D]"


@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="no pdflatex on PATH")
def test_an_appendix_compiles_whatever_its_captions_say(tmp_path: Path):
    Image.new("RGB", (40, 30)).save(tmp_path / "figure.pdf")
    everything = "".join(map(chr, [*range(32, 1024), *range(0x2000, 0x2300)]))
    plates = [Plate("figure.pdf", f"{number} {everything}", f"c{number}") for number in range(20)]
    text = appendix("50 % of {them}", "a_b & “c” …", plates)
    (tmp_path / "appendix.tex").write_text(text, encoding="utf-8")
    command = ["pdflatex", "-halt-on-error", "-interaction=nonstopmode", "appendix.tex"]
    said = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert said.returncode == 0, said.stdout[-2000:]
    assert (tmp_path / "appendix.pdf").read_bytes()[:5] == b"%PDF-"
