"""Plans: letters to coordinates, doors in the right walls, furniture out of the way."""

from __future__ import annotations

import pytest

from c2nav_engine.errors import InternalError
from c2nav_engine.world.builtin.colours import Colours
from c2nav_engine.world.builtin.freedom import Freedom
from c2nav_engine.world.builtin.placement import furnish
from c2nav_engine.world.builtin.plan import Door, Plan, Rect
from c2nav_engine.world.builtin.resolve import resolve


def plan(cells: str, *doors: Door, kind: str = "living room") -> Plan:
    rows = [line.split() for line in cells.strip().splitlines()]
    letters = {letter for row in rows for letter in row} - {"."}
    return Plan(
        name="test",
        seed=1,
        columns=(4.0,) * len(rows[0]),
        rows=(3.0,) * len(rows),
        storeys=(cells,),
        rooms=dict.fromkeys(letters, kind),
        doors=doors,
    )


def test_the_plan_is_centred_and_letters_become_rooms():
    layout = resolve(plan("A A\nB ."))
    assert layout.room("A").rects == (Rect(-4.0, -3.0, 4.0, 0.0),)
    assert layout.room("B").rects == (Rect(-4.0, 0.0, 0.0, 3.0),)
    assert layout.room_at(1.0, 0.0, -1.0) == layout.room("A")
    assert layout.room_at(1.0, 0.0, 1.0) is None


def test_walls_stand_on_every_boundary_once():
    layout = resolve(plan("A B"))
    length = sum(wall.high - wall.low for wall in layout.walls)
    assert length == pytest.approx(2 * 8.0 + 3 * 3.0)


def test_a_door_opens_the_wall_between_its_rooms():
    layout = resolve(plan("A B", Door("A", "B", at=0.0)))
    (cut,) = [wall for wall in layout.walls if wall.openings]
    assert {cut.before, cut.after} == {"A", "B"}
    (opening,) = cut.openings
    assert opening.high - opening.low >= 0.9
    assert cut.low < opening.low


def test_a_side_chooses_among_several_walls():
    cells = "A A\nA B"
    north = resolve(plan(cells, Door("A", "B", side="north")))
    west = resolve(plan(cells, Door("A", "B", side="west")))
    assert [wall.axis for wall in north.walls if wall.openings] == ["x"]
    assert [wall.axis for wall in west.walls if wall.openings] == ["z"]


@pytest.mark.parametrize(
    ("broken", "says"),
    [
        (plan("A .\n. B", Door("A", "B")), "no wall between"),
        (
            Plan("test", 1, (1.0, 4.0), (1.2,), ("A B",), {"A": "a", "B": "b"}, (Door("A", "B"),)),
            "expected a wall",
        ),
        (Plan("test", 1, (4.0,), (3.0,), ("A B",), {"A": "a", "B": "b"}, ()), "cells"),
    ],
)
def test_a_plan_that_contradicts_itself_is_a_bug(broken: Plan, says: str):
    with pytest.raises(InternalError, match=says):
        resolve(broken)


def test_furniture_leaves_the_way_between_two_doors():
    layout = resolve(plan("A B C", Door("A", "B"), Door("B", "C")))
    room = layout.room("B")
    items = furnish(layout, room, Colours(1))
    assert len([item for item in items if item.solid]) >= 4
    walls = [wall for wall in layout.walls if "B" in {wall.before, wall.after}]
    freedom = Freedom(room, walls)
    assert freedom.keeps_ways([item.rect for item in items if item.solid])
    across = Rect(-0.5, -1.5, 0.5, 1.5)
    assert not freedom.keeps_ways([across])


def test_no_two_things_of_a_kind_share_a_colour_while_some_are_left():
    import numpy as np

    colours, random = Colours(3), np.random.default_rng(0)
    given = [colours.tones("vase", random).colour for _ in range(15)]
    assert len(set(given)) == 15


@pytest.mark.parametrize(
    ("x", "z", "expected"), [(0.5, 0.5, 0.0), (2.0, 0.5, 1.0), (4.0, 5.0, 5.0)]
)
def test_distance_to_a_rectangle(x: float, z: float, expected: float):
    assert Rect(0.0, 0.0, 1.0, 1.0).distance(x, z) == pytest.approx(expected)
