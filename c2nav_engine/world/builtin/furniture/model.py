"""What a maker of furniture gets and gives."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np

from c2nav_engine.world.builtin.mesh import Solid


@dataclass(frozen=True, slots=True)
class Tones:
    """What varies between two things of one kind.

    Attributes:
        colour: A colour word of the palette, for what gives the thing its name.
        wood: A wood of the palette, for frames and legs.
        variant: Any number: makers use it to choose among shapes.
    """

    colour: str
    wood: str = "oak"
    variant: int = 0


@dataclass(frozen=True, slots=True, eq=False)
class Model:
    """A finished thing in its own frame, centred on its footprint.

    Attributes:
        solids: What it is built of.
        width_m: Along x.
        height_m: Top above the floor.
        depth_m: Along z.
    """

    solids: tuple[Solid, ...]
    width_m: float
    height_m: float
    depth_m: float


Maker = Callable[[Tones], list[Solid]]


def model_of(solids: Iterable[Solid]) -> Model:
    """Centre solids on their common footprint and measure them."""
    solids = tuple(solids)
    points = np.concatenate([solid.vertices_m for solid in solids])
    low, high = points.min(axis=0), points.max(axis=0)
    middle = (low + high) / 2.0
    offset = np.array((-middle[0], 0.0, -middle[2]))
    moved = tuple(replace(solid, vertices_m=solid.vertices_m + offset) for solid in solids)
    width_m, depth_m = float(high[0] - low[0]), float(high[2] - low[2])
    return Model(moved, width_m, float(high[1]), depth_m)


def mirrored(x: float, z: float) -> tuple[tuple[float, float], ...]:
    """The four (x, z) corners around the origin: legs, posts, castors."""
    return ((-x, -z), (x, -z), (x, z), (-x, z))
