"""The snapshot as JSON sections: `GET /api/state` sends all, the event stream what changed."""

from __future__ import annotations

from typing import Any

from app.session.branches import Origin, ended_words
from app.session.cards import decision_json, lookback_json
from app.session.decisions import Decision
from app.session.driving import HUMAN
from app.session.route_text import route_segments
from app.session.snapshot import LAYERS_AT_FIRST, Judgement, Snapshot
from app.session.timeline import Timelines

Json = dict[str, Any]

SCHEMA = 1


def state_json(snapshot: Snapshot, timelines: Timelines | None = None) -> Json:
    """Everything that the page's own elements draw.

    Args:
        snapshot: What to draw.
        timelines: Those of earlier snapshots, so that one that is still right is not made again.
    """
    decision = snapshot.decision
    return {
        "schema": SCHEMA,
        "id": snapshot.token,
        "version": snapshot.version,
        "episode": _episode(snapshot, decision),
        "decision": decision_json(snapshot),
        "lookback": lookback_json(snapshot),
        "pending": decision is not None and decision.pending,
        "place": {
            "step": snapshot.here.step,
            "decision": snapshot.here.decision,
            "at_decision": snapshot.here.at_decision,
            "stop": snapshot.stop,
            "stops": len(snapshot.story.stops),
        },
        "glimpse": _glimpse(snapshot),
        "branch": _branch(snapshot),
        "branches": [
            {"id": b.branch_id, "origin": b.origin, "fork": b.fork_decision, "parent": b.parent}
            for b in snapshot.branches
        ],
        "draft": {
            "tiers": snapshot.draft.tiers,
            "none": snapshot.draft.none,
            "tie_next": snapshot.draft.tie_next,
        },
        "asking": _asking(snapshot),
        "let_go": _let_go(snapshot),
        "offer": _offer(snapshot),
        "playing": snapshot.playing,
        "view": {
            "camera": snapshot.view.camera,
            "layers": sorted(snapshot.view.layers),
            "layers_at_first": sorted(LAYERS_AT_FIRST),
            "hovered": snapshot.view.hovered,
            "blind": snapshot.view.blind,
        },
        "covered": snapshot.covered,
        "timeline": (timelines or Timelines()).of(snapshot),
        "judgement": _judgement(snapshot),
        "notice": {
            "text": snapshot.notice.text,
            "fault": snapshot.notice.fault,
            "serial": snapshot.notice.serial,
        },
        "driver": snapshot.driver,
        "who": snapshot.who,
        "working": snapshot.working,
        "consent_to": snapshot.consent_to,
        "licence": snapshot.story.header.scene_licence,
        "no_scene": snapshot.no_scene,
    }


def _episode(snapshot: Snapshot, decision: Decision | None) -> Json:
    header = snapshot.story.header
    episode = header.episode
    return {
        "id": episode.episode_id,
        "scene": episode.scene_id,
        "title": snapshot.chooser.title,
        "instruction": episode.instruction,
        "segments": route_segments(episode.instruction, header.legs),
        "legs": len(header.legs),
        "leg": decision.facts.leg if decision else 0,
        "variant": header.variant,
        "profile": header.profile.name,
        "ranker": header.ranker,
        "privileged": header.privileged,
        "seed": header.seed,
    }


def _glimpse(snapshot: Snapshot) -> Json | None:
    """The newest recorded view here, for steps between decisions."""
    glimpse = snapshot.story.track.glimpse_at(snapshot.here.step)
    if glimpse is None:
        return None
    front = min(glimpse.seen.views, key=lambda view: abs(view.offset_rad))
    return {"step": glimpse.step, "sha": front.picture.sha256}


def _branch(snapshot: Snapshot) -> Json:
    branch = snapshot.branch
    return {
        "id": branch.branch_id,
        "origin": branch.origin,
        "label": branch_label(snapshot),
        "differs": branch.origin is Origin.FORK,
        "fork": branch.fork_decision,
        "recipe": bool(branch.trace_sha256),
        "running": branch.running,
        "ended": ended_words(branch.footer) if branch.footer else "",
        "decisions": sum(1 for d in snapshot.story.decisions if not d.pending),
    }


def branch_label(snapshot: Snapshot) -> str:
    """What the banner says."""
    branch = snapshot.branch
    how = "live" if branch.running else ended_words(branch.footer)
    if snapshot.view.blind:
        return f"blind · the answer is {'covered' if snapshot.covered else 'shown'}"
    match branch.origin:
        case Origin.RECORDED:
            return f"recorded · {how}"
        case Origin.LIVE:
            return "live" if branch.running else how
        case Origin.FORK:
            return f"override at decision {branch.fork_decision} · {how}"


def _asking(snapshot: Snapshot) -> Json | None:
    asking = snapshot.asking
    if asking is None:
        return None
    return {
        "branch": asking.branch_id,
        "decision": asking.decision,
        "since_s": asking.since_s,
        "queries": asking.queries,
        "answered": asking.answered,
        "usual_s": asking.usual_s,
        "ranker": snapshot.story.header.ranker,
    }


def _let_go(snapshot: Snapshot) -> str:
    """Why nobody answers the pending decision in view; "" where somebody does, or nobody should."""
    decision, branch_id = snapshot.decision, snapshot.branch.branch_id
    waits = decision is not None and decision.pending and snapshot.proposal is None
    if not waits or snapshot.covered or snapshot.asking or snapshot.consent_to:
        return ""
    if snapshot.story.header.ranker == HUMAN:
        return ""
    return snapshot.let_go.get(branch_id, "Not asked yet")


def _offer(snapshot: Snapshot) -> Json | None:
    offer = snapshot.offer
    if offer is None:
        return None
    return {
        "decision": offer.decision,
        "decisions": offer.decisions,
        "queries": offer.queries,
        "seconds": round(offer.seconds, 1),
        "dollars": round(offer.dollars, 2),
    }


def _judgement(snapshot: Snapshot) -> Json:
    judgement = snapshot.judgements.get(snapshot.here.decision, Judgement())
    return {
        "verdict": judgement.verdict,
        "better": judgement.better,
        "tags": judgement.tags,
        "flagged": judgement.flagged,
        "note": judgement.note,
        "blind": judgement.blind,
    }
