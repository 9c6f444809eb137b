"""Remembering: the route sketch, and the contrast between this leg and the next."""

from c2nav_engine.faculties.remembering.sketch import RouteSketch, SketchEntry, turning_word
from c2nav_engine.faculties.remembering.transition import TransitionRule, transition_question

__all__ = [
    "RouteSketch",
    "SketchEntry",
    "TransitionRule",
    "transition_question",
    "turning_word",
]
