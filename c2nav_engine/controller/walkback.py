"""The way back: retracing odometry with normal actions."""

from __future__ import annotations

import math

from c2nav_engine.controller.config import ControllerConfig
from c2nav_engine.controller.odometer import Odometer, planar_m
from c2nav_engine.controller.places import PlaceMarker
from c2nav_engine.controller.sensed import Action
from c2nav_engine.controller.turning import turns
from c2nav_engine.geometry import Point, wrap_rad

_WAYPOINT_REACH_M = 0.3
"""A recorded point counts as passed within this distance: a little over one step."""


class Return:
    """One walk-back, planned a few actions at a time from the believed pose.

    Attributes:
        marker: Where it leads.
        reached: Whether the body stands within reach of the marker.
        abandoned: Why the return was given up; "" while it goes on.
    """

    def __init__(
        self,
        marker: PlaceMarker,
        odometer: Odometer,
        *,
        step_m: float,
        turn_rad: float,
        config: ControllerConfig,
    ) -> None:
        self.marker = marker
        self.reached = False
        self.abandoned = ""
        self._odometer = odometer
        self._step_m = step_m
        self._turn_rad = turn_rad
        self._config = config
        self._waypoints_m: list[Point] = [
            pose.position_m for pose, path_m in odometer.trail if path_m >= marker.path_m - 1e-9
        ]
        self._limit_m = config.walkback_stretch * (odometer.path_m - marker.path_m)
        self._started_m = odometer.travelled_m
        self._collisions = 0

    def next_actions(self) -> tuple[Action, ...]:
        """Turns and forward steps towards the next recorded point; () once it is over."""
        here = self._odometer.pose
        goal_m = self.marker.odometry.position_m
        if planar_m(here.position_m, goal_m) <= self._config.walkback_reach_m:
            self.reached = True
            return ()
        self._check_limits()
        if self.abandoned:
            return ()
        while (
            len(self._waypoints_m) > 1
            and planar_m(here.position_m, self._waypoints_m[-1]) <= _WAYPOINT_REACH_M
        ):
            self._waypoints_m.pop()
        target_m = self._waypoints_m[-1] if self._waypoints_m else goal_m
        aim = turns(here.bearing_rad(target_m), self._turn_rad)
        distance_m = planar_m(here.position_m, target_m)
        count = min(self._config.bundle_steps, max(1, math.floor(distance_m / self._step_m)))
        return (*aim, *(Action.FORWARD,) * count)

    def executed(self, *, collided: bool) -> None:
        """Report whether the last actions ended in a collision."""
        self._collisions += collided

    def facing(self) -> tuple[Action, ...]:
        """Turns to the marker's heading, once reached."""
        left_rad = wrap_rad(self.marker.odometry.yaw_rad - self._odometer.pose.yaw_rad)
        return turns(left_rad, self._turn_rad)

    def _check_limits(self) -> None:
        walked_m = self._odometer.travelled_m - self._started_m
        if self._collisions >= self._config.walkback_collisions:
            self.abandoned = f"{self._collisions} collisions on the way back"
        elif walked_m > self._limit_m:
            self.abandoned = f"walked {walked_m:.1f} m of at most {self._limit_m:.1f} m"
