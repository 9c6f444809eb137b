"""Arriving's evidence ladder: e, the verdict, vetoes, markers."""

from __future__ import annotations

import viser
from markupsafe import Markup

from app.inspector import markup as m
from app.inspector.panels.protocol import Dispatch, Html, Update
from app.session.decisions import LANES
from app.session.snapshot import Snapshot
from c2nav_engine.navigator.requests import LadderState

_SIGNS = {-1: "− against", 0: "0 open", 1: "+ for stopping"}


def build(gui: viser.GuiApi, _dispatch: Dispatch) -> Update:
    """Build the panel."""
    block = Html(gui)
    return lambda snapshot: block.show(_block(snapshot))


def ladders_in_view(snapshot: Snapshot) -> list[LadderState]:
    """Every reading of the ladder up to what is in view, oldest first."""
    decision = snapshot.decision
    until = snapshot.story.length
    if decision is not None:
        until = snapshot.story.end_of(decision.number)
    return [ladder for index, ladder in snapshot.story.ladders if index <= until]


def _block(snapshot: Snapshot) -> str:
    ladders = ladders_in_view(snapshot)
    if not ladders:
        decision = snapshot.decision
        asked = decision is not None and decision.lane == LANES.index("Arriving")
        return m.padded(
            m.note(
                "The first reading stands here once this question is answered"
                if asked
                else "Arriving is asked in the last leg, once enough of the route is travelled"
            )
        )
    last = ladders[-1]
    return m.padded(
        m.heading("Evidence"),
        _evidence(last),
        m.facts(
            [
                ("verdict", Markup("<b>{}</b>").format(last.verdict)),
                ("vetoes", m.fault(", ".join(last.vetoes)) if last.vetoes else "none"),
                ("look-backs left", str(last.budget)),
                ("event", last.event),
            ]
        ),
        m.heading("Walk-back markers"),
        m.table(
            ["cycle", "score", "path"],
            [[str(k.cycle), f"{k.score:+d}", f"{k.path_m:.1f} m"] for k in last.markers],
        )
        if last.markers
        else m.note("None held"),
        m.heading("Readings, newest first"),
        m.table(
            ["cycle", "ground", "journey", "look-back", "verdict", "event"],
            [
                [
                    str(k.cycle),
                    _signed(k.ground),
                    _signed(k.journey),
                    _signed(k.lookback),
                    k.verdict,
                    k.event,
                ]
                for k in reversed(ladders)
            ],
        ),
    )


def _evidence(ladder: LadderState) -> Markup:
    rows = (("ground", ladder.ground), ("journey", ladder.journey), ("look-back", ladder.lookback))
    return Markup('<ol class="c2-evidence">{}</ol>').format(
        m.join(
            Markup('<li data-value="{}"><span>{}</span><b>{}</b></li>').format(
                value, name, _SIGNS[value]
            )
            for name, value in rows
        )
    )


def _signed(value: int) -> str:
    return f"{value:+d}".replace("+0", "0").replace("-", "−")
