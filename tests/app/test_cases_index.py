from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from app.pages.index import curation
from app.pages.index.columns import Value
from app.pages.index.drawing import map_of
from app.pages.index.finding import PAGE, Finder, case_of, everything
from app.pages.index.query import Query, term, terms, toggled
from app.pages.index.reading import Courses
from app.pages.index.refresh import EXPORTS, Progress, refresh
from app.pages.index.store import FILE, Store
from c2nav_engine.errors import InputError
from c2nav_engine.experiments.tags.endings import Ending
from c2nav_engine.experiments.tags.rules import TAGS
from tests.helpers.cases import VARIANTS, failed_task, fake_run, filled, made_rows

ROWS = made_rows(200)
Values = dict[str, Value]


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Store:
    return filled(tmp_path_factory.mktemp("index"), ROWS)


# ---------------------------------------------------------------- queries

EXPECTED: dict[str, Callable[[Values], bool]] = {
    "": lambda v: True,
    "variant:full": lambda v: v["variant"] == "full",
    "-variant:full": lambda v: v["variant"] != "full",
    'ending:"step limit" steps>100': lambda v: (
        v["ending"] == "step limit" and float(v["steps"] or 0) > 100
    ),
    "ne_m<=5 ne_m>=2": lambda v: 2 <= float(v["ne_m"] or 0) <= 5,
    "tag:oscillation": lambda v: v["oscillation"] == 1,
    "-tag:oscillation": lambda v: v["oscillation"] != 1,
    "unknown:oscillation": lambda v: v["oscillation"] is None,
    "episode:7": lambda v: v["episode_id"] == "7",
    "tokens<3": lambda v: False,
    "-tokens<3": lambda v: True,
    "tag:mine": lambda v: False,
}


@pytest.mark.parametrize("text", EXPECTED)
def test_a_filter_leaves_what_the_same_condition_leaves_in_python(store: Store, text: str):
    found = everything(store, Query(text))
    expected = {row.path for row in ROWS if EXPECTED[text](dict(row.values))}
    assert {case.path for case in found} == expected
    counted = Finder(store).find(Query(text)).counts
    assert counted.total == len(expected)
    assert sum(counted.endings.values()) == len(expected)
    assert counted.endings[Ending.SUCCESS] == counted.successes


def test_words_are_looked_for_in_the_instruction_literally(store: Store):
    assert len(everything(store, Query("kitchen"))) == 40
    assert len(everything(store, Query('"the kitchen and" -"door 5."'))) == 39
    assert len(everything(store, Query("%"))) == 0
    assert len(everything(store, Query("'; drop table episodes; --"))) == 0


@pytest.mark.parametrize(
    "text", ["nofield:1", "steps>many", "variant<3", "unknown:mine", "tag>3", "set<2"]
)
def test_what_is_not_understood_is_said(store: Store, text: str):
    with pytest.raises(InputError, match="expected"):
        Finder(store).find(Query(text))
    with pytest.raises(InputError, match="sort by"):
        Finder(store).find(Query(sort="steps; drop"))


@pytest.mark.parametrize("sort", ["ne_m", "-ne_m", "run", "-tokens"])
def test_pages_are_the_sorted_whole_without_overlap_or_gap(store: Store, sort: str):
    whole = [case.path for case in everything(store, Query(sort=sort))]
    pages = [Finder(store).find(Query(sort=sort), page=page) for page in range(1, 10)]
    assert [case.path for page in pages for case in page.cases] == whole
    assert Finder(store).find(Query(sort=sort), page=99).page == pages[0].pages == 9
    assert len(pages[0].cases) == PAGE
    if sort == "-ne_m":
        errors = [float(case.values["ne_m"] or 0) for case in everything(store, Query(sort=sort))]
        assert errors == sorted(errors, reverse=True)


def test_a_term_is_put_in_and_taken_out_of_a_line():
    text = toggled("kitchen", term("ending", "step limit"))
    assert text == 'kitchen ending:"step limit"'
    assert terms(text) == ["kitchen", 'ending:"step limit"']
    assert toggled(text, term("ending", "step limit")) == "kitchen"


# ---------------------------------------------------------------- reading folders


def refreshed(root: Path) -> tuple[Store, Progress]:
    store = Store(root)
    return store, refresh(store, Courses(None))


def test_a_folder_of_runs_is_read_once_and_again_where_it_changed(tmp_path: Path):
    paths = fake_run(tmp_path / "first") + fake_run(tmp_path / "second")
    failed_task(tmp_path / "second", "9.full.0")
    store, progress = refreshed(tmp_path)
    assert (progress.total, progress.read, progress.unreadable) == (4, 4, ())
    assert {case.values["run"] for case in everything(store, Query())} == {"first", "second"}
    lost = everything(store, Query("ending:error"))
    assert [(case.sha256, case.error) for case in lost] == [("", "no scene")]
    assert refresh(store, Courses(None)).read == 0
    os.utime(paths[0], ns=(1, 1))
    assert refresh(store, Courses(None)).read == 0  # touched, the same bytes
    shutil.copy(paths[1], paths[0])
    paths[2].unlink()
    finder = Finder(store)
    assert finder.find(Query()).counts.total == 5
    assert refresh(store, Courses(None)).read == 1
    assert finder.find(Query()).counts.total == len(everything(store, Query())) == 4
    assert Finder(store).find(Query()).counts.total == 4


def test_the_folder_of_one_run_is_a_run_and_exports_are_none(tmp_path: Path):
    paths = fake_run(tmp_path, episodes=1)
    copies = tmp_path / EXPORTS / "mine" / "traces"
    copies.mkdir(parents=True)
    shutil.copy(paths[0], copies)
    (tmp_path / "traces" / "2.full.0.mcap").write_bytes(b"no trace")
    (tmp_path / "traces" / "3.full.0.mcap.part").write_bytes(b"not finished")
    store, progress = refreshed(tmp_path)
    (case,) = everything(store, Query())
    assert (case.path, case.values["run"]) == ("traces/0.full.0.mcap", ".")
    assert [name for name, _ in progress.unreadable] == ["traces/2.full.0.mcap"]


def test_what_a_trace_says_stands_in_its_row(tmp_path: Path):
    fake_run(tmp_path, episodes=1, cycles=4)
    store, _ = refreshed(tmp_path)
    (case,) = everything(store, Query())
    assert case.values["truth"] == 0  # its scene is not to be had
    assert case.values["best_view_vetoed"] is None
    assert case.values["invalid_answers"] == 1
    assert set(case.tags) <= set(TAGS)
    assert case_of(store, case.sha256) == case
    drawn = map_of(case.drawing, width=120.0, height=80.0)
    assert drawn is not None
    for spot in (drawn.start, drawn.end, drawn.goal or (0.0, 0.0)):
        assert 0.0 <= spot[0] <= 120.0
        assert 0.0 <= spot[1] <= 80.0


# ---------------------------------------------------------------- what people add


def test_marks_views_and_sets_outlive_the_rows_they_speak_of(tmp_path: Path):
    root = tmp_path / "runs"
    paths = fake_run(root / "a")
    store, _ = refreshed(root)
    first, second = everything(store, Query())
    curation.mark(store, first.sha256, "glass door", on=True)
    curation.put_in_set(store, "failures", second.sha256)
    curation.put_in_set(store, "failures", first.sha256, caption="Walks into glass.")
    curation.put_in_set(store, "failures", first.sha256)
    curation.save_view(store, "doors", Query('tag:"glass door"', "-ne_m"))
    assert [case.path for case in everything(store, curation.views(store)[0].query)] == [first.path]
    paths[0].rename(paths[0].with_name("renamed.mcap"))
    refresh(store, Courses(None))
    store.close()
    store = Store(root)
    members = curation.members(store, "failures")
    assert [sha256 for _, sha256, _ in members] == [second.sha256, first.sha256]
    assert members[1][2] == "Walks into glass."
    assert members[1][0] is not None
    assert members[1][0].marks == ("glass door",)
    assert members[1][0].path.endswith("renamed.mcap")
    assert [case.path for case in everything(store, Query("set:failures -kitchen"))]
    for sha256 in (first.sha256, second.sha256):
        curation.take_from_set(store, "failures", sha256)
    assert curation.sets(store) == []
    with pytest.raises(InputError, match="a set of this folder"):
        curation.members(store, "failures")


def test_choices_are_those_of_the_index_as_it_stands(tmp_path: Path):
    rows = made_rows(9)
    finder = Finder(filled(tmp_path, rows[:6]))
    assert finder.choices("variant") == [(name, 2) for name in sorted(VARIANTS)]
    finder.store.put_all((row, 1, 1) for row in rows[6:])
    assert finder.choices("variant") == [(name, 3) for name in sorted(VARIANTS)]
    assert sum(count for _, count in finder.choices("run")) == 9
    finder.store.close()


def test_names_that_cannot_be_kept_are_refused(store: Store):
    sha256 = str(ROWS[0].values["trace_sha256"])
    with pytest.raises(InputError, match="automatic tag"):
        curation.mark(store, sha256, "oscillation", on=True)
    with pytest.raises(InputError, match="a name for a set"):
        curation.put_in_set(store, "../elsewhere", sha256)
    with pytest.raises(InputError, match="an indexed trace"):
        curation.put_in_set(store, "some", "f" * 64)
    with pytest.raises(InputError, match="expected a field"):
        curation.save_view(store, "bad", Query("nofield:1"))


def test_an_index_that_is_none_is_named(tmp_path: Path):
    (tmp_path / FILE).write_text("this is a diary", encoding="utf-8")
    with pytest.raises(InputError, match="move that file away"):
        Store(tmp_path)
    with pytest.raises(InputError, match="a folder of runs"):
        Store(tmp_path / "nowhere")
