"""One heading read from near to far: the floor is followed, and whatever ends the travel is found.

The floor starts at the foot and follows every rise and fall that the body takes, so stairs are free
both up and down. Travel ends

- where the body would touch a point between its climb and its height above that floor;
- where the floor falls away more steeply than stairs do: a stair-well;
- where the camera must have seen a floor and saw none, but saw one again beyond: a hole.

Close to the foot the camera sees no floor, so a stretch without points counts as free there; and
what is first seen behind such a stretch may be a step whose lower neighbours are hidden. It is
taken for one if it goes on rising like stairs, else for an obstacle. Stairs that descend steeper
than the camera looks are hidden altogether: between free and blocked, doubt falls for free, because
a blocked way is never tried and a wrong step only ends in a collision.
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from c2nav_engine.episodes.profile import Profile


@dataclass(frozen=True, slots=True)
class FreeSpaceConfig:
    """How depth is remembered and read; all [C].

    Attributes:
        memory_m: Travel after which a point is forgotten.
        voxel_m: One point is kept per cube of this side.
        max_range_m: Free space is never reported beyond this.
        slice_m: The strip ahead is read in slices of this depth.
        tolerance_m: Heights differ by this much through sampling and noise.
        stairs_rad: Steepest flight of stairs; a floor that falls away faster is a drop.
        hole_m: A visible stretch without floor that is longer than this is a hole.
        proof_climbs: What is first seen as a high step must rise by this many climbs more.
    """

    memory_m: float = 3.0
    voxel_m: float = 0.05
    max_range_m: float = 3.0
    slice_m: float = 0.05
    tolerance_m: float = 0.02
    stairs_rad: float = math.radians(40.0)
    hole_m: float = 0.5
    proof_climbs: float = 1.5


class StripWalk:
    """The floor followed slice by slice, until something ends the travel.

    Attributes:
        free_m: Where the travel ends; inf until something ends it.
        seen_m: The farthest point below the body's top so far.
    """

    def __init__(self, profile: Profile, config: FreeSpaceConfig, floor_m: float) -> None:
        """Nothing is read yet.

        Args:
            profile: The body and its camera.
            config: Thresholds.
            floor_m: Height of the floor under the foot.
        """
        self._profile = profile
        self._config = config
        self._climb_m = profile.climb_m + config.tolerance_m
        half_view = math.atan2(profile.depth.height_px / 2.0, profile.depth.focal_px)
        self._blind_m = profile.camera_height_m / math.tan(half_view)
        # A rise of one climb over this length is as steep as the floor may be.
        self._ramp_m = profile.climb_m / math.tan(profile.slope_rad)
        self._floors_m = [(0.0, floor_m)]  # (distance ahead, height)
        self._doubt: tuple[float, float] | None = None  # (its distance, the height that proves it)
        self._travel_m = math.inf
        self.seen_m = 0.0

    @property
    def free_m(self) -> float:
        """A step that was never proved to be one is an obstacle."""
        return self._travel_m if self._doubt is None else min(self._travel_m, self._doubt[0])

    def enter(self, part: Float[np.ndarray, "n 3"]) -> bool:
        """Read the next slice; False where the travel ends.

        Args:
            part: Rows of (distance ahead, height, distance when touched), by rising height.
        """
        ahead_m = float(part[:, 0].mean())
        if ahead_m - self._profile.radius_m - self._config.slice_m > self._travel_m:
            return False
        heights_m: list[float] = part[:, 1].tolist()
        base_m = self._base_m(ahead_m, part)
        low = bisect_right(heights_m, base_m + self._climb_m)
        high = bisect_left(heights_m, base_m + self._profile.height_m - self._config.tolerance_m)
        if high > 0:
            self.seen_m = float(part[:high, 0].max())
        blocked = high > low
        if blocked:
            self._travel_m = min(self._travel_m, float(part[low:high, 2].min()))
        if low == 0:
            return True
        return self._follow(heights_m[:low], ahead_m, blocked=blocked)

    def _base_m(self, ahead_m: float, part: Float[np.ndarray, "n 3"]) -> float:
        """Height above which a rise counts, for a slice so far ahead."""
        before_m, last_m = self._floors_m[-1]
        recent = [height for at, height in self._floors_m if at >= ahead_m - self._ramp_m]
        floor_m, lowest_m = min([last_m, *recent]), float(part[0, 1])
        if lowest_m <= floor_m + self._climb_m:
            # The foot of a riser stands on its own tread, however sparsely that was seen.
            return max(floor_m, lowest_m)
        hidden_m = max(0.0, min(ahead_m, self._blind_m) - before_m)
        stairs_m = self._climb_m + hidden_m * math.tan(self._config.stairs_rad)
        if lowest_m - floor_m <= min(stairs_m, self._profile.height_m):
            if self._doubt is None:
                proof_m = lowest_m + self._config.proof_climbs * self._profile.climb_m
                self._doubt = (float(part[:, 2].min()), proof_m)
            return lowest_m
        return floor_m

    def _follow(self, heights_m: list[float], ahead_m: float, *, blocked: bool) -> bool:
        """Step to the floor of the next slice; False if no floor leads there."""
        before_m, floor_m = self._floors_m[-1]
        next_m = heights_m[-1]
        if blocked:
            # A face that rises out of this slice stands on its lowest point or below.
            next_m = _run_bottom(heights_m, self._climb_m)
        fall_m = floor_m - next_m
        gap_m = ahead_m - before_m
        unseen_m = ahead_m - max(before_m, self._blind_m)
        falls_away = fall_m > self._climb_m + gap_m * math.tan(self._config.stairs_rad)
        missing = not blocked and unseen_m > self._config.hole_m and fall_m <= self._climb_m
        if falls_away or missing:
            self._travel_m = min(self._travel_m, before_m - self._profile.radius_m)
            return False
        if not blocked:
            self._floors_m.append((ahead_m, next_m))
            if self._doubt is not None and next_m >= self._doubt[1]:
                self._doubt = None
        return True


def _run_bottom(heights_m: list[float], gap_m: float) -> float:
    """The lowest of rising heights that hangs together with the highest."""
    bottom_m = heights_m[-1]
    for height_m in reversed(heights_m):
        if bottom_m - height_m > gap_m:
            break
        bottom_m = height_m
    return bottom_m
