"""Rooms around a large entrance hall."""

from __future__ import annotations

from c2nav_engine.world.builtin.plan import Door, Plan

JUNIPER = Plan(
    name="juniper",
    seed=67,
    columns=(4.2, 2.2, 2.4, 4.2),
    rows=(2.4, 2.0, 2.2, 4.6),
    storeys=(
        """
        B E E G
        B E E G
        W C C Y
        L L K K
        """,
    ),
    rooms={
        "B": "bedroom",
        "E": "entrance hall",
        "G": "studio",
        "W": "bathroom",
        "C": "hallway",
        "Y": "laundry room",
        "L": "living room",
        "K": "kitchen",
    },
    doors=(
        Door("B", "E", at=0.6),
        Door("G", "E", at=0.3),
        Door("E", "C", "open"),
        Door("W", "C"),
        Door("Y", "C"),
        Door("L", "C", at=0.5),
        Door("K", "C", at=0.5),
        Door("L", "K", "arch", at=0.75),
        Door("E", ".", "front door"),
    ),
    outside="brick",
)
