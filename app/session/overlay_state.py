"""What can be laid over the map on demand."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from c2nav_engine.world.connectivity import ConnectivityGraph


@dataclass(frozen=True, slots=True, eq=False)
class Overlays:
    """What was loaded so far for the episode that is open.

    Attributes:
        floor_m: The walkable surface as triangles, world frame.
        viewpoints: The panoramas of the scan and the ways between them.
    """

    floor_m: Float[np.ndarray, "n 3 3"] | None = None
    viewpoints: ConnectivityGraph | None = None

    def joined(self, more: Overlays) -> Overlays:
        """With what came in addition."""
        floor_m = self.floor_m if more.floor_m is None else more.floor_m
        return Overlays(floor_m, more.viewpoints or self.viewpoints)


NO_OVERLAYS = Overlays()
