"""Instructions from measured routes: one clause per leg, in varied words, without any number.

Every statement is read off the path: turns against the doors gone through, things passed with
their side, rooms by name. A text is kept only when the route parser finds exactly its legs.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from c2nav_engine.contract.route import parse_english
from c2nav_engine.world.builtin.house import House
from c2nav_engine.world.builtin.landmarks import Landmark, can_be_named, passed
from c2nav_engine.world.builtin.routes import Route, Visit

_SLIGHT_RAD, _CLEAR_RAD = math.radians(32.0), math.radians(58.0)
_INSIDE_M = 0.4
"""A leg into a room ends this far behind its door."""
_LAST_M = 1.6
"""Length of the last leg where the way through the last room is long enough to be split."""
_FEWEST_WORDS, _MOST_WORDS = 15, 38


@dataclass(frozen=True, slots=True)
class Leg:
    """One clause and the piece of path it stands for.

    Attributes:
        text: Without capital and full stop.
        end_m: Where on the path it ends.
    """

    text: str
    end_m: float


@dataclass(frozen=True, slots=True)
class Told:
    """A whole instruction.

    Attributes:
        text: What the robot is told.
        ends_m: Where on the path each leg ends.
    """

    text: str
    ends_m: tuple[float, ...]


def tell(
    house: House, route: Route, heading_rad: float, random: np.random.Generator
) -> Told | None:
    """Words for a route that starts with a heading; None when no try reads well."""
    for _ in range(12):
        legs = _Teller(house, route, random).legs(heading_rad)
        text = _sentences([leg.text for leg in legs], random)
        words = len(text.split())
        if not (2 <= len(legs) <= 5 and _FEWEST_WORDS <= words <= _MOST_WORDS):
            continue
        ends_m = tuple(leg.end_m for leg in legs)
        if len(parse_english(text).legs) == len(legs) and _rising(ends_m):
            return Told(text, ends_m)
    return None


def _rising(ends_m: tuple[float, ...]) -> bool:
    return all(b - a > 0.5 for a, b in zip((0.0, *ends_m), ends_m, strict=False))


def _sentences(legs: Sequence[str], random: np.random.Generator) -> str:
    """Join clauses into one to three sentences."""
    text = legs[0][0].upper() + legs[0][1:]
    for index, leg in enumerate(legs[1:], 1):
        last = index == len(legs) - 1
        choice = float(random.random())
        if last and choice < 0.45:
            text += f" and {leg}"
        elif choice < 0.3:
            text += f", then {leg}"
        elif choice < 0.42 and not last:
            text += f", and {leg}"
        elif choice < 0.6:
            text += f". Then {leg}"
        else:
            text += f". {leg[0].upper()}{leg[1:]}"
    return f"{text}."


class _Teller:
    """Writes one version of the legs."""

    def __init__(self, house: House, route: Route, random: np.random.Generator) -> None:
        self._house = house
        self._route = route
        self._random = random
        self._told: set[str] = {route.target.phrase}

    def legs(self, heading_rad: float) -> list[Leg]:
        """All legs, the first one with what the heading asks for."""
        visits = self._route.visits
        legs = [self._first(visits[0], visits[1], heading_rad)]
        index = 1
        while index < len(visits) - 1:
            visit, following = visits[index], visits[index + 1]
            merged = following.room.kind == "stairs" and visit.length_m < 2.6
            if merged:
                text = _turned(visit.turn_rad, self._stairs(following, visits[index + 2]))
                legs.append(Leg(text, following.leave_m + _INSIDE_M))
                index += 2
                continue
            legs.append(self._middle(visit, following, visits, index))
            index += 1
        return legs + self._last(visits[-1])

    def _one_of(self, *choices: str) -> str:
        return choices[int(self._random.integers(len(choices)))]

    def _first(self, visit: Visit, following: Visit, heading_rad: float) -> Leg:
        start_rad = self._route.trail.bearing_rad(0.0, 1.0)
        away = math.remainder(start_rad - heading_rad, math.tau)
        room, into = visit.room.name, following.room.name
        passage = _passage(following)
        choices = [
            f"walk out of the {room} into the {into}",
            f"leave the {room} and enter the {into}"
            if False
            else f"leave the {room} for the {into}",
            f"go from the {room} into the {into}",
            f"exit the {room} into the {into}",
        ]
        if passage:
            choices += [
                f"go through the {passage} into the {into}",
                f"take the {passage} out of the {room} into the {into}",
            ]
        if following.room.kind == "stairs":
            choices = [f"walk out of the {room} to the stairs", f"go to the stairs"]
        text = self._one_of(*choices)
        if visit.length_m > 2.2 and self._random.random() < 0.7:
            text += self._beside(visit, 1)
        if abs(away) > math.radians(140.0):
            text = self._one_of(f"turn around and {text}", f"turn around, and {text}")
        elif abs(away) > math.radians(50.0):
            side = "left" if away > 0 else "right"
            text = self._one_of(f"turn {side} and {text}", f"turn to your {side} and {text}")
        elif abs(away) < math.radians(25.0) and self._random.random() < 0.3:
            text = f"go straight ahead and {text}"
        return Leg(text, visit.leave_m + min(_INSIDE_M, 0.5 * following.length_m))

    def _middle(self, visit: Visit, following: Visit, visits: Sequence[Visit], index: int) -> Leg:
        room, into = visit.room, following.room
        end_m = visit.leave_m + min(_INSIDE_M, 0.5 * following.length_m)
        if room.kind == "stairs":
            return Leg(self._stairs(visit, following), end_m)
        if visit.length_m < 2.3:
            straight = abs(visit.turn_rad) < _SLIGHT_RAD
            if into.kind == "stairs":
                text = f"go to the stairs"
            elif straight:
                text = self._one_of(
                    f"cross the {room.name} into the {into.name}",
                    f"go straight across the {room.name} into the {into.name}",
                )
            else:
                text = self._one_of(f"enter the {into.name}", f"go into the {into.name}")
                text += self._exit_side(visit)
            return Leg(_turned(visit.turn_rad, text), end_m)
        verb = self._one_of("walk", "go", "continue", "head", "move", "walk")
        way = "through"
        if room.kind in {"hallway", "landing"}:
            way = self._one_of("down", "along", "down") if room.kind == "hallway" else "along"
        elif room.kind not in {"bathroom"}:
            way = self._one_of("through", "across")
        text = f"{verb} {way} the {room.name}"
        text += self._beside(visit, 2 if visit.length_m > 5.0 else 1)
        if into.kind == "stairs":
            text += self._one_of(" to the stairs", " to the foot of the stairs")
        else:
            text += self._one_of(f" into the {into.name}", f" and into the {into.name}")
            text += self._exit_side(visit)
        return Leg(_turned(visit.turn_rad, text), end_m)

    def _stairs(self, visit: Visit, following: Visit) -> str:
        trail = self._route.trail
        upward = trail.at(visit.leave_m)[1] > trail.at(visit.enter_m)[1]
        to = following.room.name
        if upward:
            return self._one_of(
                f"climb the stairs to the {to}",
                f"walk up the stairs to the {to}",
                f"go up the stairs to the {to}",
            )
        return self._one_of(f"go down the stairs to the {to}", f"walk down the stairs to the {to}")

    def _exit_side(self, visit: Visit) -> str:
        side_rad = visit.exit_side_rad
        if abs(side_rad) > _CLEAR_RAD:
            side = "left" if side_rad > 0 else "right"
            return self._one_of(f" on your {side}", f" on the {side}")
        if abs(side_rad) < _SLIGHT_RAD and self._random.random() < 0.4:
            return self._one_of(" straight ahead", " ahead of you")
        return ""

    def _last(self, visit: Visit) -> list[Leg]:
        trail, target = self._route.trail, self._route.target
        hung = target.top_m > 1.3 and target.bottom_m > 0.5
        stop = self._one_of("stop", "stop", "wait", "stop")
        where = (
            self._one_of("in front of", "in front of", "facing")
            if hung
            else self._one_of("in front of", "next to", "beside", "by", "at")
        )
        if where == "facing":
            where = "in front of"
        stopping = f"{stop} {where} the {target.phrase}"
        if visit.length_m < 3.6:
            return [Leg(_turned(visit.turn_rad, stopping), trail.length_m)]
        verb = self._one_of("walk", "go", "continue", "head")
        way = self._one_of("across", "through")
        if visit.room.kind in {"hallway", "landing"}:
            way = self._one_of("down", "along")
        text = f"{verb} {way} the {visit.room.name}" + self._beside(visit, 2)
        return [
            Leg(_turned(visit.turn_rad, text), trail.length_m - _LAST_M),
            Leg(stopping, trail.length_m),
        ]

    def _beside(self, visit: Visit, most: int) -> str:
        """Words for up to so many things passed in a room, in their order."""
        fresh = [
            each
            for each in passed(self._house, self._route.trail, visit)
            if each.item.phrase not in self._told
        ]
        chosen = sorted(fresh[:most], key=lambda each: each.along_m)
        if not chosen:
            return ""
        self._told |= {each.item.phrase for each in chosen}
        if len(chosen) == 1 and chosen[0].side and self._random.random() < 0.25:
            return f" with the {_with_side(chosen[0])}"
        opening = self._one_of(" past ", " past ", ", passing ")
        return opening + " and ".join(f"the {_with_side(each)}" for each in chosen)


def _with_side(landmark: Landmark) -> str:
    side = f" on your {landmark.side}" if landmark.side else ""
    return f"{landmark.item.phrase}{side}"


def _turned(turn_rad: float, text: str) -> str:
    """The clause after the turn that the door asks for."""
    side = "left" if turn_rad > 0 else "right"
    if abs(turn_rad) > _CLEAR_RAD:
        return f"turn {side} and {text}"
    if abs(turn_rad) > _SLIGHT_RAD:
        return f"turn slightly {side} and {text}"
    return text


def _passage(visit: Visit) -> str:
    """What one walks through into a room; "" where there is no wall."""
    if visit.entry is None or visit.entry.kind == "open":
        return ""
    kinds = {opening.kind for opening in visit.entry.openings if opening.bottom_m == 0.0}
    return "archway" if "arch" in kinds else "doorway"


def nameable_target(house: House, route: Route) -> bool:
    """Whether the goal's words mean one thing only in its room."""
    return can_be_named(house, route.target)
