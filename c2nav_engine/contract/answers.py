"""Raw text of a model → an outcome. The only reader of answers; never guesses, never `eval`.

Accepted for an ordering, after NFKC and case folding:

- every label once, joined by ">" or ",": `B > A > C`, `b, a, c`, `View B > View A > View C`;
  "=" ties neighbours: `A > B = C` is an ordering, `A = B > C` a `Tie`;
- a single label, `B` or `View B`: the winner, with the rest tied behind it;
- a JSON object with one of the fields `ranking`, `answer`, `order`, `winner`, alone or in a fence,
  whose value is such a text or a list of labels; a field `reason` beside it is ignored;
- `none`, `neither`, `cannot tell`: an `Abstention`;
- prose around exactly one chain of two or more labels joined by ">", if no other label is named
  and no word turns its direction around.

Everything else is `Invalid` with a named reason, `Refused` or `Empty`. A partial order is no
ordering: a chain that leaves an offered label out is `Invalid` unless it is a single winner.
"""

from __future__ import annotations

import re
import unicodedata

from c2nav_engine.contract.answers_json import Unusable, field_of
from c2nav_engine.contract.answers_number import read_number, read_verdict
from c2nav_engine.contract.outcome import (
    Abstention,
    Answered,
    Empty,
    Invalid,
    Key,
    Ordering,
    Refused,
    ranking_of,
)
from c2nav_engine.contract.presentation import ORDINAL_FORMS
from c2nav_engine.contract.prompt import Prompt
from c2nav_engine.contract.question import Form

TOO_LONG_CHARS = 2000
"""[C] Answers beyond this are not searched for a ranking."""

CANNOT_TELL = "cannot tell"
"""Reason of an abstention in the model's own words."""

_ABSTAINED = re.compile(
    r"(?:none(?: of (?:them|these|the \w+))?|neither(?: of them)?|unclear|undecided|no preference"
    r"|(?:i )?(?:can ?not|can't|unable to) (?:tell|decide|say|determine)(?: [a-z' ]*)?)[.!]?"
)
_REFUSED = re.compile(
    r"\b(?:i am|i'm) sorry\b|\bi (?:can ?not|can't|won't|am unable to|am not able to)"
    r" (?:help|assist|comply|answer|provide)\b"
)
_ITEM = r"(?:(?:view|option|label|image|answer|statement) )?([a-z])"
_SEQUENCE = re.compile(rf"{_ITEM}(?: ?[>,=] ?{_ITEM})*")
_CHAIN = re.compile(r"(?:\bview |\bVIEW |\bView )?\b[A-Z]\b(?: ?[>=] ?(?:[Vv]iew )?\b[A-Z]\b)+")
_TURNED_AROUND = re.compile(
    r"\b(?:not|never|worst|least|reversed?|opposite|wrong|except)\b|n't\b|<"
)
_METRIC = (
    ("a percentage", re.compile(r"%|\bper ?cent")),
    ("degrees", re.compile(r"°|\bdeg(?:rees?)?\b")),
    ("a number", re.compile(r"\d")),
)


_Labels = dict[str, Key]
"""Folded label → key, in presentation order."""


def parse(text: str, prompt: Prompt) -> Answered:
    """What the text means as an answer to this prompt.

    For an ordinal form: an `Ordering` or `Tie` over offered keys, or a named non-answer. For an
    inversion: a `Cardinal` in its range, or a named non-answer.
    """
    clean = _normal(text)
    if not clean:
        return Empty()
    if len(clean) > TOO_LONG_CHARS:
        return Invalid("too long")
    try:
        answer = field_of(clean)
    except Unusable as problem:
        return Invalid(str(problem))
    if prompt.form not in ORDINAL_FORMS:
        return _cardinal(answer.text, prompt)
    labels = {label.casefold(): key for label, key in prompt.labels}
    return _ordinal(answer.text, labels, prose=not answer.structured)


def _cardinal(text: str, prompt: Prompt) -> Answered:
    folded = text.casefold()
    answered = read_verdict(folded) if prompt.form is Form.YES_NO else read_number(folded, prompt)
    if isinstance(answered, Invalid) and not re.search(r"\d", folded):
        return _spoken(folded) or answered
    return answered


def _ordinal(text: str, labels: _Labels, *, prose: bool) -> Answered:
    folded = text.casefold()
    spoken = _spoken(folded)
    if spoken is not None:
        return spoken
    for reason, pattern in _METRIC:
        if pattern.search(folded):
            return Invalid(reason)
    bare = re.sub(r"[\s*_`\"'.\[\]():!]+", " ", folded).strip()
    if _SEQUENCE.fullmatch(bare):
        return _sequence(bare, labels)
    return _in_prose(text, labels) if prose else Invalid("no ranking")


def _spoken(folded: str) -> Answered | None:
    plain = folded.replace("’", "'")
    if _ABSTAINED.fullmatch(plain.strip(" *_`\"'")):
        return Abstention(CANNOT_TELL)
    return Refused() if _REFUSED.search(plain) else None


def _in_prose(text: str, labels: _Labels) -> Answered:
    """Exactly one chain of labels joined by ">", with nothing around it that competes."""
    chains = [found for found in _CHAIN.finditer(text) if ">" in found.group()]
    if len(chains) > 1:
        return Invalid("two answers")
    if not chains:
        return _no_chain(text, labels)
    (chain,) = chains
    around = f"{text[: chain.start()]} … {text[chain.end() :]}"
    if _named(around, labels):
        return Invalid("two answers")
    if _TURNED_AROUND.search(around.casefold()):
        return Invalid("ambiguous prose")
    return _sequence(chain.group().casefold(), labels)


def _no_chain(text: str, labels: _Labels) -> Invalid:
    named = _named(text, labels)
    if len(named) > 1:
        return Invalid("two answers")
    return Invalid("prose without a ranking" if named else "no label")


def _named(text: str, labels: _Labels) -> set[str]:
    """Offered labels that a text names: a capital on its own, but not the article "A"."""
    found = re.findall(r"(?<=[Vv]iew )[A-Z]\b|\bA\b(?! [a-z])|\b[B-Z]\b", text)
    return {letter.casefold() for letter in found} & labels.keys()


def _sequence(sequence: str, labels: _Labels) -> Answered:
    """A folded, well-formed chain → tiers of keys, if it names the offered labels once each."""
    tiers = [re.findall(rf"{_ITEM}\b", tier) for tier in re.split("[>,]", sequence)]
    named = [label for tier in tiers for label in tier]
    strange = [label for label in named if label not in labels]
    if strange:
        return Invalid(f"unoffered label {strange[0].upper()}")
    if len(set(named)) < len(named):
        return Invalid("duplicate label")
    missing = [label for label in labels if label not in named]
    if len(named) == 1:
        winner = labels[named[0]]
        return Ordering.winner_only(winner, tuple(labels.values()))
    if missing:
        return Invalid(f"missing label {missing[0].upper()}")
    keyed = tuple(tuple(labels[label] for label in tier) for tier in tiers)
    return ranking_of(keyed)


def _normal(text: str) -> str:
    # NFKC leaves the minus sign U+2212 alone, and models write it before a heading.
    return unicodedata.normalize("NFKC", text).replace("−", "-").strip()
