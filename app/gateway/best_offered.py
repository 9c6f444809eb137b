"""The geodesically best alternative of recorded questions: privileged, for completed studies."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from app.reviews.answers import Answers
from app.session.assessing import assessor_of
from app.session.opened import Choice, Opened
from app.session.story import story_of
from c2nav_engine.contract.outcome import Key


def best_of(opened: Opened, entry_of: Mapping[Path, str], answers: Answers) -> dict[str, Key]:
    """Question → the offered alternative whose bundle ends nearest to the goal.

    Only questions that people answered, or all where nobody did; a question that was asked in
    several traces is held against the first, because its pictures are the same.

    Args:
        opened: What the inspector is open on.
        entry_of: Trace → entry.
        answers: What was answered.

    Raises:
        C2NavError: A trace or its scene cannot be read.
    """
    judged = {answer.question for answer in answers.given if answer.rater.human}
    wanted: dict[Path, dict[int, str]] = {}
    for question, places in answers.places.items():
        if question in judged or not judged:
            first = places[0]
            wanted.setdefault(first.trace.resolve(), {})[first.decision] = question
    found: dict[str, Key] = {}
    for trace, questions in wanted.items():
        if trace in entry_of:
            best = _best_in(opened, entry_of[trace])
            found |= {name: best[number] for number, name in questions.items() if number in best}
    return found


def _best_in(opened: Opened, entry: str) -> dict[int, Key]:
    opening = opened.open(Choice(entry))
    assessor = assessor_of(opening)
    if assessor is None:
        return {}
    story = story_of(opening.header, opening.exchanges, pending=None, footer=opening.footer)
    return assessor.best_offered(story)
