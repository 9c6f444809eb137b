"""Where the map is cut, and what is laid over it on demand."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from app.inspector.scene.storey import CLIMBED_M, storey_m
from app.session import commands as c
from app.session.opened import Opened, Opening
from app.session.worker import Session
from c2nav_engine.errors import SceneError
from c2nav_engine.geometry import Point
from c2nav_engine.world.connectivity import ConnectivityGraph
from c2nav_engine.world.surface import Surface
from tests.helpers import stage
from tests.helpers.meshes import room, surface_of
from tests.helpers.watched import Watched

TREAD_M, RISE_M = 0.28, 0.18


def climb(steps: int, *, level: int = 8, from_m: float = 0.0) -> list[Point]:
    """A level walk, a flight of stairs (downwards where negative), and a level walk."""
    sign = 1 if steps > 0 else -1
    heights_m = [from_m] * level
    heights_m += [from_m + sign * RISE_M * (n + 1) for n in range(abs(steps))]
    heights_m += [heights_m[-1]] * level
    return [(0.0, height_m, -TREAD_M * n) for n, height_m in enumerate(heights_m)]


@pytest.mark.parametrize("steps", [16, -16, 9, -9])
def test_both_ends_of_a_flight_are_cut_at_their_own_floor(steps: int):
    way_m = climb(steps, from_m=1.0)
    assert storey_m(way_m[:8]) == 1.0
    assert storey_m(way_m) == way_m[-1][1]


@pytest.mark.parametrize("steps", [16, -16])
def test_on_stairs_the_cut_stays_near_the_body(steps: int):
    way_m = climb(steps)
    for stop in range(1, len(way_m) + 1):
        assert abs(storey_m(way_m[:stop]) - way_m[stop - 1][1]) <= CLIMBED_M


def test_thresholds_and_turns_on_the_spot_move_no_cut():
    sunken = climb(-2)
    assert {storey_m(sunken[:stop]) for stop in range(1, len(sunken) + 1)} == {0.0}
    landing = [*climb(3)[:11], *[climb(3)[10]] * 24]
    assert storey_m(landing) == 0.0


GRAPH = ConnectivityGraph("made", {}, {})


def opened(floor: Surface | None, graph: Callable[[], ConnectivityGraph] | None = None) -> Opened:
    """A live source of one scan, with what can be laid over it."""
    plain = stage.opened_live()

    def opening(choice: object) -> Opening:
        del choice
        run = stage.live_run()
        plain = Opening(run.header, run=run, viewpoints=graph)
        return plain if floor is None else replace(plain, surface=lambda: floor)

    return replace(plain, open=opening)


@pytest.fixture
def watch() -> Iterator[Callable[[Opened], Watched]]:
    sessions: list[Session] = []

    def watched(what: Opened) -> Watched:
        sessions.append(Session(what))
        return Watched(sessions[-1])

    yield watched
    for session in sessions:
        session.close()


def test_the_floor_is_loaded_when_it_is_first_shown(watch):
    floor = surface_of(room(4.0, 3.0))
    seen = watch(opened(floor))
    assert seen.session.snapshot.overlays.floor_m is None
    seen.do(c.Layer(name="floor", on=True))
    shown = seen.until(lambda s: s.overlays.floor_m is not None)
    assert shown.overlays.floor_m.shape[1:] == (3, 3)
    assert "floor" in shown.view.layers


def test_another_episode_brings_its_own_viewpoints(watch):
    graphs = iter([GRAPH, replace(GRAPH, scan="other")])
    seen = watch(opened(None, lambda: next(graphs)))
    seen.do(c.Layer(name="viewpoints", on=True))
    assert seen.until(lambda s: s.overlays.viewpoints is not None).overlays.viewpoints is GRAPH
    seen.do(c.Open(entry="2"))
    seen.until(
        lambda s: s.overlays.viewpoints is not None and s.overlays.viewpoints.scan == "other"
    )


@pytest.mark.parametrize(("layer", "word"), [("floor", "--scenes"), ("viewpoints", "--connectiv")])
def test_what_cannot_be_shown_says_what_to_do(watch, layer: str, word: str):
    seen = watch(opened(None))
    seen.do(c.Layer(name=layer, on=True))
    assert word in seen.until(lambda s: s.notice.text != "").notice.text


def test_a_scan_without_a_graph_is_told(watch):
    def absent() -> ConnectivityGraph:
        message = f"{Path('graphs/made_connectivity.json')}: expected a connectivity file"
        raise SceneError(message)

    seen = watch(opened(None, absent))
    seen.do(c.Layer(name="viewpoints", on=True))
    notice = seen.until(lambda s: s.notice.text != "").notice
    assert notice.fault
    assert "made_connectivity.json" in notice.text
