"""A hallway in a ring around a library."""

from __future__ import annotations

from c2nav_engine.world.builtin.plan import Door, Plan

ASPEN = Plan(
    name="aspen",
    seed=41,
    columns=(4.0, 1.6, 3.4, 1.6, 4.0),
    rows=(3.2, 1.6, 3.4, 1.6, 3.8),
    storeys=(
        """
        L L L K K
        L H H H K
        B H P H D
        B H H H D
        G G W Y Y
        """,
    ),
    rooms={
        "L": "living room",
        "K": "kitchen",
        "H": "hallway",
        "B": "bedroom",
        "P": "library",
        "D": "dining room",
        "G": "guest room",
        "W": "bathroom",
        "Y": "playroom",
    },
    doors=(
        Door("L", "H", "arch", at=0.5, side="north"),
        Door("K", "H", side="east"),
        Door("B", "H", at=0.7),
        Door("P", "H", side="south"),
        Door("D", "H", "arch", at=0.4),
        Door("D", "K", "arch"),
        Door("G", "H"),
        Door("W", "H", at=0.3),
        Door("Y", "H"),
        Door("L", ".", "front door", side="south"),
    ),
)
