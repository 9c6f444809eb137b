"""Runs sorted into what may be compared: protocols, systems under them, and their arms."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from c2nav_engine.experiments.columns import Row
from c2nav_engine.experiments.report.reading import Protocol, Run
from c2nav_engine.navigator.variants import PRESETS, preset


@dataclass(frozen=True, slots=True)
class Arm:
    """One configuration of one system with its rows.

    Attributes:
        config_sha256: Hash of the loop's config; presets that share it are one arm.
        variants: Names under which it ran, in order.
        rows: One row an episode and seed.
        folders: Run folder of each row.
    """

    config_sha256: str
    variants: tuple[str, ...]
    rows: tuple[Row, ...]
    folders: tuple[Path, ...]

    @property
    def episodes(self) -> int:
        """Distinct episodes."""
        return len({row["episode_id"] for row in self.rows})

    def outcomes(self, seed: int) -> dict[str, Row]:
        """Rows of one seed by episode."""
        return {str(row["episode_id"]): row for row in self.rows if row["seed"] == seed}

    @property
    def seeds(self) -> tuple[int, ...]:
        """Seeds in rising order."""
        return tuple(sorted({int(row["seed"] or 0) for row in self.rows}))


@dataclass(frozen=True, slots=True)
class System:
    """A ranker with its options under one protocol.

    Attributes:
        label: The ranker's name, with more where two systems share it.
        ranker: The ranker's name with its model id.
        arms: Distinct configurations in order of first appearance.
    """

    label: str
    ranker: str
    arms: tuple[Arm, ...]

    def arm(self, variant: str) -> Arm | None:
        """The arm that ran under that preset, or under another name with the same config."""
        named = next((arm for arm in self.arms if variant in arm.variants), None)
        if named is not None:
            return named
        wanted = preset(variant).sha256()
        return next((arm for arm in self.arms if arm.config_sha256 == wanted), None)


@dataclass(frozen=True, slots=True)
class Section:
    """Systems whose figures may stand side by side.

    Attributes:
        protocol: What they share.
        privileged: Whether they know the truth; such ones never share a section with models.
        systems: In order of the runs.
    """

    protocol: Protocol
    privileged: bool
    systems: tuple[System, ...]


@dataclass
class _Gathering:
    """A system while runs are still being read."""

    run: Run
    rows: dict[tuple[str, str, int], tuple[Row, Path]] = field(
        default_factory=dict[tuple[str, str, int], tuple[Row, Path]]
    )
    names: dict[str, list[str]] = field(default_factory=dict[str, list[str]])


def sections_of(runs: Sequence[Run]) -> tuple[Section, ...]:
    """Sort runs into sections.

    Runs of one ranker and protocol are one system as long as they hold different tasks; a task
    that was run twice makes a second system, told apart by its folder.
    """
    gathered: list[_Gathering] = []
    for run in runs:
        _gather(run, gathered)
    groups: dict[tuple[Protocol, bool], list[_Gathering]] = {}
    for each in gathered:
        groups.setdefault((each.run.protocol, each.run.privileged), []).append(each)
    return tuple(
        Section(protocol, privileged, tuple(_systems(members)))
        for (protocol, privileged), members in sorted(groups.items(), key=lambda item: item[0][1])
    )


def _gather(run: Run, gathered: list[_Gathering]) -> None:
    rows = {
        (run.configs[str(row["variant"])], str(row["episode_id"]), int(row["seed"] or 0)): row
        for row in run.rows
    }
    fitting = (
        each for each in gathered if _same_system(each.run, run) and not rows.keys() & each.rows
    )
    home = next(fitting, None)
    if home is None:
        home = _Gathering(run)
        gathered.append(home)
    home.rows.update({key: (row, run.folder) for key, row in rows.items()})
    for variant, config in run.configs.items():
        names = home.names.setdefault(config, [])
        if variant not in names:
            names.append(variant)


def _same_system(a: Run, b: Run) -> bool:
    return (a.protocol, a.ranker, a.options, a.privileged) == (
        b.protocol,
        b.ranker,
        b.options,
        b.privileged,
    )


def _systems(members: Sequence[_Gathering]) -> Iterator[System]:
    labels = _labels([each.run for each in members])
    for each, label in zip(members, labels, strict=True):
        arms = tuple(_arm(config, names, each) for config, names in _in_table_order(each.names))
        yield System(label, each.run.ranker, tuple(arm for arm in arms if arm.rows))


def _arm(config: str, names: Sequence[str], gathering: _Gathering) -> Arm:
    found = [pair for (sha256, _, _), pair in gathering.rows.items() if sha256 == config]
    return Arm(
        config_sha256=config,
        variants=tuple(names),
        rows=tuple(row for row, _ in found),
        folders=tuple(folder for _, folder in found),
    )


def _in_table_order(names: Mapping[str, Sequence[str]]) -> Iterable[tuple[str, Sequence[str]]]:
    order = {variant: place for place, variant in enumerate(PRESETS)}
    return sorted(names.items(), key=lambda item: order.get(item[1][0], len(order)))


def _labels(runs: Sequence[Run]) -> list[str]:
    """The ranker's name; with its options, else its folder, where that does not tell them apart."""
    plain = [run.ranker for run in runs]
    if len(set(plain)) == len(plain):
        return plain
    optioned = [
        " ".join([run.ranker, *(f"{key}={value}" for key, value in sorted(run.options.items()))])
        for run in runs
    ]
    if len(set(optioned)) == len(optioned):
        return optioned
    return [f"{name} ({run.folder.name})" for name, run in zip(optioned, runs, strict=True)]
