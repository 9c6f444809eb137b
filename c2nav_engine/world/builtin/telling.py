"""Clauses for the legs of one route, read off the path: turns, rooms, things passed, the end."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from c2nav_engine.world.builtin.house import House
from c2nav_engine.world.builtin.landmarks import Landmark, passed
from c2nav_engine.world.builtin.routes import Route, Visit

_SLIGHT_RAD, _CLEAR_RAD = math.radians(25.0), math.radians(58.0)
_INSIDE_M = 0.4
"""A leg into a room ends this far behind its door."""
_LONG_M = 5.5
"""A way through one room longer than this is told in two legs where it can be."""
_LAST_M = 1.6
"""Length of the last leg where the way through the last room is long enough to be split."""
_FAR_END_M = 7.0
"""No last leg is longer than this: a tenth of real ones is longer than some 5.4 m."""
_WAYS: dict[str, tuple[str, ...]] = {
    "hallway": ("down", "along", "down"),
    "landing": ("along", "across"),
}
"""How one moves through rooms that are ways themselves; any other room is crossed."""


@dataclass(frozen=True, slots=True)
class Leg:
    """One clause and the piece of path it stands for.

    Attributes:
        text: Without capital and full stop.
        end_m: Where on the path it ends.
    """

    text: str
    end_m: float


class Teller:
    """Writes one version of the legs."""

    def __init__(self, house: House, route: Route, random: np.random.Generator) -> None:
        self._house = house
        self._route = route
        self._random = random
        self._told: set[str] = {route.target.phrase}

    def legs(self, heading_rad: float, *, far_end: bool) -> list[Leg]:
        """All legs, the first one with what the heading asks for.

        A far end is told in one leg with the way to it, so that the last leg begins some rooms
        or metres before the goal; a near one is a stop clause of its own.
        """
        visits = self._route.visits
        legs = [self._first(visits[0], visits[1], heading_rad)]
        index = 1
        while index < len(visits) - 1:
            visit, following = visits[index], visits[index + 1]
            if following.room.kind == "stairs" and visit.length_m < 2.6:
                # A few steps to the stairs are no leg of their own.
                text = self._stairs(following, visits[index + 2])
                legs.append(Leg(_turned(visit.turn_rad, text), following.leave_m + _INSIDE_M))
                index += 2
            else:
                legs += self._middle(visit, following)
                index += 1
        legs += self._last(visits[-1])
        if far_end and len(legs) > 2 and legs[-1].end_m - legs[-3].end_m < _FAR_END_M:
            *before, way, stop = legs
            return [*before, Leg(way.text + self._onto_goal(visits[-1]), stop.end_m)]
        return legs

    def _onto_goal(self, visit: Visit) -> str:
        """Words that carry a clause on to the goal, a third of them without a stop."""
        side = ""
        if abs(visit.turn_rad) > _CLEAR_RAD:
            side = f" on your {'left' if visit.turn_rad > 0 else 'right'}"
        onward = self._one_of("and on to", "and over to")
        stop = self._one_of("", " and stop there", " and wait there")
        return f" {onward} the {self._route.target.phrase}{side}{stop}"

    def _one_of(self, *choices: str) -> str:
        return choices[int(self._random.integers(len(choices)))]

    def _first(self, visit: Visit, following: Visit, heading_rad: float) -> Leg:
        away = math.remainder(self._route.trail.bearing_rad(0.0, 1.0) - heading_rad, math.tau)
        if visit.room.kind in _WAYS and visit.length_m > 2.5:
            text = self._along(visit, following).replace("continue", "go", 1)
        else:
            text = self._out_of(visit, following)
        if abs(away) > math.radians(140.0):
            text = f"turn around and {text}"
        elif abs(away) > math.radians(50.0):
            side = "left" if away > 0 else "right"
            text = self._one_of(f"turn {side} and {text}", f"turn to your {side} and {text}")
        return Leg(text, _end_of(visit, following))

    def _out_of(self, visit: Visit, following: Visit) -> str:
        """Words for leaving the first room."""
        room = visit.room.name
        if following.room.kind == "stairs":
            return self._one_of("walk to the stairs", "head to the stairs")
        into = _into(following)
        beside = ""
        if visit.length_m > 2.2 and self._random.random() < 0.8:
            beside = self._beside(visit, 1)
        choices = [f"walk out of the {room} {into}", f"exit the {room} {into}"]
        if visit.room.kind in _WAYS:
            choices = [f"go from the {room} {into}", f"walk from the {room} {into}"]
        if beside:
            choices = [f"walk{beside} and {into}", f"go{beside} and {into}"]
        elif following.entry is not None and _passage(following):
            way = _passage(following)
            choices += [
                f"go through the {way} {into}",
                f"leave the {room} through the {way} {into}",
            ]
        return self._one_of(*choices)

    def _middle(self, visit: Visit, following: Visit) -> list[Leg]:
        end_m = _end_of(visit, following)
        if visit.room.kind == "stairs":
            return [Leg(self._stairs(visit, following), end_m)]
        if visit.length_m >= 2.3:
            return self._through(visit, following, end_m)
        if following.room.kind == "stairs":
            text = "go to the stairs"
        elif abs(visit.turn_rad) < _SLIGHT_RAD:
            text = self._one_of("cross", "go straight across", "walk straight across")
            text += f" the {visit.room.name} {_into(following)}"
        else:
            text = self._one_of("go", "walk") + f" {_into(following)}" + self._exit_side(visit)
        return [Leg(_turned(visit.turn_rad, text), end_m)]

    def _through(self, visit: Visit, following: Visit, end_m: float) -> list[Leg]:
        """The way through a room, in two legs where something stands between them."""
        bent = abs(visit.bend_rad) > _CLEAR_RAD
        first = self._halfway(visit) if visit.length_m > _LONG_M and not bent else None
        if first is None:
            return [Leg(_turned(visit.turn_rad, self._along(visit, following)), end_m)]
        self._told.add(first.item.phrase)
        text = self._onward(visit, "walk", "go", "head")
        text += f" to the {first.item.phrase} on your {first.side}"
        onward = self._one_of("continue", "keep going", "go on") + f" {_into(following)}"
        onward += self._exit_side(visit)
        return [Leg(_turned(visit.turn_rad, text), first.along_m), Leg(onward, end_m)]

    def _halfway(self, visit: Visit) -> Landmark | None:
        """Something beside the middle of a long way."""
        for each in passed(self._house, self._route.trail, visit):
            share = (each.along_m - visit.enter_m) / visit.length_m
            if each.side and 0.3 < share < 0.75 and each.item.phrase not in self._told:
                return each
        return None

    def _onward(self, visit: Visit, *verbs: str) -> str:
        """Words for moving through a room, around its corner where it has one."""
        if visit.room.kind in _WAYS and abs(visit.bend_rad) > _CLEAR_RAD:
            side = "left" if visit.bend_rad > 0 else "right"
            return f"follow the {visit.room.name} around to the {side}"
        way = self._one_of(*_WAYS.get(visit.room.kind, ("through", "across")))
        return f"{self._one_of(*verbs)} {way} the {visit.room.name}"

    def _along(self, visit: Visit, following: Visit) -> str:
        """Words for the way through a room or corridor to the next one."""
        text = self._onward(visit, "walk", "go", "continue", "head", "walk")
        beside = self._beside(visit, 2 if visit.length_m > 4.5 else 1)
        if following.room.kind == "stairs":
            return text + beside + self._one_of(" to the stairs", " over to the stairs")
        joint = " and " if beside else " "
        return text + beside + joint + _into(following) + self._exit_side(visit)

    def _stairs(self, visit: Visit, following: Visit) -> str:
        trail = self._route.trail
        upward = trail.at(visit.leave_m)[1] > trail.at(visit.enter_m)[1]
        verbs = ("climb", "walk up", "go up") if upward else ("go down", "walk down", "descend")
        return f"{self._one_of(*verbs)} the stairs to the {following.room.name}"

    def _exit_side(self, visit: Visit) -> str:
        side_rad = visit.exit_side_rad
        if abs(side_rad) > _CLEAR_RAD:
            side = "left" if side_rad > 0 else "right"
            return self._one_of(f" on your {side}", f" on the {side}")
        if abs(side_rad) < _SLIGHT_RAD and self._random.random() < 0.3:
            return " straight ahead"
        return ""

    def _last(self, visit: Visit) -> list[Leg]:
        trail, target = self._route.trail, self._route.target
        verb = self._one_of("stop", "stop", "stop", "wait")
        where = "in front of"
        if target.bottom_m == 0.0:
            where = self._one_of("in front of", "in front of", "next to", "beside", "by")
        stopping = f"{verb} {where} the {target.phrase}"
        if visit.length_m < 3.6:
            return [Leg(_turned(visit.turn_rad, stopping), trail.length_m)]
        text = self._onward(visit, "walk", "go", "continue", "head") + self._beside(visit, 2)
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
        if not fresh or self._random.random() < 0.12:
            return ""
        beside = [each for each in fresh if each.side] or fresh[:1]
        chosen = sorted(beside[:most], key=lambda each: each.along_m)
        self._told |= {each.item.phrase for each in chosen}
        if not chosen[0].side:
            return f" over the {chosen[0].item.phrase}"
        if len(chosen) == 2 and chosen[0].side == chosen[1].side:
            names = " and ".join(f"the {each.item.phrase}" for each in chosen)
            return f" past {names} on your {chosen[0].side}"
        return " past " + " and ".join(
            f"the {each.item.phrase} on your {each.side}" for each in chosen
        )


def _turned(turn_rad: float, text: str) -> str:
    """The clause after the turn that the door asks for."""
    side = "left" if turn_rad > 0 else "right"
    if abs(turn_rad) > _CLEAR_RAD:
        return f"turn {side} and {text}"
    if abs(turn_rad) > _SLIGHT_RAD:
        return f"turn slightly {side} and {text}"
    return text


def _end_of(visit: Visit, following: Visit) -> float:
    return visit.leave_m + min(_INSIDE_M, 0.5 * following.length_m)


def _into(visit: Visit) -> str:
    """Words for entering a room."""
    return f"{'onto' if visit.room.kind == 'landing' else 'into'} the {visit.room.name}"


def _passage(visit: Visit) -> str:
    """What one walks through into a room; "" where there is no wall."""
    if visit.entry is None or visit.entry.kind == "open":
        return ""
    kinds = {opening.kind for opening in visit.entry.openings if opening.bottom_m == 0.0}
    return "archway" if "arch" in kinds else "doorway"
