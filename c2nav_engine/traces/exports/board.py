"""What a video shows at one moment, gathered from a trace; no drawing here."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from c2nav_engine.geometry import Pose
from c2nav_engine.traces.attachments import Task
from c2nav_engine.traces.contract_messages import outcome_of
from c2nav_engine.traces.moments import Moment, moments, pictures
from c2nav_engine.traces.pb.control_pb2 import Control
from c2nav_engine.traces.pb.decision_pb2 import Decision
from c2nav_engine.traces.pb.route_pb2 import Ladder, Sketch
from c2nav_engine.traces.reader import TraceFile
from c2nav_engine.traces.words import committed_words, outcome_words, winner_of


@dataclass(frozen=True, slots=True)
class Tile:
    """One picture on the board.

    Attributes:
        title: What stands above it.
        jpeg: The bytes; b"" where the trace lacks them.
        elected: Whether the decision chose it.
        veto: Why it was not offered, "" when it was.
    """

    title: str
    jpeg: bytes
    elected: bool = False
    veto: str = ""


@dataclass(frozen=True, slots=True)
class Board:
    """Everything that a frame shows.

    Attributes:
        step: Low-level actions executed.
        leg: Active leg.
        tiles: Pictures from left to right.
        trail: Poses so far, one a step.
        heading: Title of the decision.
        words: What was decided, answered and recorded, newest last.
        ladder: Arriving's evidence in words.
        hold: How many frames of a second this moment deserves, in seconds.
    """

    step: int = 0
    leg: int = 0
    tiles: tuple[Tile, ...] = ()
    trail: tuple[Pose, ...] = ()
    heading: str = ""
    words: tuple[str, ...] = ()
    ladder: str = ""
    hold_s: float = 0.0


STEP_S = 0.25
DECISION_S = 1.25
END_S = 2.0
FAN = ("left", "front", "right")


@dataclass(slots=True)
class Boards:
    """Follows a trace and yields a board wherever something new is to be seen."""

    trace: TraceFile
    task: Task
    _board: Board = field(default_factory=Board)
    _views: dict[str, bytes] = field(default_factory=dict[str, bytes])

    def __iter__(self) -> Iterator[Board]:
        """One board a step, a decision, and the end."""
        for moment in moments(self.trace):
            yield from self._after(moment)
        yield replace(self._board, hold_s=END_S)

    def _after(self, moment: Moment) -> Iterator[Board]:
        message = moment.message
        if isinstance(message, Decision):
            yield self._decided(message)
        elif isinstance(message, Sketch):
            self._board = replace(self._board, leg=message.leg)
        elif isinstance(message, Ladder):
            evidence = f"({message.ground:+d}, {message.journey:+d}, {message.lookback:+d})"
            words = ", ".join([*message.vetoes, *filter(None, [message.event])])
            ladder = f"{evidence} → {message.verdict}" + (f" ({words})" if words else "")
            self._board = replace(self._board, ladder=ladder)
        else:
            yield from self._controlled(moment, message)

    def _controlled(self, moment: Moment, control: Control) -> Iterator[Board]:
        what = control.WhichOneof("what")
        if what == "look":
            self._looked(control)
            yield self._board
        elif what == "move":
            for step, pose in moment.poses():
                trail = (*self._board.trail, pose)
                self._board = replace(self._board, step=step, trail=trail)
                yield replace(self._board, hold_s=STEP_S)
        elif what == "event":
            words = f"{control.event.name}: {control.event.detail}"
            self._board = replace(self._board, words=(*self._board.words, words)[-6:])
        else:
            self._board = replace(self._board, words=(*self._board.words, "STOP")[-6:])

    def _looked(self, control: Control) -> None:
        held = pictures(self.trace, control)
        if control.look.sectors:
            tiles = [Tile(f"sector {k}", held[each]) for k, each in enumerate(control.look.sectors)]
        else:
            # A front view alone replaces the fan: the side views are of another place.
            self._views = {view.key: held[view.picture] for view in control.look.views}
            tiles = [Tile(key, self._views[key]) for key in FAN if key in self._views]
        self._board = replace(self._board, tiles=tuple(tiles))

    def _decided(self, decision: Decision) -> Board:
        held = pictures(self.trace, decision)
        winner = winner_of(decision)
        tiles = [
            Tile(each.key, held.get(each.picture, b""), each.key == winner, each.veto)
            for each in decision.facts.candidates
            if each.picture
        ]
        words = [committed_words(decision)]
        if decision.by == "override" and decision.HasField("ranked"):
            words.append(f"the ranker said {outcome_words(outcome_of(decision.ranked.outcome))}")
        words += [f"“{query.text}”" for query in decision.ranked.queries[:2] if query.text]
        self._board = replace(
            self._board,
            leg=decision.facts.leg,
            tiles=tuple(tiles) or self._board.tiles,
            heading=f"decision {decision.decision} · {decision.slot}",
            words=tuple(words),
        )
        return replace(self._board, hold_s=DECISION_S)
