"""Native controls that follow the snapshot and enqueue commands."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import viser

from app.inspector.panels.protocol import Dispatch
from app.session.commands import Command, Go

NO_OPTIONS: tuple[str, ...] = ("",)


class Picker:
    """A drop-down over ids with labels; hidden while there is nothing to choose."""

    def __init__(self, gui: viser.GuiApi, label: str, pick: Callable[[str], None]) -> None:
        """Place it; `pick` gets the id that a person chose."""
        self._handle: viser.GuiDropdownHandle[str] = gui.add_dropdown(
            label, NO_OPTIONS, visible=False
        )
        self._ids: dict[str, str] = {}

        @self._handle.on_update
        def _(event: viser.GuiEvent[viser.GuiDropdownHandle[str]]) -> None:
            # Our own assignments echo back without a client.
            if event.client is not None and event.target.value in self._ids:
                pick(self._ids[event.target.value])

    def show(self, labels: Mapping[str, str], chosen: str, *, least: int = 1) -> None:
        """Offer labels by id; hidden below `least` of them."""
        self._ids = {label: name for name, label in labels.items()}
        options = tuple(self._ids) or NO_OPTIONS
        if tuple(self._handle.options) != options:
            self._handle.options = options
        value = labels.get(chosen, options[0])
        if self._handle.value != value:
            self._handle.value = value
        visible = len(labels) >= least
        if self._handle.visible != visible:
            self._handle.visible = visible


class Stepper:
    """A slider over low-level steps, for hands that do without the timeline: arrows move it."""

    def __init__(self, gui: viser.GuiApi, dispatch: Dispatch) -> None:
        """Place it."""
        self._handle = gui.add_slider(
            "step", min=0, max=1, step=1, initial_value=0, hint="← → one step when it has the focus"
        )

        @self._handle.on_update
        def _(event: viser.GuiEvent[viser.GuiSliderHandle[int]]) -> None:
            # Our own assignments echo back without a client.
            if event.client is not None:
                dispatch(Go(step=event.target.value))

    def show(self, step: int, last: int) -> None:
        """Stand at a step of so many."""
        if self._handle.max != max(last, 1):
            self._handle.max = max(last, 1)
        if self._handle.value != step:
            self._handle.value = step


def buttons(
    gui: viser.GuiApi, dispatch: Dispatch, *, label: str, commands: Mapping[str, Command]
) -> None:
    """A row of buttons, each with its command."""
    handle = gui.add_button_group(label, tuple(commands))

    @handle.on_click
    def _(event: viser.GuiEvent[viser.GuiButtonGroupHandle]) -> None:
        dispatch(commands[str(event.target.value)])
