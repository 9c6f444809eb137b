"""The session's truth: branches, runs and the snapshot that is being made.

Only the worker's thread touches a desk. What may take long goes to `background` and comes back as
a message.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from app.session.assessing import Assessor, assessor_of
from app.session.branches import Branch, Origin
from app.session.consent import Consent
from app.session.draft import Draft
from app.session.opened import Choice, Opened, Opening, Run
from app.session.pictures import Album
from app.session.placing import Sight
from app.session.searching import Search
from app.session.shelf import Shelf
from app.session.snapshot import Asking, Assessment, Chooser, Notice, Reviews, Snapshot, View
from app.session.story import Story, story_of
from c2nav_engine.errors import C2NavError
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.worlds import World
from c2nav_engine.world.connectivity import ConnectivityGraph
from c2nav_engine.world.scene import Scene
from c2nav_engine.world.surface import Surface

log = logging.getLogger(__name__)

Message = Callable[["Desk"], None]
"""What comes back from the background: applied on the worker's thread."""


@dataclass(frozen=True, slots=True)
class Errand:
    """A question that is with the ranker: late answers are told by it."""

    generation: int
    branch_id: str
    decision: int


@dataclass(frozen=True, slots=True)
class Hands:
    """What a desk may use of the world around it.

    Attributes:
        background: Runs a task on another thread and applies the message it returns.
        clock: Wall clock, seconds since the epoch.
        post: Applies a message, from any thread.
        after_page: Returns once heavy work is in no page's way; called in the background.
        after_scene: Returns once the scene is sent, too.
    """

    background: Callable[[Callable[[], Message]], None]
    clock: Callable[[], float]
    post: Callable[[Message], None]
    after_page: Callable[[], None] = lambda: None
    after_scene: Callable[[], None] = lambda: None


class Desk:
    """Branches, runs, stories, and the snapshot under construction."""

    def __init__(self, opened: Opened, album: Album, hands: Hands) -> None:
        """Open the source's first choice; raises `C2NavError` when that cannot be done."""
        self.opened = opened
        self.album = album
        self.hands = hands
        self.shelf = Shelf(opened.book)
        self.branches: dict[str, Branch] = {}
        self.stories: dict[str, Story] = {}
        self.runs: dict[str, Run] = {}
        self.asked: set[str] = set()
        self.out: dict[Errand, Asking] = {}
        self.scene: Scene | None = None
        self.sight: Sight | None = None
        self.consent: Consent | None = None
        self.commit_when_answered = False
        self.due_s = 0.0
        self.assessor: Assessor | None = None
        self.floor: Callable[[], Surface] | None = None
        self.assessing = False
        self.world: Callable[[], World] | None = None
        self.viewpoints: Callable[[], ConnectivityGraph] | None = None
        self.searches: dict[str, Search] = {}
        self._generation = 0
        self._branch_serial = 0
        self.snapshot = self._enter(opened.first, opened.open(opened.first))

    @property
    def allowed(self) -> bool:
        """Whether pictures may go where the ranker is."""
        return self.consent is not None or not self.opened.sends_to

    @property
    def generation(self) -> int:
        """Counts the openings, so that late messages of an earlier one are dropped."""
        return self._generation

    def change(self, **fields: Any) -> None:
        """Replace fields of the snapshot."""
        self.snapshot = replace(self.snapshot, **fields)

    def say(self, text: str, *, fault: bool = False) -> None:
        """Tell the person something once."""
        self.change(notice=Notice(text, fault, self.snapshot.notice.serial + 1))

    def stumbled(self, problem: str) -> None:
        """A task ended in a way that nobody foresaw: nothing on the page waits for it any longer.

        Which task it was is not known, so all that wait are let go; an answer that comes after
        all is taken as one that was cancelled.
        """
        self.asked.clear()
        self.out.clear()
        self.commit_when_answered = False
        turning = {
            name: replace(state, stage="ready")
            for name, state in self.snapshot.turning.items()
            if state.stage != "measuring"
        }
        self.let_go("No answer came")
        self.change(working="", playing="", turning=turning)
        self.say(problem, fault=True)

    def let_go(self, why: str) -> None:
        """Wait no longer for the question that is out: the page says why and offers what helps."""
        asking = self.snapshot.asking
        if asking is not None:
            self.asked.discard(asking.branch_id)
            self.change(asking=None)
            self.leave(asking.branch_id, why)

    def leave(self, branch_id: str, why: str) -> None:
        """Nobody answers the pending question of a branch, until it is asked again."""
        self.change(let_go={**self.snapshot.let_go, branch_id: why})

    def taken_up(self, branch_id: str) -> None:
        """The pending question of a branch is out, answered or committed again."""
        self.change(let_go={b: why for b, why in self.snapshot.let_go.items() if b != branch_id})

    def reopen(self, choice: Choice) -> None:
        """Open another entry, variant or ranker in place of what is open.

        Raises:
            C2NavError: When that cannot be opened; what is open goes on.
        """
        opening = self.opened.open(choice)
        for run in self.runs.values():
            run.close()
        self.runs.clear()
        kept = self.snapshot
        fresh = self._enter(choice, opening)
        self.snapshot = replace(fresh, version=kept.version, view=kept.view, who=kept.who)

    def _enter(self, choice: Choice, opening: Opening) -> Snapshot:
        self._generation += 1
        self.branches.clear()
        self.stories.clear()
        self.album.clear()
        self.asked.clear()
        self.scene = None
        self.sight = None
        self.commit_when_answered = False
        self.shelf.clear()
        branch = self._root(opening)
        problem = self.shelf.put(branch, choice.entry_id)
        if opening.run is not None:
            self.runs[branch.branch_id] = opening.run
        self._read(branch)
        if opening.scene is not None:
            self._fetch(opening.scene)
        self.assessor = assessor_of(opening)
        self.floor = opening.floor
        self.world = opening.world
        self.viewpoints = opening.viewpoints
        self._leave_searches()
        return Snapshot(
            version=0,
            chooser=Chooser(
                self.opened.title,
                self.opened.entries,
                choice,
                variants=self.opened.variants,
                rankers=self.opened.rankers,
            ),
            branches=(branch,),
            branch=branch,
            story=self.stories[branch.branch_id],
            stop=0,
            view=View(blind=self.opened.blind),
            reviews={branch.branch_id: self._reviews(branch.branch_id)},
            tags=self.shelf.tags(branch.branch_id),
            notice=Notice(problem, fault=True, serial=1) if problem else Notice(),
            no_scene=opening.no_scene,
            reasked=opening.reasked,
        )

    def _leave_searches(self) -> None:
        for search in self.searches.values():
            search.cancelled.set()
        self.searches.clear()

    def _root(self, opening: Opening) -> Branch:
        run = opening.run
        return Branch(
            branch_id=self.new_branch_id(),
            origin=Origin.RECORDED if run is None else Origin.LIVE,
            header=opening.header,
            exchanges=tuple(opening.exchanges if run is None else run.exchanges),
            pending=None if run is None else run.pending,
            footer=opening.footer if run is None else run.footer,
            trace_sha256=opening.trace_sha256,
            source=opening.source,
            trace=opening.trace if run is None else run.trace,
        )

    def new_branch_id(self) -> str:
        """A name that no branch of this session had."""
        self._branch_serial += 1
        return f"b{self._branch_serial - 1}"

    def _fetch(self, load: Callable[[], Scene]) -> None:
        generation = self._generation

        def task() -> Message:
            self.hands.after_page()
            try:
                scene = load()
            except C2NavError as error:
                problem = str(error)
                return lambda desk: desk.take_scene(generation, None, problem)
            return lambda desk: desk.take_scene(generation, scene, "")

        self.hands.background(task)

    def take_scene(self, generation: int, scene: Scene | None, problem: str) -> None:
        """The scene came, or could not be loaded."""
        if generation != self._generation:
            return
        self.scene = scene
        self.change(no_scene=problem, scene_serial=self.snapshot.scene_serial + 1)

    # ------------------------------------------------------------ branches

    def _read(self, branch: Branch) -> None:
        self.branches[branch.branch_id] = branch
        self.album.take(branch.branch_id, branch.exchanges, branch.pending)
        self.stories[branch.branch_id] = story_of(
            branch.header, branch.exchanges, pending=branch.pending, footer=branch.footer
        )

    def _reviews(self, branch_id: str) -> Reviews:
        return self.shelf.reviews(branch_id, self.stories[branch_id])

    def reread(self, branch_id: str) -> None:
        """Show what is said of a branch now."""
        reviews = {**self.snapshot.reviews, branch_id: self._reviews(branch_id)}
        self.change(reviews=reviews, tags=self.shelf.tags(branch_id))

    def put(self, branch: Branch) -> None:
        """Add a branch or replace an older state of it."""
        self._read(branch)
        problem = self.shelf.put(branch, self.snapshot.chooser.choice.entry_id)
        if problem:
            self.say(problem, fault=True)
        fields: dict[str, Any] = {"branches": tuple(self.branches.values())}
        if self.snapshot.branch.branch_id == branch.branch_id:
            story = self.stories[branch.branch_id]
            fields |= {"branch": branch, "story": story, "parent": self.stories.get(branch.parent)}
            fields["stop"] = min(self.snapshot.stop, len(story.stops) - 1)
        self.change(**fields)
        self.assess(branch.branch_id)

    def assess(self, branch_id: str) -> None:
        """Measure what was decided since, in the background; one task at a time."""
        assessor = self.assessor
        if assessor is None or self.assessing:
            return
        generation, story = self._generation, self.stories[branch_id]
        known = dict(self.snapshot.assessed.get(branch_id, {}))
        if sum(not decision.pending for decision in story.decisions) == len(known):
            return
        self.assessing = True

        def task() -> Message:
            self.hands.after_scene()
            fresh = assessor.assess(story, known)
            return lambda desk: desk.take_assessed(generation, branch_id, known | fresh)

        self.hands.background(task)

    def take_assessed(
        self, generation: int, branch_id: str, assessments: dict[int, Assessment]
    ) -> None:
        """What the truth says of a branch came."""
        self.assessing = False
        if generation != self._generation:
            return
        known = self.snapshot.assessed.get(branch_id)
        grown = known is None or len(assessments) > len(known)
        if grown:
            self.change(assessed={**self.snapshot.assessed, branch_id: assessments})
            self.assess(self.snapshot.branch.branch_id)

    def stand(self, stop: int, branch_id: str = "") -> None:
        """Stand at a stop of a branch; an unfinished ranking of another decision is dropped."""
        branch = self.branches[branch_id or self.snapshot.branch.branch_id]
        story = self.stories[branch.branch_id]
        stop = max(0, min(stop, len(story.stops) - 1))
        before = self.snapshot
        self.change(branch=branch, story=story, stop=stop, parent=self.stories.get(branch.parent))
        if self.snapshot.token != before.token:
            self.change(draft=Draft(), why="", offer=None)

    @property
    def at_frontier(self) -> bool:
        """Whether the decision in view is the one that waits for an answer."""
        decision = self.snapshot.decision
        return decision is not None and decision.pending

    @property
    def run(self) -> Run | None:
        """The live episode of the branch in view."""
        return self.runs.get(self.snapshot.branch.branch_id)

    def waiting(self, branch_id: str) -> Ask | None:
        """The question a branch waits for."""
        pending = self.branches[branch_id].pending
        return pending if isinstance(pending, Ask) else None
