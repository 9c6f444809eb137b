"""A hallway that winds through the house."""

from __future__ import annotations

from c2nav_engine.world.builtin.plan import Door, Plan

HAZEL = Plan(
    name="hazel",
    seed=71,
    columns=(3.8, 1.8, 2.0, 4.0),
    rows=(2.4, 2.4, 1.8, 2.6, 3.6),
    storeys=(
        """
        L L H B
        L L H B
        D H H G
        D H W G
        K H H Y
        """,
    ),
    rooms={
        "L": "living room",
        "H": "hallway",
        "B": "bedroom",
        "D": "dining room",
        "G": "guest room",
        "W": "bathroom",
        "K": "small kitchen",
        "Y": "studio",
    },
    doors=(
        Door("H", "L", "arch", side="east"),
        Door("H", "B", at=0.3),
        Door("H", "G", at=0.5),
        Door("H", "D", at=0.3),
        Door("H", "W", side="north"),
        Door("K", "H", at=0.6),
        Door("K", "D", "arch"),
        Door("Y", "H", at=0.5),
        Door(".", "H", "front door", side="north"),
    ),
)
