"""Candidate places: look-back budgets and Walk-Back markers (paper, "Look-Back, and Walk-Back")."""

from __future__ import annotations

from dataclasses import dataclass

from c2nav_engine.contract.question import Picture
from c2nav_engine.controller.config import ControllerConfig
from c2nav_engine.controller.odometer import planar_m
from c2nav_engine.geometry import Point, Pose


@dataclass(frozen=True, slots=True)
class PlaceMarker:
    """A rejected candidate place worth a second look.

    Attributes:
        odometry: Believed pose where the evidence was read.
        score: ground + journey.
        cycle: When it was left.
        path_m: Path at which it lies.
        lookback: The look-back frame that was current there; None when there was none.
    """

    odometry: Pose
    score: int
    cycle: int
    path_m: float
    lookback: Picture | None


@dataclass(slots=True)
class Place:
    """The disc around the first inspected frame of a candidate.

    Attributes:
        centre_m: Where the candidate was first inspected or marked.
        budget: Look-backs left.
        marker: Its marker, if it holds one.
        used: Whether a walk-back already returned here.
    """

    centre_m: Point
    budget: int
    marker: PlaceMarker | None = None
    used: bool = False


class Places:
    """All candidate places of an episode."""

    def __init__(self, config: ControllerConfig, lookback_budget: int) -> None:
        self._config = config
        self._budget = lookback_budget
        self._places: list[Place] = []

    def budget_at(self, position_m: Point) -> int:
        """Look-backs left for the candidate place here."""
        place = self._find(position_m)
        return self._budget if place is None else place.budget

    def spend(self, position_m: Point) -> None:
        """Use one look-back; the first one founds the place."""
        self._at(position_m).budget -= 1

    def grant(self, position_m: Point) -> None:
        """One more look-back, after a walk-back to here."""
        self._at(position_m).budget += 1

    def mark(self, marker: PlaceMarker) -> bool:
        """Leave a marker unless the place was used or holds a better one; True if it was left."""
        place = self._at(marker.odometry.position_m)
        if place.used or (place.marker is not None and place.marker.score > marker.score):
            return False
        place.marker = marker
        return True

    @property
    def markers(self) -> tuple[PlaceMarker, ...]:
        """Markers now held, oldest place first."""
        return tuple(place.marker for place in self._places if place.marker is not None)

    def best_marker(self, path_m: float) -> PlaceMarker | None:
        """The marker to walk back to after enough further travel: best score, then latest."""
        ripe = [
            marker
            for marker in self.markers
            if path_m - marker.path_m >= self._config.walkback_travel_m
        ]
        return max(ripe, key=lambda marker: (marker.score, marker.cycle), default=None)

    def use(self, marker: PlaceMarker) -> None:
        """A walk-back took up this marker; its place gets no other."""
        for place in self._places:
            if place.marker == marker:
                place.marker = None
                place.used = True

    def _find(self, position_m: Point) -> Place | None:
        near = [
            place
            for place in self._places
            if planar_m(place.centre_m, position_m) <= self._config.place_radius_m
        ]
        return min(near, key=lambda place: planar_m(place.centre_m, position_m), default=None)

    def _at(self, position_m: Point) -> Place:
        place = self._find(position_m)
        if place is None:
            place = Place(position_m, self._budget)
            self._places.append(place)
        return place
