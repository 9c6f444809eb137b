"""Two storeys; the stairs rise from the end of the hallway."""

from __future__ import annotations

from c2nav_engine.world.builtin.plan import Door, Plan

CHESTNUT = Plan(
    name="chestnut",
    seed=109,
    columns=(4.4, 1.9, 1.1, 4.4),
    rows=(2.4, 2.4, 2.4, 2.4),
    storeys=(
        """
        L E E K
        L H S K
        D H S K
        D H H W
        """,
        """
        B A A G
        B A S G
        X A S Y
        X A A Y
        """,
    ),
    rooms={
        "L": "living room",
        "E": "entrance hall",
        "K": "kitchen",
        "H": "hallway",
        "D": "dining room",
        "W": "bathroom",
        "S": "stairs",
        "A": "landing",
        "B": "bedroom",
        "G": "guest room",
        "X": "study",
        "Y": "playroom",
    },
    doors=(
        Door("E", "H", "open"),
        Door("L", "E", at=0.5),
        Door("L", "D", "arch"),
        Door("D", "H", at=0.7),
        Door("K", "E"),
        Door("W", "H"),
        Door("E", ".", "front door"),
        Door("H", "S", "open", side="south"),
        Door("A", "S", "open", side="north"),
        Door("A", "S", "railing", side="west"),
        Door("A", "S", "railing", side="south"),
        Door("B", "A", at=0.6),
        Door("G", "A"),
        Door("X", "A", at=0.4),
        Door("Y", "A"),
    ),
    outside="brick",
)
