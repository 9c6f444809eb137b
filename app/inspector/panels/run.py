"""What runs, and the controls to go through it."""

from __future__ import annotations

import viser
from markupsafe import Markup

from app.inspector import markup as m
from app.inspector.panels import entries
from app.inspector.panels.controls import Picker, Stepper
from app.inspector.panels.protocol import Dispatch, Html, Update
from app.session import commands as c
from app.session.branches import cost_of
from app.session.decisions import LANES
from app.session.snapshot import SUSPECT_M, Assessment, Snapshot
from app.session.wording import SIGNS, plural, seconds


def build(gui: viser.GuiApi, dispatch: Dispatch) -> Update:
    """Build the panel."""
    entry = Picker(gui, "episode", lambda chosen: dispatch(c.Open(entry=chosen)))
    variant = Picker(gui, "variant", lambda chosen: dispatch(c.Open(variant=chosen)))
    ranker = Picker(gui, "ranker", lambda chosen: dispatch(c.Open(ranker=chosen)))
    stepper = Stepper(gui, dispatch)
    block = Html(gui)
    choose = entries.build(gui, dispatch)

    def update(snapshot: Snapshot) -> None:
        chooser = snapshot.chooser
        entry.show({e.entry_id: e.label for e in chooser.entries}, chooser.choice.entry_id)
        variant.show({v: v for v in chooser.variants}, chooser.choice.variant)
        ranker.show({r: r for r in chooser.rankers}, chooser.choice.ranker)
        stepper.show(snapshot.here.step, snapshot.story.track.last_step)
        block.show(_block(snapshot))
        choose(snapshot)

    return update


def _block(snapshot: Snapshot) -> str:
    header = snapshot.story.header
    cost = cost_of(snapshot.story.decisions)
    return m.padded(
        _transport(snapshot),
        m.heading(_suspects_head(len(snapshot.suspects))),
        _suspects(snapshot),
        Markup('<div class="c2-buttons c2-small">{}</div>').format(
            m.action("Was the goal in view?", c.Place(goal=True))
        ),
        m.heading("This run"),
        m.facts(
            [
                ("variant", header.variant),
                ("ranker", f"{header.ranker}{' · privileged' if header.privileged else ''}"),
                ("profile", header.profile.name),
                ("seed", str(header.seed)),
                ("legs by", header.parser),
                ("so far", plural(cost.decisions, "decision")),
                ("", _spent(snapshot)),
                ("path", f"{snapshot.story.track.path_length_m(snapshot.here.step):.1f} m"),
            ]
        ),
    )


def _transport(snapshot: Snapshot) -> Markup:
    """The buttons to go through a run; the palette and the keys do the same."""
    playing = bool(snapshot.playing)
    turn = m.action("Pause", c.Pause()) if playing else m.action("Play", c.Play())
    first = [
        m.action("◀", c.Move(by="decision", count=-1), title="previous decision (P)"),
        m.action("Step", c.Step(), title="commit, or go to the next decision", primary=True),
        turn,
    ]
    second = [
        m.action(f"{sign} {lane}", _run_to(lane), pressed=snapshot.playing == lane.lower())
        for sign, lane in zip(SIGNS, LANES, strict=True)
    ]
    second.append(m.action("end", c.RunTo(until="end"), pressed=snapshot.playing == "end"))
    return m.join(
        [
            Markup('<div class="c2-buttons">{}</div>').format(m.join(first)),
            m.heading("Run to the next"),
            Markup('<div class="c2-buttons c2-small">{}</div>').format(m.join(second)),
        ]
    )


def _run_to(lane: str) -> c.RunTo:
    return c.RunTo.model_validate({"until": lane.lower()})


def _spent(snapshot: Snapshot) -> str:
    cost = cost_of(snapshot.story.decisions)
    words = [plural(cost.queries, "query"), seconds(cost.seconds)]
    if cost.tokens:
        words.insert(1, plural(cost.tokens, "token"))
    if cost.dollars:
        words.append(f"${cost.dollars:.2f}")
    return ", ".join(words)


def _suspects_head(count: int) -> str:
    """A list that scrolls shows fewer than it holds, so it says how many."""
    return f"{plural(count, 'suspect')}, worst first" if count else "Suspects, worst first"


def _suspects(snapshot: Snapshot) -> Markup:
    """All of them, the worst in view, each with what is said of it on a line of its own."""
    if not snapshot.suspects:
        return m.note(snapshot.no_suspects)
    lines = [_suspect(snapshot, suspect) for suspect in snapshot.suspects]
    return Markup('<ol class="c2-suspects" tabindex="0">{}</ol>').format(m.join(lines))


def _suspect(snapshot: Snapshot, suspect: Assessment) -> Markup:
    decision = snapshot.story.decisions[suspect.decision]
    regret_m = suspect.regret_m or 0.0
    return Markup("<li>{}<span>{}</span><b>{}</b><small>{}</small></li>").format(
        m.action(f"decision {suspect.decision}", c.Go(decision=suspect.decision)),
        f"{SIGNS[decision.lane]} {LANES[decision.lane]}",
        f"+{regret_m:.1f} m" if regret_m >= SUSPECT_M else "",
        suspect.words,
    )
