"""The files of a report: what stands where, and what never stands together."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.report.content import Annex
from c2nav_engine.experiments.report.grids import Grid, GridRow
from c2nav_engine.experiments.report.writing import write_report
from c2nav_engine.experiments.report.writing_text import latex, markdown
from c2nav_engine.navigator.variants import PRESETS
from tests.helpers.runs import by_chance, make_run

RATES = dict.fromkeys(PRESETS, 0.3) | {"full": 0.5}


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A report over two models and a privileged observer."""
    root = tmp_path_factory.mktemp("files")
    make_run(root / "eight", tuple(PRESETS), by_chance(RATES), episodes=40)
    make_run(
        root / "gpt",
        ("full",),
        by_chance(RATES, seed=8),
        episodes=40,
        named="openai-responses:gpt-5.5-2026-04-23",
    )
    make_run(
        root / "sim",
        ("full", "no-seeing"),
        by_chance(RATES, seed=9),
        episodes=40,
        ranker="simulated",
        named="simulated",
    )
    write_report([root / "sim", root / "eight", root / "gpt"], root / "out")
    return root / "out"


def test_every_format_is_there(out: Path) -> None:
    for name in ("report.html", "report.md", "csv/tables.csv", "latex/main.tex", "plots/sr.pdf"):
        assert (out / name).stat().st_size > 200, name
    for table in ("main", "scale", "faculty", "role"):
        assert (out / "latex" / f"{table}.tex").is_file()


def test_the_paper_column_order_is_kept(out: Path) -> None:
    def heads(name: str) -> list[str]:
        text = (out / "latex" / f"{name}.tex").read_text(encoding="utf-8")
        line = text.split("\\toprule\n")[1].split("\\\\")[0]
        return [cell.strip().replace(r"$\downarrow$", "").replace(r"$\uparrow$", "").strip()
                for cell in line.split("&")]  # fmt: skip

    figures = ["OSR", "SR", "SPL"]
    assert heads("main") == ["Method", "Backbone", "WP-free", "NE", *figures]
    assert heads("scale") == ["Backbone", "NE", *figures]
    assert heads("faculty") == ["Variant", "Seeing", "Remembering", "Arriving", *figures]
    assert heads("role") == ["Interface variant", *figures]


def test_latex_environments_close_and_rows_are_even(out: Path) -> None:
    for path in (out / "latex").glob("*.tex"):
        text = path.read_text(encoding="utf-8")
        assert text.count(r"\begin{tabular}") == text.count(r"\end{tabular}") == 1
        columns = len(re.search(r"\\begin\{tabular\}\{([lc]+)\}", text)[1])  # pyright: ignore
        rows = [line for line in text.splitlines() if line.endswith(r"\\")]
        assert all(len(re.findall(r"(?<!\\)&", row)) == columns - 1 for row in rows), path.name
        assert not re.search(r"[↓↑✓−–±→Δ]", "".join(rows)), path.name


def test_the_simulated_observer_shares_no_table_with_a_model(out: Path) -> None:
    page = (out / "report.md").read_text(encoding="utf-8")
    chapters = page.split("\n## ")[1:]
    models = [chapter for chapter in chapters if chapter.startswith("Models")]
    privileged = [chapter for chapter in chapters if chapter.startswith("Simulated")]
    assert len(models) == len(privileged) == 1
    assert "simulated" not in models[0]
    assert "Qwen" not in privileged[0] and "(reported)" not in privileged[0]
    assert "GPT" not in privileged[0]


def test_reported_rows_are_marked_and_ours_are_told_apart(out: Path) -> None:
    main = (out / "latex" / "main.tex").read_text(encoding="utf-8")
    assert main.count("(reported)") == 14
    assert "29.12" in main and r"36.0 $\pm$ 1.7" in main and "48.41" in main
    assert "Random (ours, openai-chat:Qwen/Qwen3-VL-8B-Instruct)" in main


def test_nothing_is_fetched_by_the_page(out: Path) -> None:
    page = (out / "report.html").read_text(encoding="utf-8")
    page = page.replace("http://www.w3.org/", "")  # names of SVG's own spaces
    assert not re.search(r"(?:src|href)\s*=\s*[\"'](?!#)", page)
    assert "http://" not in page and "https://" not in page
    assert "<script" not in page and "@import" not in page


def test_words_in_plots_stay_words(out: Path) -> None:
    svg = (out / "plots" / "sr.svg").read_text(encoding="utf-8")
    assert ">no-sketch" in svg.replace(" ", "") and "Success rate" in svg
    pdf = (out / "plots" / "sr.pdf").read_bytes()
    assert b"/FontFile2" in pdf and b"/Type3" not in pdf


def test_the_same_rows_give_the_same_bytes(tmp_path: Path) -> None:
    make_run(tmp_path / "run", ("full", "base"), by_chance(RATES), episodes=12)
    for name in ("a", "b"):
        write_report([tmp_path / "run"], tmp_path / name)
    for path in sorted((tmp_path / "a").rglob("*.*")):
        twin = tmp_path / "b" / path.relative_to(tmp_path / "a")
        assert path.read_bytes() == twin.read_bytes(), path.name


def test_a_run_named_twice_is_refused(tmp_path: Path) -> None:
    make_run(tmp_path / "run", ("full",), by_chance(RATES), episodes=4)
    (tmp_path / "link").symlink_to(tmp_path / "run")
    for again in (tmp_path / "run", tmp_path / "run" / ".." / "run", tmp_path / "link"):
        with pytest.raises(UsageError, match="expected each run once"):
            write_report([tmp_path / "run", again], tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_killed_run_is_told_how_it_is_finished(tmp_path: Path) -> None:
    make_run(tmp_path / "run", ("full",), by_chance(RATES), episodes=4)
    (tmp_path / "run" / "episodes.parquet").unlink()
    with pytest.raises(UsageError, match=r"--out .*run --resume"):
        write_report([tmp_path / "run"], tmp_path / "out")
    with pytest.raises(UsageError, match="make one with"):
        write_report([tmp_path], tmp_path / "out")


def test_an_annex_follows_the_chapters_in_every_text_format(tmp_path: Path) -> None:
    make_run(tmp_path / "run", ("full",), by_chance(RATES), episodes=4)
    grid = Grid("study", "Agreement", ("Pair", "Mean τ"), (GridRow(("Ann · Bob", "0.25")),))
    annex = Annex("Human study", ("Two people.",), (grid,))
    write_report([tmp_path / "run"], tmp_path / "out", annexes=(annex,))
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    text = (tmp_path / "out" / "report.md").read_text(encoding="utf-8")
    for written in (page, text):
        assert written.rindex("Human study") > written.rindex("Models: ")
        assert "Two people." in written and "Ann · Bob" in written
    assert r"$\tau$" in (tmp_path / "out" / "latex" / "study.tex").read_text(encoding="utf-8")


def test_what_n_cannot_resolve_is_said(out: Path) -> None:
    text = (out / "report.md").read_text(encoding="utf-8")
    assert "cannot be resolved with n = 40" in text


def test_words_cannot_break_a_table() -> None:
    grid = Grid(
        "k",
        "T & co",
        ("a_b", "50 %"),
        (
            GridRow(
                ("x | y & z", "#1 {ok}"),
            ),
        ),
    )
    assert r"x | y \& z & \#1 \{ok\} \\" in latex(grid)
    assert r"| x \| y & z | #1 {ok} |" in markdown(grid)
