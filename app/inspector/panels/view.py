"""How the map is looked at: cameras and layers, in viser's own panel."""

from __future__ import annotations

import viser

from app.inspector.panels.controls import buttons
from app.inspector.panels.protocol import Dispatch, Update
from app.session import commands as c
from app.session.snapshot import LAYERS, Snapshot


def build(gui: viser.GuiApi, dispatch: Dispatch) -> Update:
    """Build the controls; they stand above viser's own."""
    buttons(
        gui,
        dispatch,
        label="camera",
        commands={
            "free": c.Camera(mode="free"),
            "follow": c.Camera(mode="follow"),
            "ego": c.Camera(mode="ego"),
            "top": c.Camera(mode="top"),
        },
    )
    boxes = {name: _box(gui, dispatch, name) for name in LAYERS}

    def update(snapshot: Snapshot) -> None:
        for name, box in boxes.items():
            shown = name in snapshot.view.layers
            if box.value != shown:
                box.value = shown

    return update


def _box(gui: viser.GuiApi, dispatch: Dispatch, name: str) -> viser.GuiCheckboxHandle:
    box = gui.add_checkbox(name, False)

    @box.on_update
    def _(event: viser.GuiEvent[viser.GuiCheckboxHandle]) -> None:
        # Our own assignments echo back without a client.
        if event.client is not None:
            dispatch(c.Layer(name=name, on=event.target.value))

    return box
