"""A narrow entrance and a long hallway with a dead-end storage room."""

from __future__ import annotations

from c2nav_engine.world.builtin.plan import Door, Plan

ROWAN = Plan(
    name="rowan",
    seed=83,
    columns=(2.8, 3.0, 1.8, 2.4, 3.4, 2.2),
    rows=(2.4, 2.4, 1.8, 4.0),
    storeys=(
        """
        . K K L L L
        . K K L L L
        E C C C C C
        . B B W G N
        """,
    ),
    rooms={
        "K": "kitchen",
        "L": "living room",
        "E": "entrance hall",
        "C": "hallway",
        "B": "bedroom",
        "W": "bathroom",
        "G": "children's room",
        "N": "storage room",
    },
    doors=(
        Door("E", "C", "open"),
        Door("K", "C", at=0.4),
        Door("L", "C", "arch", at=0.7),
        Door("K", "L", "arch", at=0.4),
        Door("B", "C", at=0.2),
        Door("W", "C"),
        Door("G", "C", at=0.3),
        Door("N", "C"),
        Door("E", ".", "front door", side="east"),
    ),
    outside="brick",
)
