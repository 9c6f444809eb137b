"""A hallway around a corner with a dead end."""

from __future__ import annotations

from c2nav_engine.world.builtin.plan import Door, Plan

BIRCH = Plan(
    name="birch",
    seed=23,
    columns=(3.4, 2.4, 1.7, 3.8),
    rows=(3.8, 2.6, 1.8, 3.6),
    storeys=(
        """
        B B H D
        L L H D
        L L H H
        K K E W
        """,
    ),
    rooms={
        "B": "bedroom",
        "H": "hallway",
        "D": "study",
        "L": "living room",
        "K": "kitchen",
        "E": "entrance hall",
        "W": "bathroom",
    },
    doors=(
        Door("B", "H", at=0.7),
        Door("L", "H", "arch", at=0.35),
        Door("D", "H", at=0.3),
        Door("W", "H", at=0.8),
        Door("L", "K", "arch", at=0.2),
        Door("K", "E", at=0.4),
        Door("E", "H", "open"),
        Door("E", ".", "front door"),
    ),
    outside="brick",
)
