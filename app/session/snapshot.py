"""The immutable picture of everything that views are drawn from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from app.session.branches import Branch
from app.session.decisions import Decision
from app.session.draft import Draft
from app.session.opened import Choice, Entry
from app.session.overlay_state import NO_OVERLAYS, Overlays
from app.session.reasked import NOTHING, ByDecision, Reasked, shared_until
from app.session.story import Stop, Story
from app.session.turning_state import Turning
from c2nav_engine.contract.outcome import Answered, Key
from c2nav_engine.contract.prompt import Ranked
from c2nav_engine.geometry import Point

LAYERS = (
    *("scene", "trajectory", "fan", "goal", "reference"),
    *("markers", "thumbnails", "floor", "viewpoints"),
)
"""What can be shown and hidden in the map."""

LAYERS_AT_FIRST = frozenset(("scene", "trajectory", "fan", "markers", "thumbnails"))


@dataclass(frozen=True, slots=True)
class Asking:
    """A question that is with the ranker.

    Attributes:
        branch_id: Of which branch.
        decision: Which one.
        since_s: Wall clock when it went out.
        queries: How many queries it takes, as far as is known.
        answered: How many of them are answered.
        usual_s: Median wall time of a whole answer so far; None before the first.
    """

    branch_id: str
    decision: int
    since_s: float
    queries: int
    answered: int = 0
    usual_s: float | None = None


@dataclass(frozen=True, slots=True)
class ForkOffer:
    """A past override that waits for a yes, with what it is expected to take."""

    decision: int
    decisions: int
    queries: int
    seconds: float
    dollars: float


@dataclass(frozen=True, slots=True)
class Notice:
    """One message to the person.

    Attributes:
        text: What to say.
        fault: Whether something went wrong.
        serial: Counts up, so that the same words can be said twice.
    """

    text: str = ""
    fault: bool = False
    serial: int = 0


WHOLE = -1
"""Stands for the episode as a whole where a decision is named: leg ends belong to no decision."""


@dataclass(frozen=True, slots=True)
class Judgement:
    """What one person says about one decision.

    Attributes:
        verdict: "agree", "acceptable", "wrong", "cannot tell" or "".
        tags: In the order they were put on.
        flagged: Marked for later.
        note: Free words.
        better: The alternative that would have been better; "" for none.
        ranking: Their own answer; None for none.
        leg_ends: Leg → the low-level step at which it ends.
        blind: Whether all of it was said with the model's answer hidden.
    """

    verdict: str = ""
    tags: tuple[str, ...] = ()
    flagged: bool = False
    note: str = ""
    better: Key = ""
    ranking: Answered | None = None
    leg_ends: Mapping[int, int] = field(default_factory=dict[int, int])
    blind: bool = True

    @property
    def says_something(self) -> bool:
        """Whether there is anything but the default."""
        return replace(self, blind=True) != Judgement()


Reviews = dict[tuple[str, int], Judgement]
"""(Author, decision) → what they say."""


@dataclass(frozen=True, slots=True)
class Assessment:
    """One decision held against the truth (evaluation side; never shown to who judges blind).

    Attributes:
        decision: Which one.
        regret_m: Geodesic metres given away against the best offered alternative; None where
            that means nothing.
        words: Why no answer could have been good, or "early" and "late" of a transition.
        off_path_m: Distance from the reference path; None without one.
    """

    decision: int
    regret_m: float | None = None
    words: str = ""
    off_path_m: float | None = None


@dataclass(frozen=True, slots=True)
class Sighting:
    """What one look says of an asked place: "seen", "vetoed", "hidden", "away" or "unsure"."""

    step: int
    status: str


@dataclass(frozen=True, slots=True)
class PlaceAnswer:
    """Where an asked place was seen.

    Attributes:
        point_m: The place.
        sightings: One per look, in order.
        marks: Digest of a picture → where the place is in it, as fractions of width and height.
        basis: What the answer rests on, for people.
    """

    point_m: Point
    sightings: tuple[Sighting, ...]
    marks: Mapping[str, tuple[float, float]]
    basis: str


SUSPECT_M = 0.15
"""Regret below this is noise of a bundle's length [C]."""

BAD_M = 1.0
"""The first decision over this is where `B` goes."""


def suspects_of(assessments: Mapping[int, Assessment]) -> tuple[Assessment, ...]:
    """Decisions worth a look, worst first; faults of the controller follow those of answers."""
    worth = [a for a in assessments.values() if (a.regret_m or 0.0) >= SUSPECT_M or a.words]
    return tuple(sorted(worth, key=lambda a: (-(a.regret_m or 0.0), a.decision)))


@dataclass(frozen=True, slots=True)
class View:
    """How the map is looked at.

    Attributes:
        camera: "free", "follow", "ego" or "top".
        kind: Which disagreement the bracket keys look for.
        layers: Shown layers.
        hovered: Lit alternative; "" for none.
        blind: Whether answers stay covered until they are revealed.
    """

    camera: str = "free"
    kind: Literal["any", "orders", "person", "reasked", "best"] = "any"
    layers: frozenset[str] = LAYERS_AT_FIRST
    hovered: str = ""
    blind: bool = False


@dataclass(frozen=True, slots=True)
class Chooser:
    """What is open and what else there is."""

    title: str
    entries: tuple[Entry, ...]
    choice: Choice
    variants: tuple[str, ...] = ()
    rankers: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Snapshot:
    """Everything, at one moment.

    Attributes:
        version: Counts up with every publication.
        chooser: What is open and what else there is.
        branches: All branches; the first is the root.
        branch: The branch in view.
        story: That branch, read.
        stop: Index into the story's stops: where one stands.
        proposals: Branch → the ranker's record for its pending decision.
        asking: The question that is out, if any.
        let_go: Branch → why nobody answers its pending question any longer, in words.
        draft: The person's ranking so far.
        why: What the person says about it.
        offer: A fork that waits for a yes.
        playing: "" or what it plays to ("play", "seeing", …, "end").
        view: How the map is looked at.
        reviews: Branch → (author, decision) → what they say.
        tags: The list of tags to choose from.
        revealed: Branches and decisions whose answers were revealed while covered.
        covered: Whether the answer of the decision in view is covered.
        notice: Last message.
        driver: Page that sent the last command.
        who: Name of the person.
        working: What a background task is doing, "" for nothing.
        consent_to: Host that waits for a yes before pictures go to it; "" for none.
        no_scene: Why there is no scene; "" where there is one or it is on its way.
        scene_serial: Counts the scenes that came.
        parent: For a fork, the story it left.
        place: The asked place, and where it was seen in the branch in view.
        assessed: Branch → decision → what the truth says of it.
        reasked: Decision of the root → what a re-evaluation says of its question.
        turning: Failed branch → its turning points, as far as they are known.
        overlays: Walkable floor and viewpoints, once they were asked for.
    """

    version: int
    chooser: Chooser
    branches: tuple[Branch, ...]
    branch: Branch
    story: Story
    stop: int
    proposals: dict[str, Ranked] = field(default_factory=dict[str, Ranked])
    asking: Asking | None = None
    let_go: dict[str, str] = field(default_factory=dict[str, str])
    draft: Draft = field(default_factory=Draft)
    why: str = ""
    offer: ForkOffer | None = None
    playing: str = ""
    view: View = field(default_factory=View)
    reviews: dict[str, Reviews] = field(default_factory=dict[str, Reviews])
    tags: tuple[str, ...] = ()
    revealed: frozenset[tuple[str, int]] = frozenset()
    covered: bool = False
    notice: Notice = field(default_factory=Notice)
    driver: str = ""
    who: str = "person 1"
    working: str = ""
    consent_to: str = ""
    no_scene: str = ""
    scene_serial: int = 0
    parent: Story | None = None
    place: PlaceAnswer | None = None
    assessed: dict[str, dict[int, Assessment]] = field(
        default_factory=dict[str, dict[int, Assessment]]
    )
    reasked: ByDecision = field(default_factory=lambda: NOTHING)
    turning: dict[str, Turning] = field(default_factory=dict[str, Turning])
    overlays: Overlays = NO_OVERLAYS

    @property
    def here(self) -> Stop:
        """Where one stands."""
        return self.story.stops[self.stop]

    @property
    def decision(self) -> Decision | None:
        """The decision in view: the one here, or the last one before."""
        return self.story.decision_at(self.stop)

    @property
    def turning_here(self) -> Turning | None:
        """Turning points of the branch in view; hidden from who judges blind."""
        return None if self.view.blind else self.turning.get(self.branch.branch_id)

    @property
    def judgements(self) -> dict[int, Judgement]:
        """What who sits at the page says of the branch in view, by decision."""
        reviews = self.reviews.get(self.branch.branch_id, {})
        return {number: said for (who, number), said in reviews.items() if who == self.who}

    @property
    def others(self) -> dict[str, Judgement]:
        """What everybody else says of the decision in view, by author."""
        reviews = self.reviews.get(self.branch.branch_id, {})
        return {
            who: said
            for (who, number), said in reviews.items()
            if number == self.here.decision and who != self.who
        }

    @property
    def assessments(self) -> dict[int, Assessment]:
        """What the truth says of the decisions of the branch in view, as far as it is known."""
        return self.assessed.get(self.branch.branch_id, {})

    def reasked_at(self, decision: int) -> tuple[Reasked, ...]:
        """Answers of a re-evaluation to a decision of the branch in view.

        A fork has its questions in common with the recording up to where it left.
        """
        shared = shared_until(self.branch, self.branches)
        if shared is not None and decision > shared:
            return ()
        return self.reasked.get(decision, ())

    @property
    def suspects(self) -> tuple[Assessment, ...]:
        """Decisions of the branch in view that are worth a look, worst first."""
        return suspects_of(self.assessments)

    @property
    def no_suspects(self) -> str:
        """Why `suspects` is empty, in words."""
        made = sum(not decision.pending for decision in self.story.decisions)
        if self.view.blind:
            return "Not shown while answers are covered"
        if self.no_scene:
            return "Measured over the scene's floor: open with --scenes DIR"
        if self.story.header.episode.goal_m is None:
            return "The goal of this episode is not known"
        if made and self.branch.branch_id not in self.assessed:
            return "Measuring…"
        if made and not self.assessments:
            return "No way over this floor leads to the goal, so nothing can be measured"
        if len(self.assessments) < made:
            return "Measuring…"
        return "None so far" if self.branch.running else "None"

    @property
    def proposal(self) -> Ranked | None:
        """What the ranker says to the pending decision, when that is in view."""
        decision = self.decision
        if decision is None or not decision.pending:
            return None
        return self.proposals.get(self.branch.branch_id)

    @property
    def shown(self) -> Ranked | None:
        """The record of the decision in view, proposed or made."""
        decision = self.decision
        return None if decision is None else (decision.ranked or self.proposal)

    @property
    def token(self) -> str:
        """Id of what one sees: changes with the branch, its length and the decision in view."""
        return f"{self.branch.branch_id}.{self.story.length}.{self.here.decision}"
