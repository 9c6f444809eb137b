"""What an inspector is opened on: entries to choose from, and how one of them is started."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from app.session.book import Book
from app.session.reasked import NOTHING, ByDecision
from c2nav_engine.contract.prompt import Ranked
from c2nav_engine.contract.question import Picture
from c2nav_engine.navigator.requests import Request
from c2nav_engine.rankers.tally import Telling
from c2nav_engine.runner.exchange import Exchange, Override
from c2nav_engine.runner.record import Footer, Header
from c2nav_engine.runner.worlds import World
from c2nav_engine.world.connectivity import ConnectivityGraph
from c2nav_engine.world.scene import Scene
from c2nav_engine.world.surface import Surface


class Run(Protocol):
    """A live episode that the session drives: `c2nav_engine.runner.episode_run.EpisodeRun`."""

    @property
    def header(self) -> Header:
        """What was known before the first request."""
        ...

    @property
    def exchanges(self) -> list[Exchange]:
        """Everything so far."""
        ...

    @property
    def pending(self) -> Request | None:
        """What the core waits for; None when the episode is over."""
        ...

    @property
    def footer(self) -> Footer | None:
        """How it ended."""
        ...

    @property
    def trace_sha256(self) -> str:
        """Digest of the finished trace; "" before, or where nothing is recorded."""
        ...

    @property
    def trace(self) -> str:
        """Path of the trace, which is there once it is finished; "" where nothing is recorded."""
        ...

    def advance(self) -> Exchange:
        """Answer the pending request, asking the ranker where it is a question."""
        ...

    def propose(self, told: Telling | None = None) -> Ranked:
        """What the ranker says to the pending question, without committing it.

        `told` hears how many queries are answered, of how many, from any thread.
        """
        ...

    def commit(self, override: Override | None = None) -> Exchange:
        """Commit the proposal, or a person's answer in its place."""
        ...

    def keep(self, name: str, data: bytes) -> None:
        """Attach a file to the trace, once by that name."""
        ...

    def close(self) -> None:
        """Let go of what it holds."""
        ...


@dataclass(frozen=True, slots=True)
class Entry:
    """One thing that can be opened: an episode of a dataset, or a trace.

    Attributes:
        entry_id: Stable name.
        label: What a list calls it.
        outcome: How it ended, for a recorded one; "" otherwise.
        variant: Of a recorded one; "" otherwise.
        success: Whether a recorded one stopped within the goal radius; None while unknown.
        thumbnail: Fetches a small picture of it, or None; called once, when it is looked at.
    """

    entry_id: str
    label: str
    outcome: str = ""
    variant: str = ""
    success: bool | None = None
    thumbnail: Callable[[], Picture | None] | None = None


@dataclass(frozen=True, slots=True)
class Choice:
    """What is open, or wanted: an entry, and for a live one the variant and ranker."""

    entry_id: str
    variant: str = ""
    ranker: str = ""


@dataclass(frozen=True, slots=True)
class Opening:
    """One entry, opened.

    Attributes:
        header: What was known before the first request.
        exchanges: What is recorded already; empty for a live one.
        footer: How the recording ended; None for a live one.
        run: The live episode; None for a recording.
        trace_sha256: Digest of the recording.
        source: File name of the recording.
        trace: Path of the recording.
        scene: Loads the scene for display; None where it is not to be had.
        surface: Loads the floor, for suspects; None where it is not to be had.
        no_scene: Why there is no scene, and what to do about it.
        reasked: What a re-evaluation says of the recording, by decision.
        world: Loads the scene to drive through again, anew each time, because a world serves one
            thread; None where it is not to be had.
        viewpoints: Reads the scan's connectivity graph; None where no folder was named.
    """

    header: Header
    exchanges: Sequence[Exchange] = ()
    footer: Footer | None = None
    run: Run | None = None
    trace_sha256: str = ""
    source: str = ""
    trace: str = ""
    scene: Callable[[], Scene] | None = None
    surface: Callable[[], Surface] | None = None
    no_scene: str = ""
    reasked: ByDecision = field(default_factory=lambda: NOTHING)
    world: Callable[[], World] | None = None
    viewpoints: Callable[[], ConnectivityGraph] | None = None

    @property
    def floor(self) -> Callable[[], Surface] | None:
        """Loads the floor of a recording, or gives that of the live episode."""
        if self.surface is not None:
            return self.surface
        found: Surface | None = getattr(self.run, "surface", None)
        return None if found is None else lambda: found


@dataclass(frozen=True, slots=True)
class ForkAt:
    """Another answer at a decision of a branch.

    Attributes:
        header: Of the branch that is left.
        exchanges: What happened in it.
        decision: Where it is left.
        override: The new answer there.
        ranker: Who answers from then on; "" for whoever was named at the start.
        options: Of that ranker; None for those that were given at the start.
    """

    header: Header
    exchanges: Sequence[Exchange]
    decision: int
    override: Override
    ranker: str = ""
    options: Mapping[str, str] | None = None


@dataclass(frozen=True, slots=True)
class Opened:
    """A source that the inspector shows.

    Attributes:
        title: Dataset or folder name.
        entries: What can be chosen.
        first: What is open at the start.
        open: Starts a choice; raises `C2NavError` with words for a person.
        fork: Starts a fork; None where forks cannot be made.
        variants: Names to choose from; empty for recordings.
        rankers: Names to choose from; empty for recordings.
        sends_to: Host outside this machine that pictures would go to; "" for none.
        book: Opens the reviews of an entry's trace with that digest, or of a new one ("");
            None where nothing can be reviewed.
        blind: Whether answers are covered at the start.
        host_of: Ranker and options → host outside this machine that pictures would go to.
    """

    title: str
    entries: tuple[Entry, ...]
    first: Choice
    open: Callable[[Choice], Opening]
    fork: Callable[[ForkAt], Run] | None = None
    variants: tuple[str, ...] = ()
    rankers: tuple[str, ...] = ()
    sends_to: str = ""
    book: Callable[[str, str], Book] | None = None
    blind: bool = False
    host_of: Callable[[str, Mapping[str, str]], str] = lambda _ranker, _options: ""
