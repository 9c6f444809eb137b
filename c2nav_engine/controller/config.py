"""Every threshold of the physical side, in one frozen value.

The paper leaves the figures open; each is a default [C] that a user can change, and none is tuned
to the paper's results.
"""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ControllerConfig:
    """Thresholds of geometry and motion; all [C].

    Attributes:
        free_needed_m: A view with less free space is removed before the query.
        bundle_steps: Most forward steps after one election.
        bundle_margin_m: A bundle ends at least this short of the free space.
        collision_forget_m: A collision blocks its heading until this much is travelled.
        stuck_cycles: Cycles over which net displacement is judged.
        stuck_m: Under this net displacement the robot re-anchors.
        no_ordering_glance: Elections in a row without an ordering before a glance.
        alternations: Elections that must alternate left and right before a glance.
        glance_rest_cycles: No second glance within so many cycles.
        glance_memory_m: Sectors chosen within this distance are not offered again.
        stall_fallbacks: Fallback cycles in a row that end the episode as `stalled`.
        veto_median_m: Median front depth under which a stop is implausible.
        veto_holes: Fraction of depth holes above which a stop is implausible.
        place_radius_m: Radius of a candidate place around its first inspected frame.
        walkback_travel_m: Further travel after which a marker may call the robot back.
        walkback_negatives: Cycles in a row with ground = −1 that call it back.
        walkback_reach_m: Distance to the marker that counts as reached.
        walkback_collisions: Collisions after which the return is given up.
        walkback_stretch: Return given up after this multiple of the recorded path.
        walkbacks: Most walk-backs in an episode.
    """

    free_needed_m: float = 0.5
    bundle_steps: int = 3
    bundle_margin_m: float = 0.2
    collision_forget_m: float = 0.5
    stuck_cycles: int = 4
    stuck_m: float = 0.5
    no_ordering_glance: int = 2
    alternations: int = 4
    glance_rest_cycles: int = 2
    glance_memory_m: float = 0.25
    stall_fallbacks: int = 12
    veto_median_m: float = 0.35
    veto_holes: float = 0.6
    place_radius_m: float = 1.5
    walkback_travel_m: float = 1.5
    walkback_negatives: int = 2
    walkback_reach_m: float = 0.5
    walkback_collisions: int = 3
    walkback_stretch: float = 2.0
    walkbacks: int = 2


@dataclass(frozen=True, slots=True)
class GateConfig:
    """Progress gates that decide when a faculty may be asked at all; all [C].

    Attributes:
        transition_m: Travel in the leg before Transition is asked.
        transition_cycles: Cycles in the leg before Transition is asked.
        transition_support: Supports in a row that advance the route.
        blind_leg_cycles: `no-transition`: cycles past the gate after which a leg ends.
        arriving_m: Travel in the episode before Arriving is asked.
        arriving_leg_m: Travel in the last leg before Arriving is asked.
        lookback_m: Path distance behind at which the look-back frame lies, at least.
        lookback_budget: Look-backs per candidate place.
        basic_stop_run: Basic stop: cycles in a row with ground = +1.
        progress_support: `transition-cardinal`: progress that counts as a support.
    """

    transition_m: float = 0.75
    transition_cycles: int = 1
    transition_support: int = 2
    blind_leg_cycles: int = 6
    arriving_m: float = 2.0
    arriving_leg_m: float = 0.5
    lookback_m: float = 2.0
    lookback_budget: int = 3
    basic_stop_run: int = 2
    progress_support: float = 80.0


TURN_WORD_LIMITS_RAD = (math.radians(22.5), math.radians(67.5), math.radians(135.0))
"""Net yaw of a cycle: straight below the first, a turn below the second, sharp below the third."""
