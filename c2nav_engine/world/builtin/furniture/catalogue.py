"""Every kind of thing by the noun that an instruction may use for it."""

from __future__ import annotations

from functools import cache

from c2nav_engine.world.builtin.furniture import decor, kitchen, seats, storage, tables
from c2nav_engine.world.builtin.furniture.model import Maker, Model, Tones, model_of

MAKERS: dict[str, Maker] = {
    "sofa": seats.sofa,
    "armchair": seats.armchair,
    "bed": seats.double_bed,
    "single bed": seats.single_bed,
    "chair": seats.dining_chair,
    "bar stool": seats.stool,
    "office chair": seats.office_chair,
    "bench": seats.bench,
    "ottoman": seats.ottoman,
    "beanbag": seats.beanbag,
    "rocking chair": seats.rocking_chair,
    "piano stool": seats.piano_stool,
    "dining table": tables.dining_table,
    "round table": tables.round_table,
    "coffee table": tables.coffee_table,
    "side table": tables.side_table,
    "console table": tables.console_table,
    "desk": tables.desk,
    "nightstand": tables.nightstand,
    "wardrobe": storage.wardrobe,
    "dresser": storage.dresser,
    "sideboard": storage.sideboard,
    "bookshelf": storage.bookshelf,
    "chest": storage.chest,
    "television": storage.tv_stand,
    "coat rack": storage.coat_rack,
    "toy shelf": storage.toy_shelf,
    "kitchen counter": kitchen.kitchen_counter,
    "wall cabinet": kitchen.wall_cabinet,
    "stove": kitchen.stove,
    "refrigerator": kitchen.refrigerator,
    "kitchen island": kitchen.kitchen_island,
    "toilet": kitchen.toilet,
    "washbasin": kitchen.washbasin,
    "bathtub": kitchen.bathtub,
    "washing machine": kitchen.washing_machine,
    "towel rail": kitchen.towel_rail,
    "plant": decor.plant,
    "palm": decor.palm,
    "vase": decor.tall_vase,
    "floor lamp": decor.floor_lamp,
    "rug": decor.rug_of,
    "runner": decor.runner,
    "painting": decor.painting_of,
    "mirror": decor.wall_mirror,
    "clock": decor.wall_clock,
    "aquarium": decor.aquarium,
    "globe": decor.globe,
    "piano": decor.piano,
    "fireplace": decor.fireplace,
    "pedestal": decor.pedestal,
    "umbrella stand": decor.umbrella_stand,
    "suitcase": decor.suitcase,
}

FLAT = frozenset({"rug", "runner"})
"""What one walks over."""

HUNG: dict[str, float] = {"painting": 1.0, "mirror": 1.0, "clock": 1.4, "wall cabinet": 1.45}
"""What hangs on a wall and leaves the floor free, with the height where it begins."""

_NAMED_BY_COLOUR = (
    "sofa",
    "armchair",
    "bed",
    "single bed",
    "chair",
    "bar stool",
    "office chair",
    "bench",
    "ottoman",
    "beanbag",
    "rocking chair",
    "piano stool",
    "dresser",
    "sideboard",
    "chest",
    "kitchen island",
    "vase",
    "floor lamp",
    "rug",
    "runner",
    "painting",
    "clock",
    "globe",
    "fireplace",
    "umbrella stand",
    "suitcase",
)
PHRASES: dict[str, str] = {kind: f"{{colour}} {kind}" for kind in _NAMED_BY_COLOUR} | {
    "single bed": "{colour} bed",
    "plant": "plant in the {colour} pot",
    "palm": "palm in the {colour} pot",
    "pedestal": "pedestal with the {colour} ball",
    "mirror": "mirror with the {colour} frame",
    "washbasin": "sink",
    "kitchen counter": "counter",
    "runner": "{colour} runner rug",
}
"""What instructions call a thing where the bare noun is not it; the rest goes by its noun."""


@cache
def model(kind: str, tones: Tones) -> Model:
    """The finished model of one kind in these tones."""
    return model_of(MAKERS[kind](tones))
