"""The outcome matrix: two configurations on the episodes that both ran."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from app.pages.index.finding import Case, everything
from app.pages.index.query import Query, term
from app.pages.library import Library
from c2nav_engine.errors import InputError
from c2nav_engine.experiments.statistics.paired import McNemar, mcnemar
from c2nav_engine.experiments.statistics.resolution import resolution

CELLS = ("both", "only_a", "only_b", "neither")
"""Who succeeds."""

Pair = tuple[Case, Case]


@dataclass(frozen=True, slots=True)
class Arm:
    """One configuration of one run.

    Attributes:
        run: Run folder.
        variant: Preset.
        ranker: Name with model id.
        privileged: Whether it knows the truth.
    """

    run: str
    variant: str
    ranker: str
    privileged: bool = False

    @property
    def name(self) -> str:
        """What the address calls it."""
        return "/".join((self.run, self.variant, self.ranker))


@dataclass(frozen=True, slots=True)
class Matrix:
    """Two arms on the same tasks.

    Attributes:
        cells: Name of `CELLS` → the pairs of episodes in it.
        test: Exact McNemar over them; None where they share no scored task.
        words: What so many episodes can say.
    """

    cells: Mapping[str, tuple[Pair, ...]]
    test: McNemar | None
    words: str


def arms(library: Library) -> list[Arm]:
    """Every configuration in the index that left traces."""
    found = library.store.tuples(
        "select run, variant, ranker, max(privileged) from episodes where trace_sha256 <> '' "
        "group by run, variant, ranker order by run, variant, ranker"
    )
    return [Arm(run, variant, ranker, bool(truth)) for run, variant, ranker, truth in found]


def arm_named(library: Library, name: str) -> Arm:
    """The arm of that name; raises `InputError` where there is none."""
    known = {arm.name: arm for arm in arms(library)}
    if name not in known:
        message = f"expected a configuration among {', '.join(known) or 'none'}, came {name!r}"
        raise InputError(message)
    return known[name]


def matrix_of(library: Library, a: Arm, b: Arm) -> Matrix:
    """Set two arms against each other, task by task."""
    first, second = (_scored(library, arm) for arm in (a, b))
    tasks = [task for task in first if task in second]
    cells: dict[str, list[Pair]] = {name: [] for name in CELLS}
    for task in tasks:
        pair = (first[task], second[task])
        won = [case.values["success"] == 1 for case in pair]
        # CELLS in order: both bits set, the first alone, the second alone, none.
        cells[CELLS[3 - 2 * won[0] - won[1]]].append(pair)
    if not tasks:
        return Matrix(dict.fromkeys(CELLS, ()), None, "they share no scored episode")
    flags = [[each[task].values["success"] == 1 for task in tasks] for each in (first, second)]
    test = mcnemar(flags[0], flags[1])
    words = resolution(test.both + test.only_a, test.both + test.only_b, n=len(tasks)).words
    return Matrix({name: tuple(pairs) for name, pairs in cells.items()}, test, words)


def _scored(library: Library, arm: Arm) -> dict[tuple[str, int], Case]:
    """Scored episodes of an arm by (episode, seed)."""
    line = " ".join(
        term(name, value)
        for name, value in (("run", arm.run), ("variant", arm.variant), ("ranker", arm.ranker))
    )
    return {
        (str(case.values["episode_id"]), int(case.values["seed"] or 0)): case
        for case in everything(library.store, Query(line, "episode_id"))
        if case.sha256 and case.values["success"] is not None
    }
