"""When Seeing must re-anchor: the histories behind a Junction Glance."""

from __future__ import annotations

from itertools import pairwise

from c2nav_engine.contract.outcome import Key
from c2nav_engine.controller.config import ControllerConfig
from c2nav_engine.controller.odometer import planar_m
from c2nav_engine.geometry import Point


class SeeingHistory:
    """Elections and displacement since the last glance or walk-back.

    Attributes:
        no_ordering: Elections in a row that gave no ordering.
        elected: Keys elected, None where an election gave no ordering.
        last_glance_cycle: Cycle of the last glance; None before the first.
    """

    def __init__(self, start_m: Point) -> None:
        self.last_glance_cycle: int | None = None
        self.first_of_leg = True
        self.restart(start_m)

    def restart(self, position_m: Point) -> None:
        """Forget everything but when the last glance was."""
        self.no_ordering = 0
        self.elected: list[Key | None] = []
        self._positions_m: list[Point] = [position_m]

    def election(self, key: Key | None) -> None:
        """An election ended with this winner, or with no ordering."""
        self.elected.append(key)
        self.no_ordering = self.no_ordering + 1 if key is None else 0
        self.first_of_leg = False

    def cycle_ended(self, position_m: Point) -> None:
        """One cycle is over; the body stands here."""
        self._positions_m.append(position_m)

    def contested(self, survivors: int) -> str:
        """Why an election now must ask every cyclic order; "" when once is enough [C]."""
        if survivors < 2:
            return ""
        if self.first_of_leg:
            return "first election of a leg"
        if self.elected and self.elected[-1] is None:
            return "the previous election gave no ordering"
        if tuple(self.elected[-2:]) in {("left", "right"), ("right", "left")}:
            return "the previous election changed sides"
        return ""

    def glance_reason(self, cycle: int, *, survivors: int, config: ControllerConfig) -> str:
        """Why a glance is due in this cycle; "" when it is not."""
        if survivors == 0:
            return "no view has enough free space"
        if (
            self.last_glance_cycle is not None
            and cycle - self.last_glance_cycle <= config.glance_rest_cycles
        ):
            return ""
        if self.no_ordering >= config.no_ordering_glance:
            return "elections in a row gave no ordering"
        if self._stuck(config):
            return "too little displacement over the last cycles"
        if self._alternates(config.alternations):
            return "elections alternate between left and right"
        return ""

    def _stuck(self, config: ControllerConfig) -> bool:
        if len(self._positions_m) <= config.stuck_cycles:
            return False
        then_m = self._positions_m[-1 - config.stuck_cycles]
        return planar_m(then_m, self._positions_m[-1]) < config.stuck_m

    def _alternates(self, count: int) -> bool:
        tail = self.elected[-count:]
        if len(tail) < count or set(tail) != {"left", "right"}:
            return False
        return all(a != b for a, b in pairwise(tail))
