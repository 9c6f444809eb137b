"""The built-in houses, drawn as plans."""

from __future__ import annotations

from c2nav_engine.world.builtin.plan import Door, Plan

_MAPLE = Plan(
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

_BIRCH = Plan(
    name="birch",
    seed=23,
    columns=(3.4, 2.4, 1.7, 3.8),
    rows=(3.8, 2.6, 1.8, 3.6),
    storeys=(
        """
        B B H D
        L L H D
        L L H H
        K K E W
        """,
    ),
    rooms={
        "B": "bedroom",
        "H": "hallway",
        "D": "study",
        "L": "living room",
        "K": "kitchen",
        "E": "entrance hall",
        "W": "bathroom",
    },
    doors=(
        Door("B", "H", at=0.7),
        Door("L", "H", "arch", at=0.35),
        Door("D", "H", at=0.3),
        Door("W", "H", at=0.8),
        Door("L", "K", "arch", at=0.2),
        Door("K", "E", at=0.4),
        Door("E", "H", "open"),
        Door("E", ".", "front door"),
    ),
    outside="brick",
)

_CEDAR = Plan(
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

_ASPEN = Plan(
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

_WILLOW = Plan(
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

_JUNIPER = Plan(
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

_HAZEL = Plan(
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

_ROWAN = Plan(
    name="rowan",
    seed=83,
    columns=(2.8, 3.0, 1.8, 2.4, 3.4, 2.2),
    rows=(2.4, 2.4, 1.8, 4.0),
    storeys=(
        """
        . K K L L L
        . K K L L L
        E C C C C C
        . B B W G N
        """,
    ),
    rooms={
        "K": "kitchen",
        "L": "living room",
        "E": "entrance hall",
        "C": "hallway",
        "B": "bedroom",
        "W": "bathroom",
        "G": "children's room",
        "N": "storage room",
    },
    doors=(
        Door("E", "C", "open"),
        Door("K", "C", at=0.4),
        Door("L", "C", "arch", at=0.7),
        Door("K", "L", "arch", at=0.4),
        Door("B", "C", at=0.2),
        Door("W", "C"),
        Door("G", "C", at=0.3),
        Door("N", "C"),
        Door("E", ".", "front door", side="east"),
    ),
    outside="brick",
)

_ALDER = Plan(
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

_LINDEN = Plan(
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

_CHESTNUT = Plan(
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

_WALNUT = Plan(
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

PLANS: dict[str, Plan] = {
    plan.name: plan
    for plan in (
        _MAPLE,
        _BIRCH,
        _CEDAR,
        _ASPEN,
        _WILLOW,
        _JUNIPER,
        _HAZEL,
        _ROWAN,
        _ALDER,
        _LINDEN,
        _CHESTNUT,
        _WALNUT,
    )
}
"""House name → plan."""
