"""Living and dining room open into each other; bedrooms along a short hallway."""

from __future__ import annotations

from c2nav_engine.world.builtin.plan import Door, Plan

WILLOW = Plan(
    name="willow",
    seed=53,
    columns=(4.2, 2.8, 4.2, 4.0),
    rows=(3.8, 1.7, 4.4),
    storeys=(
        """
        B W L L
        C C L L
        G N D K
        """,
    ),
    rooms={
        "B": "bedroom",
        "W": "bathroom",
        "C": "hallway",
        "L": "living room",
        "G": "children's room",
        "N": "laundry room",
        "D": "dining room",
        "K": "kitchen",
    },
    doors=(
        Door("B", "C", at=0.6),
        Door("W", "C"),
        Door("G", "C", at=0.4),
        Door("N", "C", at=0.6),
        Door("C", "L", "open"),
        Door("L", "D", "open"),
        Door("D", "K", "arch"),
        Door("L", ".", "front door", at=0.8, side="south"),
    ),
    outside="boards",
)
