"""`replay`: the answers of recorded traces, by the hash of the exact request.

It answers word-for-word and pixel-for-pixel what was asked before and nothing else: a run that
drifts from its record ends as `error` at the first request that the record does not hold.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from c2nav_engine.contract.presentation import presentations
from c2nav_engine.contract.prompt import Reply
from c2nav_engine.contract.render import render
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.asking import asking_from
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.rankers.options import OptionReader
from c2nav_engine.rankers.replay import Replay, recorded_replies
from c2nav_engine.rankers.wrapper import AskingRanker
from c2nav_engine.runner.exchange import Exchange, Override
from c2nav_engine.runner.opening import Seat, Stage
from c2nav_engine.runner.recorded import open_trace

NAME = "replay"


@dataclass(frozen=True, slots=True)
class Recording:
    """One trace that answers may come from.

    Attributes:
        path: Its file.
        episode_id: Episode.
        config_sha256: Config of the loop.
        seed: Run seed.
        ranker: Who answered then.
    """

    path: Path
    episode_id: str
    config_sha256: str
    seed: int
    ranker: str


class Recordings:
    """The traces that a `trace` option names: one file, or those of a run folder.

    Args:
        options: `trace=PATH`, and those that every ranker takes.

    Raises:
        UsageError: There is no trace, or one was answered by a ranker that knows the truth.
        TraceError: One cannot be read.
    """

    def __init__(self, options: Mapping[str, str]) -> None:
        self._asking, own = asking_from(options)
        reader = OptionReader(NAME, own)
        path = reader.text("trace")
        reader.done()
        self._options = dict(options)
        self.all = tuple(map(_recording, _files(path)))

    def seat(self, stage: Stage) -> Seat:
        """The seat of one episode: its own trace where there is one, else whatever fits best."""
        of_episode = [r for r in self.all if r.episode_id == stage.episode.episode_id]
        config_sha256 = stage.config.sha256()
        own = [r for r in of_episode if (r.config_sha256, r.seed) == (config_sha256, stage.seed)]
        adapter = replay_of(own or of_episode or self.all)
        return Seat(AskingRanker(adapter, self._asking), adapter.name, self._options)


def _files(path: str) -> list[Path]:
    if path and Path(path).is_file():
        return [Path(path)]
    found = sorted((Path(path) / "traces").glob("*.mcap")) if path else []
    if not found:
        message = f"expected the option trace of the ranker {NAME}, came {path or 'none'}"
        raise UsageError(f"{message}. Give a trace or a run folder: trace=RUN")
    return found


def replay_of(recordings: Sequence[Recording]) -> Replay:
    """An adapter that answers from these traces."""
    names = "+".join(dict.fromkeys(each.ranker for each in recordings))
    return Replay(answers_of(_decisions(recordings)), name=f"{NAME}:{names}")


def answers_of(decisions: Iterable[Exchange]) -> dict[str, tuple[Reply, ...]]:
    """Request hash → what was committed, in recorded order.

    A person who answered in a ranker's place had one order on the desk and answers all of them.
    """
    found: dict[str, tuple[Reply, ...]] = {}
    for decision in decisions:
        if not isinstance(decision.request, Ask):
            continue
        if decision.override is not None:
            said = _overridden(decision.request, decision.override)
        else:
            said = recorded_replies([decision.ranked] if decision.ranked is not None else [])
        for key, replies in said.items():
            found[key] = (*found.get(key, ()), *replies)
    return found


def _overridden(ask: Ask, override: Override) -> dict[str, tuple[Reply, ...]]:
    reply = Reply(outcome=override.outcome)
    orders = range(len(presentations(ask.question)))
    return {render(ask.question, order).request_sha256: (reply,) for order in orders}


def _decisions(recordings: Iterable[Recording]) -> Iterator[Exchange]:
    for recording in recordings:
        with open_trace(recording.path) as trace:
            yield from trace.decisions()


def _recording(path: Path) -> Recording:
    with open_trace(path) as trace:
        facts = trace.file.facts
    if facts["privileged"] == "yes":
        message = (
            f"expected answers of a ranker that does not know the truth, {path} has those of "
            f"{facts['ranker']}. Name that ranker itself, or reproduce with `c2nav replay {path}`"
        )
        raise UsageError(message)
    return Recording(
        path=path,
        episode_id=facts["episode"],
        config_sha256=facts["config_sha256"],
        seed=int(facts["seed"]),
        ranker=facts["ranker"],
    )
