"""`c2nav study pack`: one offline page a person."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from app.gateway.assets import assets
from app.pages.judge import packed_page, question_json
from app.reviews.desk import Desk
from app.reviews.packed import packed_study
from app.reviews.questions import prompt_at
from app.reviews.study import Person, Study
from c2nav_engine.errors import UsageError


def pack_study(study: Study, *, out: Path, only: str = "") -> dict[str, Path]:
    """Write `STUDY.PSEUDONYM.html` for everybody, or for one person; returns name → file.

    Raises:
        UsageError: There is nobody of that name, or people share a queue: without a connection
            they would answer the same items.
    """
    people = [person for person in study.people() if only in ("", person.name)]
    if not people:
        held = ", ".join(person.name for person in study.people()) or "nobody"
        message = f"expected a person of study {study.name}, came {only!r}; it has {held}"
        raise UsageError(message)
    shared = Counter(person.queue for person in study.people())
    together = [person.name for person in people if shared[person.queue] > 1]
    if together:
        message = (
            "expected people with queues of their own, came "
            f"{', '.join(together)} who share one; serve the study to them instead"
        )
        raise UsageError(message)
    out.mkdir(parents=True, exist_ok=True)
    return {person.name: _packed(study, person, out) for person in people}


def _packed(study: Study, person: Person, out: Path) -> Path:
    prompts = [prompt_at(study, place) for place in study.queue(person.queue)]
    desk = Desk(study)
    try:
        answered = desk.answered(person)
    finally:
        desk.close()
    questions = [(prompt, question_json(prompt)) for prompt in prompts]
    files = assets()
    page = packed_page(
        packed_study(study, person, questions, answered=answered),
        scripts=[files[name].body.decode() for name in ("packed.js", "judge.js")],
        style=files["judge.css"].body.decode(),
    )
    path = out / f"{study.name}.{person.pseudonym}.html"
    path.write_text(page, encoding="utf-8")
    return path
