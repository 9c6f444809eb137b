"""A family of runs as the page's data: what the inspector would show, at every place to stand."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from app.exports.asked import asked_json
from app.exports.family import Member
from app.exports.licence import licence_words
from app.figures.plan import Plan
from app.session.branches import cost_of, ended_words
from app.session.cards import decision_json, lookback_json
from app.session.decisions import Decision
from app.session.opened import Choice
from app.session.snapshot import Assessment, Chooser, Snapshot
from app.session.state_json import state_json
from app.session.story import Story
from app.session.wording import plural, seconds
from c2nav_engine.contract.question import Slot
from c2nav_engine.geometry import Pose

Json = dict[str, Any]

SCHEMA = 1


Assessed = Mapping[str, Mapping[int, Assessment]]
"""Digest of a trace → decision → what the truth says of it."""


def tale_of(members: Sequence[Member], plan: Plan, assessed: Assessed | None = None) -> Json:
    """Everything that the page draws, apart from pictures and the 3-D view."""
    pages = [_Member(member, members, assessed or {}) for member in members]
    return {
        "schema": SCHEMA,
        "title": title_of(members[0].story),
        "licence": licence_words(members[0].story.header),
        "branches": [page.told() for page in pages],
        "map": _map(members, plan),
    }


def title_of(story: Story) -> str:
    """Episode, variant and ranker."""
    header = story.header
    return f"episode {header.episode.episode_id} · {header.variant} · {header.ranker}"


class _Member:
    """One branch among its family."""

    def __init__(self, member: Member, members: Sequence[Member], assessed: Assessed) -> None:
        stories = {each.branch.branch_id: each.story for each in members}
        branch = member.branch
        self._member = member
        self._whole = Snapshot(
            version=0,
            chooser=Chooser(title_of(member.story), (), Choice("")),
            branches=tuple(each.branch for each in members),
            branch=branch,
            story=member.story,
            stop=0,
            parent=stories.get(branch.parent),
            assessed={branch.branch_id: dict(assessed.get(branch.trace_sha256, {}))},
        )

    def told(self) -> Json:
        """The branch as the page's elements take it, at every decision and every step."""
        member, story, branch = self._member, self._member.story, self._member.branch
        first = state_json(self._whole)
        return {
            **{name: first[name] for name in ("episode", "branch", "timeline")},
            "stops": [[stop.step, stop.decision, stop.at_decision] for stop in story.stops],
            "decisions": [self._decision(decision) for decision in story.decisions],
            "track": [_placed(footstep.pose) for footstep in story.track.footsteps],
            "sketches": [_sketch(index, story) for index in range(len(story.sketches))],
            "ladders": [_ladder(index, story) for index in range(len(story.ladders))],
            "suspects": [_suspect(each) for each in self._whole.suspects],
            "facts": _facts(member.story),
            "ended": ended_words(branch.footer),
            "success": bool(branch.footer and branch.footer.metrics.get("success")),
            "source": branch.source,
            "sha256": branch.trace_sha256,
        }

    def _decision(self, decision: Decision) -> Json:
        stop = self._member.story.stop_of_decision(decision.number)
        snapshot = replace(self._whole, stop=stop)
        return {
            "decision": decision_json(snapshot),
            "lookback": lookback_json(snapshot) if decision.slot is Slot.LOOKBACK else None,
            **asked_json(self._member, decision),
        }


def _placed(pose: Pose) -> list[float]:
    x, y, z = pose.position_m
    return [round(x, 3), round(y, 3), round(z, 3), round(pose.yaw_rad, 4)]


def _suspect(assessment: Assessment) -> Json:
    regret_m = assessment.regret_m
    words = [f"+{regret_m:.1f} m"] if regret_m else []
    words += [assessment.words] if assessment.words else []
    return {"decision": assessment.decision, "words": " · ".join(words)}


def _decision_before(exchange: int, story: Story) -> int:
    """The last decision at or before an exchange."""
    return max((d.number for d in story.decisions if d.exchange <= exchange), default=0)


def _sketch(index: int, story: Story) -> Json:
    exchange, sketch = story.sketches[index]
    entry = sketch.entry
    return {
        "decision": _decision_before(exchange, story),
        "cycle": entry.cycle,
        "words": entry.words,
        "turning": entry.turning,
        "cue": entry.cue,
        "rendering": sketch.rendering,
        "gate": sketch.gate_open,
        "support": sketch.support,
        "advanced": sketch.advanced,
    }


def _ladder(index: int, story: Story) -> Json:
    exchange, ladder = story.ladders[index]
    number = _decision_before(exchange, story)
    return {
        "decision": number,
        "step": story.decisions[number].step if story.decisions else 0,
        "cycle": ladder.cycle,
        "ground": ladder.ground,
        "journey": ladder.journey,
        "lookback": ladder.lookback,
        "verdict": ladder.verdict,
        "vetoes": list(ladder.vetoes),
        "budget": ladder.budget,
        "markers": len(ladder.markers),
        "event": ladder.event,
    }


def _facts(story: Story) -> list[tuple[str, str]]:
    """What a reader asks first about a run."""
    header, cost = story.header, cost_of(story.decisions)
    metrics = dict(story.footer.metrics) if story.footer else {}
    spent = [plural(cost.queries, "query"), seconds(cost.seconds)]
    if cost.tokens:
        spent.insert(1, plural(cost.tokens, "token"))
    rows = [
        ("scene", header.episode.scene_id),
        ("variant", header.variant),
        ("ranker", f"{header.ranker}{' · privileged' if header.privileged else ''}"),
        ("profile", header.profile.name),
        ("seed", str(header.seed)),
        ("legs by", header.parser),
        ("decisions", str(cost.decisions)),
        ("cost", ", ".join(spent)),
        ("NE", _number(metrics.get("ne_m"), " m")),
        ("SPL", _number(metrics.get("spl"))),
        ("nDTW", _number(metrics.get("ndtw"))),
        ("path", _number(metrics.get("path_length_m"), " m")),
        ("steps", _number(metrics.get("steps"), digits=0)),
        ("collisions", _number(metrics.get("collisions"), digits=0)),
        ("code", header.code_version),
    ]
    return [row for row in rows if row[1]]


def _number(value: float | None, unit: str = "", *, digits: int = 2) -> str:
    if value is None or not math.isfinite(value):
        return ""
    return f"{value:.{digits}f}{unit}"


def _map(members: Sequence[Member], plan: Plan) -> Json:
    episode = members[0].story.header.episode
    return {
        "floor": plan.floor,
        "walls": plan.walls,
        "goal": None if episode.goal_m is None else list(episode.goal_m),
        "radius": episode.goal_radius_m,
        "reference": [list(point) for point in episode.reference_path_m],
    }
