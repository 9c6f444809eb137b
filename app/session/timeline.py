"""The timeline: lanes of decisions, events and the distance to the goal, by low-level step."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

from app.session.decisions import Decision
from app.session.differing import reasked_differ
from app.session.snapshot import SUSPECT_M, WHOLE, Judgement, Snapshot
from app.session.story import Story
from app.session.turning_state import flip_words
from app.session.wording import is_fault, outcome_words, slot_words
from c2nav_engine.contract.outcome import Ordering
from c2nav_engine.episodes.episode import Episode
from c2nav_engine.experiments.turning.flips import TURNING, UNSTABLE, Flip

Json = dict[str, Any]

_SIGNS = {"fallback": "✕", "stalled": "✕", "glance": "↻", "walk-back": "↩"}


class Timelines:
    """The newest timeline, made anew only where what it shows has changed.

    Scrubbing over hundreds of decisions changes nothing in it but the place where one stands,
    which is no part of it.
    """

    def __init__(self) -> None:
        """Nothing is made yet."""
        self._newest: tuple[tuple[object, ...], Json] = ((), {})

    def of(self, snapshot: Snapshot) -> Json:
        """The same as `timeline_of`, and the same object while nothing in it has changed."""
        shown, timeline = self._newest
        now = _shown(snapshot)
        if len(shown) != len(now) or any(a is not b for a, b in zip(shown, now, strict=True)):
            timeline = timeline_of(snapshot)
            self._newest = (now, timeline)
        return timeline


def _shown(snapshot: Snapshot) -> tuple[object, ...]:
    """Every part of a snapshot that its timeline is made of; snapshots share what is the same."""
    return (
        snapshot.story,
        snapshot.parent,
        snapshot.branch,
        snapshot.branches,
        snapshot.who,
        snapshot.reviews,
        snapshot.place,
        snapshot.assessed,
        snapshot.reasked,
        snapshot.turning,
        snapshot.view.blind,
    )


def timeline_of(snapshot: Snapshot) -> Json:
    """Everything that `<timeline-bar>` draws; a fork's parent is drawn as a ghost."""
    story, parent = snapshot.story, snapshot.parent
    steps = story.track.last_step
    if parent is not None:
        steps = max(steps, parent.track.last_step)
    return {
        "steps": steps,
        "last": story.track.last_step,
        "band_m": _band_m(story.header.episode),
        "curve": _curve(story),
        "ghost": None if parent is None else {"curve": _curve(parent), "marks": _marks(parent)},
        "marks": _marks(story),
        "events": [
            *_events(story),
            *_people(story, snapshot.judgements),
            *_reasked(snapshot),
            *_turning(snapshot),
        ],
        "legs": _legs(story),
        "leg_ends": _leg_ends(snapshot.judgements),
        "place": _place(snapshot),
        "regret": [
            {"decision": s.decision, "step": story.decisions[s.decision].step, "m": s.regret_m}
            for s in snapshot.assessments.values()
            if s.regret_m is not None and s.regret_m >= SUSPECT_M
        ],
    }


def _band_m(episode: Episode) -> float:
    return episode.goal_radius_m


def _curve(story: Story) -> list[list[float]]:
    return [
        [footstep.step, round(footstep.distance_m, 2)]
        for footstep in story.track.footsteps
        if math.isfinite(footstep.distance_m)
    ]


def _marks(story: Story) -> list[Json]:
    return [_mark(decision) for decision in story.decisions]


def _mark(decision: Decision) -> Json:
    words = outcome_words(decision.outcome, decision.letters) if decision.outcome else ""
    if decision.pending:
        words = "waits for an answer"
    elif decision.question is None:
        words = "one view left" if decision.elected else "no view left"
    return {
        "lane": decision.lane,
        "step": decision.step,
        "decision": decision.number,
        "pending": decision.pending,
        "fault": is_fault(decision.outcome),
        "open": decision.outcome is not None and not isinstance(decision.outcome, Ordering),
        "words": f"decision {decision.number} · {slot_words(decision.slot)} · {words}",
    }


def _events(story: Story) -> list[Json]:
    return [
        {
            "sign": _SIGNS.get(event.name, "•"),
            "step": step,
            "fault": _SIGNS.get(event.name) == "✕",
            "words": f"{event.name}: {event.detail}" if event.detail else event.name,
        }
        for _, step, event in story.events
    ]


def _people(story: Story, judgements: dict[int, Judgement]) -> list[Json]:
    overrides = [
        {"sign": "◆", "step": d.step, "fault": False, "words": f"override at decision {d.number}"}
        for d in story.decisions
        if d.override is not None
    ]
    reviews = [
        {
            "sign": "✓",
            "step": story.decisions[number].step,
            "fault": False,
            "words": f"reviewed: {judgement.verdict or 'noted'}",
        }
        for number, judgement in sorted(judgements.items())
        if 0 <= number < len(story.decisions)
    ]
    return [*overrides, *reviews]


def _reasked(snapshot: Snapshot) -> list[Json]:
    """Where a re-evaluation elects something else than the recording."""
    found: list[Json] = []
    for decision in snapshot.story.decisions:
        others = reasked_differ(decision, snapshot.reasked_at(decision.number))
        if others:
            rankers = ", ".join(dict.fromkeys(answer.ranker for answer in others))
            words = f"asked again at decision {decision.number}: {rankers} differs"
            found.append({"sign": "≠", "step": decision.step, "fault": False, "words": words})
    return found


def _turning(snapshot: Snapshot) -> list[Json]:
    """Turning points of the branch in view; a click opens the branch of the other answer."""
    state = snapshot.turning_here
    if state is None:
        return []
    steps = {decision.number: decision.step for decision in snapshot.story.decisions}
    found: list[Json] = []
    if state.recoverable is not None and state.recoverable.decision is not None:
        number = state.recoverable.decision
        words = f"decision {number} · last recoverable, for a noiseless observer · privileged"
        found.append({"sign": "⇥", "step": steps[number], "fault": False, "words": words})
    for flip in _marked(state.flips):
        found.append(
            {
                "sign": "★" if flip.verdict == TURNING else "☆",
                "step": steps[flip.decision],
                "fault": False,
                "words": flip_words(flip),
                "opens": {"decision": flip.decision, "answer": flip.answer},
            }
        )
    return found


def _marked(flips: Sequence[Flip]) -> Iterable[Flip]:
    """One a decision: its first turning point, else the first answer that was unstable."""
    by_decision: dict[int, Flip] = {}
    for verdict in (TURNING, UNSTABLE):
        for flip in flips:
            if flip.verdict == verdict:
                by_decision.setdefault(flip.decision, flip)
    return by_decision.values()


def _leg_ends(judgements: dict[int, Judgement]) -> list[Json]:
    """Where the person at the page says that legs end."""
    whole = judgements.get(WHOLE, Judgement())
    return [{"leg": leg, "step": step} for leg, step in sorted(whole.leg_ends.items())]


def _place(snapshot: Snapshot) -> Json | None:
    """The lane of an asked place."""
    place = snapshot.place
    if place is None:
        return None
    return {
        "basis": place.basis,
        "looks": [{"step": s.step, "status": s.status} for s in place.sightings],
    }


def _legs(story: Story) -> list[Json]:
    """Where each leg begins, by the decisions that were taken in it."""
    starts: dict[int, int] = {}
    for decision in story.decisions:
        starts.setdefault(decision.facts.leg, decision.step)
    return [{"leg": leg, "step": step} for leg, step in sorted(starts.items())]
