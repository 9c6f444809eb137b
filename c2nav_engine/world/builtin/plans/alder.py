"""Two hallways that meet; five doors at their crossing."""

from __future__ import annotations

from c2nav_engine.world.builtin.plan import Door, Plan

ALDER = Plan(
    name="alder",
    seed=97,
    columns=(3.4, 1.7, 1.9, 1.7, 3.4),
    rows=(3.0, 3.2, 1.9, 4.2),
    storeys=(
        """
        L L C D D
        L L C K K
        N C C C W
        B B P G G
        """,
    ),
    rooms={
        "L": "living room",
        "C": "hallway",
        "D": "dining room",
        "K": "kitchen",
        "N": "storage room",
        "W": "bathroom",
        "B": "bedroom",
        "P": "laundry room",
        "G": "study",
    },
    doors=(
        Door("C", "L", "arch", at=0.3, side="east"),
        Door("C", "D", at=0.4),
        Door("C", "K", at=0.6, side="west"),
        Door("D", "K", "arch", at=0.8),
        Door("N", "C"),
        Door("W", "C"),
        Door("B", "C"),
        Door("P", "C"),
        Door("G", "C"),
        Door(".", "C", "front door", side="north"),
    ),
)
