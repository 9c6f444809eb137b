"""`c2nav run`: episodes × variants × seeds into a run folder."""

from __future__ import annotations

import signal
import sys
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Annotated, TypeVar

import tyro

from app.commands.options import (
    EpisodesOpt,
    GroundTruthOpt,
    HeadingsOpt,
    JsonOpt,
    RankerOptions,
    ScenesOpt,
    SourceArg,
    ids,
    key_values,
    whole_numbers,
    words,
)
from app.commands.output import check_folder, print_json
from app.commands.run_words import error_lines, progress_bar, tell_rows
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.batch import BatchResult, run_batch
from c2nav_engine.experiments.executors.choosing import EXECUTORS, executor_for
from c2nav_engine.experiments.rankers import DEFAULT_RANKER, check_unattended
from c2nav_engine.experiments.spec import RunSpec, Setting
from c2nav_engine.experiments.summary import summarise
from c2nav_engine.experiments.working import source_of
from c2nav_engine.navigator.variants import preset


def run(
    source: SourceArg,
    out: Annotated[Path, tyro.conf.arg(metavar="RUN", help="Folder for traces and tables.")],
    scenes: ScenesOpt = None,
    variants: Annotated[str, tyro.conf.arg(metavar="NAMES", help="Comma-separated.")] = "full",
    ranker: str = DEFAULT_RANKER,
    ranker_opt: RankerOptions = (),
    episodes: EpisodesOpt = "",
    seeds: Annotated[str, tyro.conf.arg(metavar="N,N", help="Run seeds.")] = "0",
    profile: Annotated[str, tyro.conf.arg(help="Embodiment profile.")] = "vlnce",
    headings: HeadingsOpt = None,
    ground_truth: GroundTruthOpt = None,
    workers: Annotated[int, tyro.conf.arg(help="Processes, actors or jobs; one core each.")] = 1,
    executor: Annotated[str, tyro.conf.arg(help=f"One of {', '.join(EXECUTORS)}.")] = "local",
    executor_opt: Annotated[
        tuple[str, ...],
        tyro.conf.UseAppendAction,
        tyro.conf.arg(metavar="KEY=VALUE", help="An option of the executor; repeat for more."),
    ] = (),
    odometry_noise: Annotated[
        float, tyro.conf.arg(help="Deviation of steps and turns, as a fraction of them.")
    ] = 0.0,
    depth_noise: Annotated[
        float, tyro.conf.arg(help="Deviation of depths, as a fraction of them.")
    ] = 0.0,
    parser: Annotated[
        str, tyro.conf.arg(help="Route parser: english, or model (the ranker's server).")
    ] = "english",
    sliding: Annotated[bool, tyro.conf.arg(help="Whether blocked moves slide.")] = True,
    resume: Annotated[bool, tyro.conf.arg(help="Finish what is missing.")] = False,
    dry_run: Annotated[
        bool, tyro.conf.arg(help="Say what it would take, and run nothing.")
    ] = False,
    json: JsonOpt = False,
) -> int:
    """Run episodes and write traces, `episodes.csv` and `summary.json`."""
    if not dry_run:
        check_folder(out)
    setting = Setting(
        source=source if source == "builtin" else str(Path(source).resolve()),
        scenes=str(scenes.resolve()) if scenes else "",
        headings=str(headings.resolve()) if headings else "",
        ground_truth=str(ground_truth.resolve()) if ground_truth else "",
        profile=profile,
        ranker=ranker,
        ranker_options=key_values(ranker_opt),
        odometry_noise=odometry_noise,
        depth_noise=depth_noise,
        sliding=sliding,
        parser=parser,
    )
    spec = spec_of(
        setting, variants=variants, episodes=episodes, seeds=seeds, find_scenes=not dry_run
    )
    chosen = executor_for(executor, setting, workers=workers, options=key_values(executor_opt))
    if dry_run:
        # The estimate's statistics take a second to import, which a run need not wait for.
        from app.commands.run_estimate import tell_estimate

        return tell_estimate(spec, out, workers=workers, json=json)
    with _polite(), progress_bar(quiet=json) as tell:
        result = run_batch(spec, out, chosen, resume=resume, progress=tell)
    if json:
        print_json({"run": str(out), **summarise(result.rows)})
    else:
        tell_rows(result.rows)
    return _code(result)


def spec_of(
    setting: Setting, *, variants: str, episodes: str, seeds: str, find_scenes: bool = True
) -> RunSpec:
    """The run that the words of a command line describe.

    Args:
        setting: What its tasks share.
        variants: Comma-separated presets.
        episodes: Ids, as in 1,5-9; "" for all.
        seeds: Comma-separated whole numbers.
        find_scenes: Whether a missing scene is an error.

    Raises:
        InputError: A name, file or scene does not exist.
    """
    setting.check()
    check_unattended(setting.ranker)
    names = _some(words(variants), f"variants, as in full,base; came --variants {variants!r}")
    numbers = whole_numbers(seeds, "seeds")
    _some(numbers, f"seeds, as in 0,1; came --seeds {seeds!r}")
    for name in names:
        preset(name)
    source = source_of(setting)
    chosen = source.chosen(ids(episodes))
    if find_scenes:
        source.require_scenes(chosen)
    return RunSpec(
        setting=setting,
        episodes=tuple(episode.episode_id for episode in chosen),
        variants=names,
        seeds=numbers,
        scenes=tuple(episode.scene_id for episode in chosen),
    )


T = TypeVar("T")


def _some(found: tuple[T, ...], what: str) -> tuple[T, ...]:
    if not found:
        message = f"expected one or more {what}"
        raise UsageError(message)
    return found


def _code(result: BatchResult) -> int:
    """Tell what failed; 2 when an episode or scene cannot be used, 1 for any other error."""
    for line in error_lines(result.errors):
        sys.stderr.write(f"c2nav: {line}\n")
    if result.bad_input:
        return 2
    return 1 if any(row["outcome"] == "error" for row in result.rows) else 0


@contextmanager
def _polite() -> Generator[None]:
    """A scheduler that takes the machine back asks first (SIGTERM): as good as an interrupt."""

    def interrupt(number: int, frame: FrameType | None) -> None:
        del number, frame
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGTERM, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
