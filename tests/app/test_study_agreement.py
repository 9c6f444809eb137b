"""Agreement figures against computations that share no code with them."""

from __future__ import annotations

import json
from collections import Counter, defaultdict
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.stats import kendalltau
from statsmodels.stats.inter_rater import aggregate_raters, fleiss_kappa

from app.cli import main
from app.reviews.agreement import ALL, agreements, alpha_interval, order_effects
from app.reviews.agreement_grids import human_study
from app.reviews.answers import Answer, Answers, Rater, Showing
from app.reviews.desk import Desk
from app.reviews.reading import read_answers
from app.reviews.store import export_lines, store_of
from app.reviews.submissions import Submission
from c2nav_engine.experiments.reeval_table import COLUMNS, write_table
from c2nav_engine.experiments.statistics.agreement import krippendorff_alpha
from c2nav_engine.experiments.statistics.orders import Shown
from tests.helpers.judged import RANKER, judged_run, study_with

ANN, BOB, EVE = (Rater(name, human=True) for name in ("P1", "P2", "P3"))
MODEL, OTHER = Rater("model", human=False), Rater("other", human=False)
TAU: Any = kendalltau
KEYS = {"seeing": ("front", "left", "right"), "transition": ("next", "stay")}


def made_up(raters: tuple[Rater, ...], *, questions: int = 60, seed: int = 5) -> Answers:
    """Random strict rankings of the same questions, four an episode, pulled towards each other."""
    generator = np.random.default_rng(seed)
    given: list[Answer] = []
    for number in range(questions):
        slot = "seeing" if number % 2 else "transition"
        keys = KEYS[slot]
        common = generator.permutation(len(keys))
        for rater in raters:
            own = common if generator.random() < 0.5 else generator.permutation(len(keys))
            tiers = tuple((keys[int(index)],) for index in own)
            given.append(Answer(rater, f"q{number}", f"e{number // 4}", slot, keys, tiers))
    return Answers(tuple(given), ())


def test_figures_of_pairs_equal_scipy_and_statsmodels():
    answers = made_up((ANN, BOB, MODEL, OTHER))
    rows = {(row.a, row.b, row.slot): row for row in agreements(answers)}
    by = {(a.rater.name, a.question): a for a in answers.given}
    for a, b in combinations(("P1", "P2", "model", "other"), 2):
        for slot, keys in KEYS.items():
            row = rows[a, b, slot]
            names = sorted({q for _, q in by if by[a, q].slot == slot})
            winners = [(by[a, q].tiers[0][0], by[b, q].tiers[0][0]) for q in names]
            assert row.top1 is not None
            assert row.tau is not None
            assert row.alpha is not None
            assert row.top1.estimate == pytest.approx(
                np.mean([x == y for x, y in winners]), abs=1e-9
            )
            assert row.chance == pytest.approx(1 / len(keys), abs=1e-9)
            taus = [
                TAU(*([by[r, q].tiers.index((key,)) for key in keys] for r in (a, b)))[0]
                for q in names
            ]
            assert row.tau.estimate == pytest.approx(np.mean(taus), abs=1e-9)
            # With two labels a question, α is Fleiss' κ with the small-sample correction.
            numbers = [[keys.index(x), keys.index(y)] for x, y in winners]
            kappa = fleiss_kappa(aggregate_raters(np.array(numbers))[0], method="fleiss")
            n = 2 * len(winners)
            assert row.alpha.estimate == pytest.approx(1 - (1 - kappa) * (n - 1) / n, abs=1e-9)
            assert row.confusion == dict(Counter(winners))
            assert sum(row.confusion.values()) == row.questions == len(names)


def test_all_people_together_have_one_alpha():
    answers = made_up((ANN, BOB, EVE))
    row = next(r for r in agreements(answers) if (r.a, r.slot) == ("", "seeing"))
    assert row.questions == 3 * 30
    labels = defaultdict(list)
    for answer in answers.given:
        if answer.slot == "seeing":
            labels[answer.question].append(KEYS["seeing"].index(answer.tiers[0][0]))
    table = np.array(list(labels.values()))
    kappa = fleiss_kappa(aggregate_raters(table)[0], method="fleiss")
    assert row.alpha is not None
    assert row.alpha.estimate == pytest.approx(1 - (1 - kappa) * (table.size - 1) / table.size)


def test_alpha_stands_for_single_slots_and_pairs_alone():
    rows = agreements(made_up((ANN, BOB, MODEL)))
    assert all(row.alpha is None for row in rows if row.slot == ALL)
    assert all(row.alpha is None for row in rows if (row.kind, row.a) == ("human-model", ""))
    assert {row.kind for row in rows} == {"human-human", "human-model"}


def test_who_knows_the_truth_is_never_pooled_with_a_model():
    oracle = Rater("oracle", human=False, privileged=True)
    rows = agreements(made_up((ANN, oracle, MODEL)))
    kinds = {(row.a, row.b): row.kind for row in rows if row.a}
    assert kinds == {
        ("P1", "model"): "human-model",
        ("P1", "oracle"): "privileged",
        ("model", "oracle"): "privileged",
    }
    assert all(row.kind == "privileged" and row.alpha is None for row in rows if not row.a)


def test_intervals_are_drawn_over_episodes():
    units = {f"e{k}": [["l", "l"], ["r", "r"], ["l", "r" if k % 3 else "l"]] for k in range(12)}
    interval = alpha_interval(units, seed=1)
    assert interval is not None
    assert interval.estimate == krippendorff_alpha([u for found in units.values() for u in found])
    assert interval.low < interval.estimate < interval.high
    # Every episode the same: nothing but that can be drawn, whatever its size.
    same = alpha_interval({f"e{k}": [["l", "l"], ["l", "r"]] for k in range(9)}, seed=1)
    assert same is not None
    assert same.low == pytest.approx(same.high)


def test_vectorised_draws_equal_alpha_of_the_drawn_questions():
    generator = np.random.default_rng(8)
    units = {
        f"e{k}": [[str(x) for x in generator.integers(0, 3, size)] for size in (1, 2, 3)]
        for k in range(7)
    }
    names = list(units)
    chosen = np.random.default_rng(4).integers(0, 7, size=(50, 7))
    drawn = [krippendorff_alpha([u for k in row for u in units[names[k]]]) for row in chosen]
    low, high = np.quantile([each for each in drawn if each is not None], [0.025, 0.975])
    interval = alpha_interval(units, seed=4, resamples=50)
    assert interval is not None
    assert (interval.low, interval.high) == pytest.approx((low, high), abs=1e-9)


def test_what_elects_nothing_counts_as_asked_only():
    answers = [
        Answer(ANN, "q", "e", "seeing", KEYS["seeing"], ()),
        Answer(BOB, "q", "e", "seeing", KEYS["seeing"], (("left",), ("front", "right"))),
    ]
    (row,) = agreements(Answers(tuple(answers), ()))
    assert (row.questions, row.top1, row.tau, row.alpha, row.confusion) == (1, None, None, None, {})


def test_order_effects_of_a_rater_who_always_takes_the_first():
    showings = [
        Showing(MODEL, "transition", Shown(f"e{k}", f"q{k}", order, order[0]))
        for k in range(10)
        for order in (("stay", "next"), ("next", "stay"))
    ]
    rows = {row.slot: row for row in order_effects(Answers((), tuple(showings)))}
    row = rows["transition"]
    assert row.consistency.estimate == 0.0
    assert row.first is not None
    assert row.last is not None
    assert (row.first.estimate, row.last.estimate) == (0.5, -0.5)
    assert row.stability.n == 0


def test_the_command_equals_a_hand_count_of_what_was_exported(tmp_path: Path, capsys):
    """Two people judge, one file is exported; figures are counted again from its plain JSON."""
    run = judged_run(tmp_path, episodes=4, cycles=3)
    study, people = study_with(run, "ann", "bob", per_slot=6)
    generator = np.random.default_rng(2)
    desk = Desk(study)
    for person, _ in people:
        while (handed := desk.next(person)) is not None:
            labels = [label for label, _ in handed.prompt.labels]
            tiers = tuple((labels[int(k)],) for k in generator.permutation(len(labels)))
            desk.submit(person, Submission(f"{handed.number:032x}", handed.number, tiers))
    desk.close()
    told = _agree(capsys, run)
    with store_of(run) as store:
        lines = [json.loads(line) for line in export_lines(store)]
    first: dict[tuple[str, str], dict[str, Any]] = defaultdict(dict)
    for line in lines:
        if line["extra"]["again"] == "no":
            first[line["extra"]["slot"], line["extra"]["question"]][line["author"]] = line["said"]
    row = next(r for r in told["agreement"] if (r["kind"], r["slot"]) == ("human-human", "all"))
    pairs = [(said["P1"]["ordering"], said["P2"]["ordering"]) for said in first.values()]
    assert row["questions"] == len(pairs)
    equal = [a[0] == b[0] for a, b in pairs]
    assert row["top1"]["estimate"] == pytest.approx(np.mean(equal), abs=1e-9)
    assert row["chance"] == pytest.approx(np.mean([1 / len(a) for a, _ in pairs]), abs=1e-9)
    assert {r["b"] for r in told["agreement"] if r["kind"] == "human-model"} == {"", RANKER}
    study_tables = human_study([run])
    assert study_tables is not None
    pairs_table, _ = study_tables.grids
    cells = next(r.cells for r in pairs_table.rows if r.cells[::2][:2] == ("human-human", "all"))
    assert cells[3] == str(row["questions"])
    assert cells[4].startswith(f"{100 * np.mean(equal):.0f} (")
    out = tmp_path / "people.jsonl"
    out.write_text("\n".join(json.dumps(line) for line in lines), encoding="utf-8")
    from_file = _agree(capsys, out)
    assert from_file["agreement"] == [r for r in told["agreement"] if r["kind"] == "human-human"]


def test_a_run_that_nobody_judged_has_no_human_study(tmp_path: Path):
    assert human_study([judged_run(tmp_path, episodes=1, cycles=1)]) is None


def test_a_reevaluation_stands_beside_what_was_recorded(tmp_path: Path):
    rows = [
        dict.fromkeys(COLUMNS)
        | {
            "trace_sha256": "a" * 64,
            "decision": number,
            "scene_id": "s",
            "episode_id": str(number // 4),
            "slot": "transition",
            "form": "ordinal",
            "order": order,
            "labelling": "position",
            "keys": ["stay", "next"][:: 1 - 2 * order],
            "recorded_ranker": "old",
            "recorded_winner": "stay",
            "ranker": "old" if number % 2 else "new",
            "ranking": [["stay" if number % 4 else "next"], ["next" if number % 4 else "stay"]],
        }
        for number in range(16)
        for order in (1, 0)
    ]
    write_table(rows, tmp_path / "again.parquet")
    answers = read_answers([tmp_path / "again.parquet"])
    found = {(row.a, row.b): row for row in agreements(answers)}
    fresh, again = found["new", "old"], found["old", "old, again"]
    assert fresh.top1 is not None
    assert again.top1 is not None
    assert (fresh.top1.estimate, fresh.top1.n) == (0.5, 8)
    assert (again.top1.estimate, again.top1.n) == (1.0, 8)
    assert fresh.tau is None
    effects = {row.rater.name: row for row in order_effects(answers)}
    assert effects["new"].consistency.estimate == 1.0
    assert effects["new"].consistency.n == 8


def _agree(capsys: pytest.CaptureFixture[str], what: Path) -> dict[str, Any]:
    with pytest.raises(SystemExit) as stopped:
        main(["agree", str(what), "--json"])
    assert stopped.value.code == 0
    return json.loads(capsys.readouterr().out)


def test_what_holds_no_answer_is_bad_input(tmp_path: Path, capsys):
    (tmp_path / "empty.jsonl").write_text("", encoding="utf-8")
    for odd in ("empty.jsonl", "missing.jsonl", "."):
        with pytest.raises(SystemExit) as stopped:
            main(["agree", str(tmp_path / odd)])
        assert stopped.value.code == 2
        assert "expected" in capsys.readouterr().err
