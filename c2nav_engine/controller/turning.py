"""Angles as whole turns."""

from __future__ import annotations

from c2nav_engine.controller.sensed import Action
from c2nav_engine.geometry import wrap_rad


def turns(left_rad: float, turn_rad: float) -> tuple[Action, ...]:
    """The turn actions nearest to an angle, the short way round."""
    count = round(wrap_rad(left_rad) / turn_rad)
    return (Action.LEFT if count > 0 else Action.RIGHT,) * abs(count)
