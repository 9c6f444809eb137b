"""Two storeys; the stairs rise along the middle of the house."""

from __future__ import annotations

from c2nav_engine.world.builtin.plan import Door, Plan

WALNUT = Plan(
    name="walnut",
    seed=127,
    columns=(3.4, 1.9, 2.4, 2.4, 1.9, 3.4),
    rows=(4.0, 1.1, 1.8, 4.2),
    storeys=(
        """
        L L L K K K
        L C S S C K
        L C C C C K
        B B W D D D
        """,
        """
        M M M Y Y Y
        M A S S A Y
        M A A A A Y
        X X V Z Z Z
        """,
    ),
    rooms={
        "L": "living room",
        "K": "kitchen",
        "C": "hallway",
        "S": "stairs",
        "B": "guest room",
        "W": "laundry room",
        "D": "dining room",
        "M": "bedroom",
        "Y": "library",
        "A": "landing",
        "X": "studio",
        "V": "bathroom",
        "Z": "music room",
    },
    doors=(
        Door("L", "C", "arch", side="west"),
        Door("K", "C", side="east"),
        Door("B", "C", at=0.6),
        Door("W", "C"),
        Door("D", "C", at=0.4),
        Door("K", "D", "arch"),
        Door("L", ".", "front door", side="east"),
        Door("C", "S", "open", side="west"),
        Door("A", "S", "open", side="east"),
        Door("A", "S", "railing", side="south"),
        Door("A", "S", "railing", side="west"),
        Door("M", "A", side="west"),
        Door("Y", "A", side="east"),
        Door("X", "A", at=0.4),
        Door("V", "A"),
        Door("Z", "A", at=0.5),
    ),
)
