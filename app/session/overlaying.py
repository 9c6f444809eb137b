"""Loading of what is laid over the map: in the background, once an episode, when first shown."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from app.session.desk import Desk, Message
from app.session.overlay_state import Overlays
from c2nav_engine.errors import C2NavError


def lay(desk: Desk, layers: Iterable[str]) -> None:
    """Load what the layers show, unless it is there; says so where there is none to be had."""
    if "floor" in layers and desk.snapshot.overlays.floor_m is None:
        _lay_floor(desk)
    if "viewpoints" in layers and desk.snapshot.overlays.viewpoints is None:
        _lay_viewpoints(desk)


def _lay_floor(desk: Desk) -> None:
    load = desk.floor
    if load is None:
        desk.say("no walkable floor without the scene; name its folder with --scenes DIR")
    else:
        _fetch(desk, lambda: Overlays(floor_m=load().triangles()))


def _lay_viewpoints(desk: Desk) -> None:
    load = desk.viewpoints
    if load is None:
        desk.say("no viewpoints: start with --connectivity DIR, which holds SCAN_connectivity.json")
    else:
        _fetch(desk, lambda: Overlays(viewpoints=load()))


def _fetch(desk: Desk, load: Callable[[], Overlays]) -> None:
    generation = desk.generation

    def task() -> Message:
        try:
            more = load()
        except C2NavError as error:
            problem = str(error)
            return lambda desk: desk.say(problem, fault=True)
        return lambda desk: _take(desk, generation, more)

    desk.hands.background(task)


def _take(desk: Desk, generation: int, more: Overlays) -> None:
    if generation == desk.generation:
        desk.change(overlays=desk.snapshot.overlays.joined(more))
