"""Which things an instruction may mention."""

from __future__ import annotations

from c2nav_engine.world.builtin.house import House
from c2nav_engine.world.builtin.placement import Item

SALIENCE: dict[str, float] = {
    "vase": 3.0,
    "pedestal": 3.0,
    "chest": 2.6,
    "aquarium": 3.0,
    "fireplace": 3.0,
    "piano": 3.0,
    "sofa": 2.8,
    "bed": 2.6,
    "single bed": 2.6,
    "armchair": 2.5,
    "rocking chair": 2.4,
    "beanbag": 2.4,
    "ottoman": 2.2,
    "bench": 2.4,
    "globe": 2.4,
    "painting": 2.0,
    "mirror": 1.8,
    "clock": 1.8,
    "rug": 2.2,
    "runner": 2.0,
    "plant": 2.0,
    "palm": 2.2,
    "floor lamp": 2.2,
    "umbrella stand": 2.4,
    "suitcase": 2.4,
    "dresser": 2.2,
    "sideboard": 2.2,
    "console table": 1.8,
    "coat rack": 2.0,
    "dining table": 2.6,
    "round table": 2.2,
    "coffee table": 1.6,
    "kitchen island": 2.6,
    "refrigerator": 2.4,
    "stove": 2.0,
    "kitchen counter": 1.4,
    "bathtub": 2.4,
    "washbasin": 1.8,
    "toilet": 1.6,
    "washing machine": 2.0,
    "television": 2.2,
    "bookshelf": 2.0,
    "wardrobe": 2.2,
    "desk": 2.0,
    "toy shelf": 2.0,
}
"""How much a thing catches the eye; what is missing here is never mentioned."""


def can_be_named(house: House, item: Item) -> bool:
    """Whether its words mean one thing only in its room."""
    if item.kind not in SALIENCE:
        return False
    return (
        sum(other.room == item.room and other.phrase == item.phrase for other in house.items) == 1
    )
