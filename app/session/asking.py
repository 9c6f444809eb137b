"""Asking a place: the errand from a click to the lane, off the worker's thread."""

from __future__ import annotations

from app.session import commands as c
from app.session.desk import Desk, Message
from app.session.placing import DepthSight, SceneSight, Sight, place_of, point_at
from app.session.snapshot import PlaceAnswer
from app.session.story import Story
from c2nav_engine.geometry import Point
from c2nav_engine.world.scene import Scene

GOAL_M = 0.5
"""The goal is asked for at this height above its foot point [C]."""


def ask_place(desk: Desk, command: c.Place) -> None:
    """Find the point that was meant, and where it was seen in the branch in view."""
    generation, story = desk.generation, desk.snapshot.story
    scene, sight = desk.scene, desk.sight
    desk.change(working="looking for that place")

    def task() -> Message:
        eye = sight or sight_for(scene, story)
        point_m = point_of(command, story, eye)
        answer = None if point_m is None else place_of(story, eye, point_m)
        return lambda desk: found(desk, generation, eye, answer)

    desk.hands.background(task)


def sight_for(scene: Scene | None, story: Story) -> Sight:
    """The scene where there is one, else the recorded depth."""
    return DepthSight(story.header.profile) if scene is None else SceneSight(scene)


def point_of(command: c.Place, story: Story, sight: Sight) -> Point | None:
    """The point a command means; None where there is nothing."""
    if command.point_m is not None:
        return command.point_m
    goal_m = story.header.episode.goal_m
    if command.goal and goal_m is not None:
        return (goal_m[0], goal_m[1] + GOAL_M, goal_m[2])
    if command.ray_from_m is not None and command.ray_along is not None:
        return sight.first_hit(command.ray_from_m, command.ray_along)
    if command.sha256:
        return point_at(story, sight, command.sha256, column=command.column, row=command.row)
    return None


def found(desk: Desk, generation: int, sight: Sight, answer: PlaceAnswer | None) -> None:
    """The answer came."""
    desk.change(working="")
    if generation != desk.generation:
        return
    if desk.scene is not None or isinstance(sight, SceneSight):
        desk.sight = sight
    if answer is None:
        desk.say("No surface there; without the scene only front views know their depth")
        return
    desk.change(place=answer)
