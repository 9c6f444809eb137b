"""Every action in viser's command palette, with its key beside it.

The keys themselves are handled by the page's script: viser runs callbacks in parallel and in no
order, which a ranking pressed as 2, 1, 3 would not survive.
"""

from __future__ import annotations

import viser

from app.inspector.panels.protocol import Dispatch
from app.session import commands as c
from app.session.commands import Command

ACTIONS: tuple[tuple[str, str, Command], ...] = (
    ("Step", "commit and go on", c.Step()),
    ("Commit", "Enter", c.Commit()),
    ("Next decision", "N", c.Move(by="decision", count=1)),
    ("Previous decision", "P", c.Move(by="decision", count=-1)),
    ("Next step", "→", c.Move(by="step", count=1)),
    ("Previous step", "←", c.Move(by="step", count=-1)),
    ("Play", "Space", c.Play()),
    ("Pause", "Space", c.Pause()),
    ("Run to the next Seeing", "", c.RunTo(until="seeing")),
    ("Run to the next Transition", "", c.RunTo(until="transition")),
    ("Run to the next Arriving", "", c.RunTo(until="arriving")),
    ("Run to the end", "", c.RunTo(until="end")),
    ("First suspect", "B", c.Jump(to="first_suspect")),
    ("Worst suspect", "Shift+B", c.Jump(to="worst_suspect")),
    ("Next disagreement", "]", c.Jump(to="next_disagreement")),
    ("Previous disagreement", "[", c.Jump(to="previous_disagreement")),
    ("Tie with the next", "=", c.Tie()),
    ("None of these", "X", c.NoneOfThese()),
    ("Take the last rank back", "Backspace", c.TakeBack()),
    ("Drop your ranking", "Esc", c.Clear()),
    ("Cancel the question", "", c.Cancel()),
    ("Ask again", "", c.AskAgain()),
    ("Agree", "A", c.Verdict(value="agree")),
    ("Acceptable", "S", c.Verdict(value="acceptable")),
    ("Wrong", "W", c.Verdict(value="wrong")),
    ("Cannot tell", "C", c.Verdict(value="cannot tell")),
    ("A would have been better", "Shift+1", c.Better(position=0)),
    ("B would have been better", "Shift+2", c.Better(position=1)),
    ("C would have been better", "Shift+3", c.Better(position=2)),
    ("Flag", "F", c.Flag()),
    ("Cover the answers", "", c.Cover(on=True)),
    ("Show the answers again", "", c.Cover(on=False)),
    ("Show the covered answer", "V", c.Reveal()),
    ("Measure turning points", "", c.MeasureTurning()),
    ("Try other answers", "", c.TryAnswers()),
    ("Stop trying answers", "", c.CancelTrying()),
    ("Undo", "U", c.Undo()),
    ("Redo", "R", c.Redo()),
    ("Camera: free", "", c.Camera(mode="free")),
    ("Camera: follow", "", c.Camera(mode="follow")),
    ("Camera: ego, rendered here, not what the robot saw", "", c.Camera(mode="ego")),
    ("Camera: top-down", "", c.Camera(mode="top")),
    ("Show the goal", "G", c.Layer(name="goal", on=True)),
    ("Hide the goal", "G", c.Layer(name="goal", on=False)),
    ("Show the reference path", "", c.Layer(name="reference", on=True)),
    ("Hide the reference path", "", c.Layer(name="reference", on=False)),
    ("Show the walkable floor", "", c.Layer(name="floor", on=True)),
    ("Hide the walkable floor", "", c.Layer(name="floor", on=False)),
    ("Show the viewpoints of the connectivity graph", "", c.Layer(name="viewpoints", on=True)),
    ("Hide the viewpoints", "", c.Layer(name="viewpoints", on=False)),
    ("Forget the asked place", "", c.ForgetPlace()),
)


def add_palette(gui: viser.GuiApi, dispatch: Dispatch) -> None:
    """Register every action; hotkeys are the page's."""
    for label, key, command in ACTIONS:
        handle = gui.add_command(label, description=key or None)
        handle.on_trigger(_trigger(dispatch, command))


def _trigger(dispatch: Dispatch, command: Command):  # noqa: ANN202 # viser's own callback type
    def trigger(_: viser.CommandEvent) -> None:
        dispatch(command)

    return trigger
