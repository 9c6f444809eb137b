"""The questions of Seeing, Gaze Election and Junction Glance, and how their answers are read.

Paper, "Seeing: Gaze Election and Re-anchoring".
"""

from __future__ import annotations

from collections.abc import Mapping

from c2nav_engine.contract import slots
from c2nav_engine.contract.outcome import Answered, Key, Ordering
from c2nav_engine.contract.question import Orders, Picture, Question
from c2nav_engine.contract.slots import Route


def gaze(
    route: Route,
    views: Mapping[Key, Picture],
    *,
    contested: bool,
    seed: int,
    headings_deg: Mapping[Key, float] | None = None,
) -> Question:
    """Rank the surviving views by how well they continue the active leg.

    Args:
        route: What every question says about the route.
        views: The survivors, in canonical order.
        contested: Whether to ask every cyclic order.
        seed: Presentation seed.
        headings_deg: Given, the same pictures are captioned and a heading is asked for instead
            (spatial role inversion), once.
    """
    orders = Orders.CYCLIC if contested else Orders.ONCE
    question = slots.seeing(route, views, seed=seed, orders=orders)
    return question if headings_deg is None else slots.spatial_cardinal(question, headings_deg)


def glance(
    route: Route,
    sectors: Mapping[Key, Picture],
    *,
    seed: int,
    headings_deg: Mapping[Key, float] | None = None,
) -> Question:
    """Rank the surviving sectors of the ring by the same query."""
    question = slots.glance(route, sectors, seed=seed)
    return question if headings_deg is None else slots.spatial_cardinal(question, headings_deg)


def winner_of(answered: Answered) -> Key | None:
    """The elected key; None for everything that is no ordering."""
    return answered.winner if isinstance(answered, Ordering) else None
