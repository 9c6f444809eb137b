"""One long hallway, three rooms on each side."""

from __future__ import annotations

from c2nav_engine.world.builtin.plan import Door, Plan

MAPLE = Plan(
    name="maple",
    seed=11,
    columns=(3.4, 1.6, 2.4, 3.8),
    rows=(3.8, 1.8, 4.6),
    storeys=(
        """
        B B W G
        C C C C
        L L L K
        """,
    ),
    rooms={
        "B": "bedroom",
        "W": "bathroom",
        "G": "study",
        "C": "hallway",
        "L": "living room",
        "K": "kitchen",
    },
    doors=(
        Door("B", "C", at=0.3),
        Door("W", "C"),
        Door("G", "C", at=0.7),
        Door("L", "C", "arch", at=0.65),
        Door("K", "C", at=0.6),
        Door("L", "K", "arch", at=0.8),
        Door("C", ".", "front door"),
    ),
)
