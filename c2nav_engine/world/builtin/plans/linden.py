"""Two wings around a courtyard."""

from __future__ import annotations

from c2nav_engine.world.builtin.plan import Door, Plan

LINDEN = Plan(
    name="linden",
    seed=103,
    columns=(3.8, 2.0, 2.0, 3.4, 3.2),
    rows=(3.8, 1.7, 3.2, 3.2, 2.4),
    storeys=(
        """
        B B W L L
        C C C L L
        Y . C D D
        G . C K K
        E E E K K
        """,
    ),
    rooms={
        "B": "bedroom",
        "W": "bathroom",
        "L": "living room",
        "C": "hallway",
        "Y": "playroom",
        "D": "dining room",
        "G": "guest room",
        "K": "kitchen",
        "E": "entrance hall",
    },
    doors=(
        Door("B", "C", at=0.8),
        Door("W", "C"),
        Door("Y", "C", at=0.3),
        Door("G", "E", at=0.6),
        Door("C", "E", "open"),
        Door("L", "C", at=0.5),
        Door("L", "D", "open"),
        Door("D", "K", "arch", at=0.7),
        Door("C", "K", at=0.4),
        Door(".", "E", "front door", side="south"),
    ),
    outside="boards",
)
