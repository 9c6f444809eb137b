"""`reference-cv`: pixels and text only, by OpenCV; no weights, no network.

The embedded default. It is not a vision-language model and reproduces no number of the paper: it
knows common colour words, turn words and how much a view shows in the distance. It receives what a
model receives, the same words and the same JPEG bytes, and answers in the same text through the
same parser. It reads neither the keys of alternatives nor anything the controller knows.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence

from c2nav_engine.contract.prompt import Prompt, Reply
from c2nav_engine.contract.question import Alternative, Form, Slot
from c2nav_engine.errors import InternalError
from c2nav_engine.rankers.options import OptionReader, Options
from c2nav_engine.rankers.reference_cv import judging
from c2nav_engine.rankers.reference_cv.pixels import Pixels

CANNOT_TELL = "cannot tell"
"""Its abstention, in the words that the parser reads as one."""

Labelled = Sequence[tuple[str, Alternative]]


class ReferenceCv:
    """Colour words, turn words and the variety of a view against the pixels of each."""

    @property
    def name(self) -> str:
        """What records call it."""
        return "reference-cv"

    @property
    def asks_once(self) -> bool:
        """It is asked like a model."""
        return False

    def answer(self, prompt: Prompt) -> Reply:
        """A ranking, a tie or an abstention as text; it never invents a preference."""
        scores = _scores(prompt)
        if scores is None or len(set(scores.values())) == 1:
            return Reply(text=CANNOT_TELL)
        if prompt.form is Form.ORDINAL:
            return Reply(text=_ranking(scores))
        best = [item for item in _labelled(prompt) if scores[item[0]] == max(scores.values())]
        return Reply(text=_SINGLE[prompt.form](*best[0]) if len(best) == 1 else CANNOT_TELL)

    @classmethod
    def from_options(cls, options: Options) -> ReferenceCv:
        """It has no options."""
        OptionReader("reference-cv", options).done()
        return cls()


def _scores(prompt: Prompt) -> dict[str, float] | None:
    """Label → score, or None when nothing can be told from these pictures."""
    question = prompt.question
    labelled = _labelled(prompt)
    pictures = [item.picture for _, item in labelled if item.picture is not None]
    views = [Pixels(picture) for picture in pictures]
    # The last shared picture is the current view; those before it are the sketch's thumbnails.
    context = [Pixels(picture) for _, picture in question.context]
    leg = judging.words_of_leg(question.legs, question.leg)
    asked = [leg]
    if question.slot is Slot.TRANSITION:
        asked.append(judging.words_of_leg(question.legs, question.leg + 1))
    colour_speaks = any(words.spoken_colour for words in asked)
    if colour_speaks and all(view.colourless for view in (*views, *context)):
        return None
    if question.slot in {Slot.SEEING, Slot.GLANCE}:
        sides = [item.text for _, item in labelled]
        legs = (leg, judging.words_after(question.legs, question.leg))
        found = judging.direction_scores(views, sides, legs=legs, sketch=question.sketch)
    elif question.slot is Slot.LOOKBACK:
        found = [judging.destination_score(view, leg) for view in views]
    else:
        found = _statement_scores(prompt, labelled, context)
    return {label: round(score, 6) for (label, _), score in zip(labelled, found, strict=True)}


def _statement_scores(prompt: Prompt, labelled: Labelled, context: Sequence[Pixels]) -> list[float]:
    """Slots whose alternatives are statements: told apart by their words, never by their keys."""
    question = prompt.question
    leg = judging.words_of_leg(question.legs, question.leg)
    *earlier, now = context
    if question.slot is Slot.DIRECT:
        actions = judging.action_scores(now, leg=leg, sketch=question.sketch)
        return [_matching(item.text, _ACTION_WORDS, actions) for _, item in labelled]
    if question.slot is Slot.TRANSITION:
        following = judging.words_of_leg(question.legs, question.leg + 1)
        support = judging.next_leg_support(
            now, earlier, legs=(leg, following), sketch=question.sketch
        )
    else:
        # A journey covers the route when it has led to the last leg's thing: one piece of evidence.
        support = 1.0 if judging.arrived_here(now, leg, sketch=question.sketch) else -1.0
    sides = {"for": support, "against": -support}
    return [_matching(item.text, _STATEMENT_WORDS, sides) for _, item in labelled]


_ACTION_WORDS = {"turn left": "left", "turn right": "right", "go forward": "forward"}
_STATEMENT_WORDS = {
    "still on": "against",
    "has finished": "for",
    "still ahead": "against",
    "is here": "for",
    "still missing": "against",
    "covers the whole": "for",
}


def _matching(text: str, words: Mapping[str, str], scores: Mapping[str, float]) -> float:
    # The leg quoted in a hypothesis may hold any of these words, so the span is cut out first.
    ours = re.sub(r"<leg>.*</leg>", "", text, flags=re.DOTALL)
    for phrase, name in words.items():
        if phrase in ours:
            return scores[name]
    message = f"expected an alternative that says one of {', '.join(words)}; came {ours!r}"
    raise InternalError(message)


def _labelled(prompt: Prompt) -> list[tuple[str, Alternative]]:
    by_key = {item.key: item for item in prompt.question.alternatives}
    return [(label, by_key[key]) for label, key in prompt.labels]


def _ranking(scores: Mapping[str, float]) -> str:
    tiers = sorted(set(scores.values()), reverse=True)
    return " > ".join(
        " = ".join(label for label, score in scores.items() if score == tier) for tier in tiers
    )


def _heading(_label: str, best: Alternative) -> str:
    found = re.search(r"[+-]?\d+", best.caption)
    return found.group() if found else CANNOT_TELL


_SINGLE: dict[Form, Callable[[str, Alternative], str]] = {
    Form.ACTION: lambda label, _: label,
    Form.DEGREES: _heading,
    Form.PROGRESS: lambda _, best: "100" if "has finished" in best.text else "0",
    Form.YES_NO: lambda _, best: "yes" if "is here" in best.text else "no",
}
"""How each form with one value says the best alternative."""
