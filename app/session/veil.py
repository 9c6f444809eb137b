"""Judging blind in the inspector: what is drawn is a story that ends where the answer would begin.

Hiding an answer view by view would leak with the first view that forgets. Here every view draws
the branch cut off before the covered answer, as if the model had still to be asked: what is not
in the story can be on no card, curve, map or list.
"""

from __future__ import annotations

import math
from dataclasses import replace

from app.session.reasked import NOTHING
from app.session.snapshot import Snapshot
from app.session.story import Story, story_of

_TRUTH = frozenset(("goal", "reference"))
"""Layers that tell the goal or the way to it."""


def covered(snapshot: Snapshot) -> bool:
    """Whether the answer of the decision in view is to be covered."""
    decision, here = snapshot.decision, snapshot.here
    return (
        snapshot.view.blind
        and here.at_decision
        and decision is not None
        and decision.question is not None
        and (snapshot.branch.branch_id, decision.number) not in snapshot.revealed
    )


def veiled(snapshot: Snapshot) -> Snapshot:
    """The snapshot as it may be drawn: nothing after the place in view, nothing covered, no truth.

    Without `view.blind` it is the snapshot itself.
    """
    if not snapshot.view.blind:
        return snapshot
    hides = covered(snapshot)
    branch, story, here = snapshot.branch, snapshot.story, snapshot.here
    kept = story.decisions[here.decision].exchange if hides else story.end_of(here.decision)
    over = not hides and kept == story.length
    pending = branch.pending if kept == story.length else None
    if hides and pending is None:
        pending = branch.exchanges[kept].request
    cut = replace(
        branch,
        exchanges=branch.exchanges[:kept],
        pending=pending,
        footer=branch.footer if over else None,
        # What it left is not drawn: its answers are the covered ones up to the fork.
        parent="",
    )
    shortened = _without_truth(
        story_of(cut.header, cut.exchanges, pending=pending, footer=cut.footer)
    )
    reviews = {
        place: said
        for place, said in snapshot.reviews.get(branch.branch_id, {}).items()
        if place[1] < here.decision or (place[0] == snapshot.who and place[1] == here.decision)
    }
    unsaid = tuple(replace(e, outcome="", success=None) for e in snapshot.chooser.entries)
    return replace(
        snapshot,
        chooser=replace(snapshot.chooser, entries=unsaid),
        branches=(cut,),
        branch=cut,
        story=shortened,
        stop=min(snapshot.stop, len(shortened.stops) - 1),
        proposals={} if hides else snapshot.proposals,
        parent=None,
        place=None,
        assessed={},
        view=replace(snapshot.view, layers=snapshot.view.layers - _TRUTH),
        reasked=NOTHING,
        turning={},
        reviews={branch.branch_id: reviews},
        covered=hides,
    )


def _without_truth(story: Story) -> Story:
    """How far the goal is would tell whether the last answers were good."""
    footsteps = tuple(replace(one, distance_m=math.nan) for one in story.track.footsteps)
    return replace(story, track=replace(story.track, footsteps=footsteps))


def answers_shown(drawn: Snapshot) -> int:
    """How many decisions, from 0, show their answer in what is drawn."""
    made = sum(not decision.pending for decision in drawn.story.decisions)
    return made + (drawn.branch.branch_id in drawn.proposals and drawn.story.pending is not None)
