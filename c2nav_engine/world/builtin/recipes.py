"""What stands in each kind of room."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Spot = Literal["middle of a wall", "corner", "along a wall", "middle of the room", "facing"]


@dataclass(frozen=True, slots=True)
class Wish:
    """One thing or group that a room would like to have.

    Attributes:
        kinds: One of these, chosen by the room's generator (names of things or groups).
        spot: Where it goes best; "facing" is opposite the first thing of the room.
        chance: Probability that it is wanted at all.
        count: How many.
        every_m2: One more for each so many square metres of the room; 0 for none.
    """

    kinds: tuple[str, ...]
    spot: Spot = "along a wall"
    chance: float = 1.0
    count: int = 1
    every_m2: float = 0.0

    def count_in(self, area_m2: float) -> int:
        """How many a room of this size wants."""
        return self.count + (int(area_m2 / self.every_m2) if self.every_m2 else 0)


def _wish(
    *kinds: str,
    spot: Spot = "along a wall",
    chance: float = 1.0,
    count: int = 1,
    every_m2: float = 0.0,
) -> Wish:
    return Wish(kinds, spot, chance, count, every_m2)


_GREENERY = _wish("plant", "palm", spot="corner")
_PICTURES = _wish("painting", spot="along a wall", count=2)

RECIPES: dict[str, tuple[Wish, ...]] = {
    "living room": (
        _wish("seating", spot="middle of a wall"),
        _wish("television", spot="facing"),
        _wish("fireplace", "bookshelf", "aquarium", spot="middle of a wall"),
        _GREENERY,
        _wish("vase", spot="corner"),
        _wish("sideboard", "bookshelf", chance=0.8),
        _PICTURES,
        _wish("reading corner", spot="corner", chance=0.6),
        _wish("clock", chance=0.4),
    ),
    "dining room": (
        _wish("dining", spot="middle of the room"),
        _wish("sideboard", spot="middle of a wall"),
        _wish("plant", "vase", spot="corner"),
        _PICTURES,
        _wish("floor lamp", spot="corner", chance=0.5),
    ),
    "kitchen": (
        _wish("kitchen run", spot="middle of a wall"),
        _wish("refrigerator", spot="corner"),
        _wish("island", "breakfast", spot="middle of the room"),
        _wish("plant", spot="corner", chance=0.6),
        _wish("clock", "painting"),
        _wish("sideboard", "bench", chance=0.7),
        _wish("palm", "vase", spot="corner", chance=0.6),
        _wish("painting", chance=0.7),
    ),
    "small kitchen": (
        _wish("short kitchen run", spot="middle of a wall"),
        _wish("refrigerator", spot="corner"),
        _wish("clock"),
        _wish("plant", spot="corner", chance=0.5),
    ),
    "bedroom": (
        _wish("bed", spot="middle of a wall"),
        _wish("wardrobe"),
        _wish("dresser", "chest"),
        _wish("armchair", "ottoman", "bench", spot="corner"),
        _wish("painting", "mirror"),
        _wish("plant", "floor lamp", "vase", spot="corner"),
        _wish("painting"),
    ),
    "guest room": (
        _wish("bed by the wall", spot="corner"),
        _wish("wardrobe", "dresser"),
        _wish("suitcase", "chest", spot="corner"),
        _wish("reading corner", "rocking chair", spot="corner"),
        _wish("rug", spot="middle of the room"),
        _wish("bookshelf", "sideboard", chance=0.7),
        _wish("plant", "vase", spot="corner"),
        _PICTURES,
    ),
    "children's room": (
        _wish("bed by the wall", spot="corner"),
        _wish("toy shelf"),
        _wish("desk", chance=0.6),
        _wish("beanbag", "rocking chair", spot="corner"),
        _wish("rug", spot="middle of the room"),
        _wish("painting", count=2),
        _wish("chest", chance=0.6),
    ),
    "playroom": (
        _wish("toy shelf"),
        _wish("rug", spot="middle of the room"),
        _wish("beanbag", spot="corner", count=2),
        _wish("chest"),
        _wish("toy shelf", "bookshelf"),
        _wish("corner seating", "piano", chance=0.6),
        _wish("globe", "plant", spot="corner"),
        _PICTURES,
    ),
    "study": (
        _wish("desk", spot="middle of a wall"),
        _wish("bookshelf", count=2),
        _wish("globe", "vase", spot="corner"),
        _wish("reading corner", spot="corner"),
        _wish("painting", "clock"),
        _wish("rug", spot="middle of the room", chance=0.7),
    ),
    "library": (
        _wish("bookshelf", count=4),
        _wish("reading corner", spot="corner"),
        _wish("globe", spot="corner"),
        _wish("rug", spot="middle of the room"),
        _wish("reading corner", spot="corner"),
        _wish("painting"),
    ),
    "music room": (
        _wish("piano", spot="middle of a wall"),
        _wish("corner seating", spot="middle of a wall"),
        _wish("rug", spot="middle of the room"),
        _wish("plant", "vase", spot="corner"),
        _PICTURES,
        _wish("bookshelf", chance=0.5),
    ),
    "studio": (
        _wish("desk", spot="middle of a wall"),
        _wish("pedestal", spot="corner", count=2),
        _wish("painting", count=3),
        _wish("chest"),
        _wish("vase", spot="corner"),
        _wish("ottoman", spot="corner"),
    ),
    "bathroom": (
        _wish("bathtub", spot="corner"),
        _wish("washbasin", spot="middle of a wall"),
        _wish("toilet"),
        _wish("towel rail"),
        _wish("plant", spot="corner", chance=0.3),
    ),
    "laundry room": (
        _wish("washing machine", spot="corner", count=2),
        _wish("sideboard", "chest"),
        _wish("towel rail"),
    ),
    "storage room": (
        _wish("bookshelf"),
        _wish("chest", spot="corner"),
        _wish("suitcase", spot="corner"),
        _wish("suitcase", spot="corner"),
    ),
    "entrance hall": (
        _wish("coat rack", spot="corner"),
        _wish("bench", "console table", spot="middle of a wall"),
        _wish("umbrella stand", spot="corner"),
        _wish("mirror", "painting"),
        _wish("rug", spot="middle of the room", chance=0.6),
        _wish("plant", "vase", spot="corner"),
    ),
    "hallway": (
        _wish("console table", "bench", spot="along a wall"),
        _wish("vase", "pedestal", spot="corner"),
        _wish("painting", count=2, every_m2=12.0),
        _wish("runner", spot="middle of the room", chance=0.7),
        _wish("vase", "umbrella stand", "pedestal", "plant", every_m2=14.0),
        _wish("chest", "ottoman", "bench", "globe", every_m2=20.0),
        _wish("clock", "mirror", chance=0.8),
    ),
    "landing": (
        _wish("console table", "bench"),
        _wish("vase", "plant", "pedestal", spot="corner"),
        _wish("painting", count=2, every_m2=14.0),
        _wish("pedestal", "chest", "ottoman", spot="along a wall"),
        _wish("mirror", "clock"),
    ),
    "stairs": (),
}
"""Room kind → wishes, in the order in which they choose their places."""
