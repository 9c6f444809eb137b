"""A very long hallway; a small dead-end storage room among its doors."""

from __future__ import annotations

from c2nav_engine.world.builtin.plan import Door, Plan

CEDAR = Plan(
    name="cedar",
    seed=37,
    columns=(3.8, 2.4, 3.4, 2.2, 3.6),
    rows=(3.6, 1.7, 4.6),
    storeys=(
        """
        B W G N D
        C C C C C
        L L M K K
        """,
    ),
    rooms={
        "B": "bedroom",
        "W": "bathroom",
        "G": "guest room",
        "N": "storage room",
        "D": "study",
        "C": "hallway",
        "L": "living room",
        "M": "music room",
        "K": "kitchen",
    },
    doors=(
        Door("B", "C", at=0.7),
        Door("W", "C"),
        Door("G", "C", at=0.2),
        Door("N", "C"),
        Door("D", "C", at=0.8),
        Door("L", "C", at=0.3),
        Door("L", "M", "arch"),
        Door("M", "C"),
        Door("K", "C", "arch", at=0.5),
        Door("C", ".", "front door"),
    ),
    outside="boards",
)
