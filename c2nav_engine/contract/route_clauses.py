"""From an instruction to clauses: where one may begin, and what each of them holds."""

from __future__ import annotations

import re
from dataclasses import dataclass

from c2nav_engine.contract import route_lexicon as lexicon

_WORD = re.compile(r"[^\s,.;:!?]+(?:[.,:](?=\d)[^\s,.;:!?]+)*")
"""A run without separators; a number keeps its decimal point."""

_COMPOUNDS = frozenset({"closet", "pantry", "shower", "tub", "wardrobe", "freezer"})
"""After "walk in" these make a noun of it: "the bedroom walk in closet"."""


@dataclass(frozen=True, slots=True)
class Word:
    """One word of the instruction.

    Attributes:
        text: Lower case, without surrounding quotes and brackets.
        start: First character in the instruction.
        end: One past the last.
        gap: What separates it from the word before.
    """

    text: str
    start: int
    end: int
    gap: str

    @property
    def opens_sentence(self) -> bool:
        """Whether a full stop, semicolon or new line stands before it."""
        return any(mark in self.gap for mark in ".;!?\n\r")

    @property
    def follows_comma(self) -> bool:
        """Whether a comma, colon or dash stands before it."""
        return any(mark in self.gap for mark in ",:")


@dataclass(frozen=True, slots=True)
class Clause:
    """Words that belong together, with what they hold.

    Attributes:
        words: In order, at least one.
        introduces: Whether it opens a sentence that goes on ("After the couch, turn left").
    """

    words: tuple[Word, ...]
    introduces: bool

    @property
    def has_landmark(self) -> bool:
        """Whether a word names something to be seen."""
        return any(names_landmark(self.words, i) for i in range(len(self.words)))

    @property
    def has_verb(self) -> bool:
        """Whether it tells to move, turn or stop."""
        return any(
            word.text in lexicon.VERBS or word.text in lexicon.GERUNDS for word in self.words
        )

    @property
    def points_back(self) -> bool:
        """Whether it leans on the clause before ("wait there", "and stop")."""
        texts = {word.text for word in self.words}
        return not texts.isdisjoint(lexicon.POINTING_BACK | lexicon.STOP_VERBS)


def words_of(instruction: str) -> tuple[Word, ...]:
    """Every word with its place."""
    words: list[Word] = []
    end = 0
    for match in _WORD.finditer(instruction):
        text = match.group().lower().strip("\"'()[]“”‘’`*")
        words.append(Word(text, match.start(), match.end(), instruction[end : match.start()]))
        end = match.end()
    return tuple(words)


def clauses_of(words: tuple[Word, ...]) -> tuple[Clause, ...]:
    """Cut before sentences, before "then", and before the verbs that open a clause."""
    starts = [i for i in range(len(words)) if i == 0 or _opens_clause(words, i)]
    clauses: list[Clause] = []
    for start, end in zip(starts, [*starts[1:], len(words)], strict=True):
        goes_on = end < len(words) and not words[end].opens_sentence
        opens = start == 0 or words[start].opens_sentence
        clauses.append(Clause(words[start:end], introduces=opens and goes_on))
    return tuple(clauses)


def names_landmark(words: tuple[Word, ...], i: int) -> bool:
    """Whether word i names something to be seen, such as "couch" or the noun in "the exit"."""
    text = words[i].text
    if not any(character.isalpha() for character in text):
        return False
    if text not in lexicon.NOT_LANDMARKS:
        return True
    noun = text in lexicon.VERBS and text not in lexicon.TURN_VERBS | {"stop", "end", "start"}
    return noun and i > 0 and words[i - 1].text in lexicon.DETERMINERS


def _opens_clause(words: tuple[Word, ...], i: int) -> bool:
    word = words[i]
    if word.opens_sentence:
        return True
    if word.text == "then":
        # "and then" opens at its "and".
        return words[i - 1].text != "and" or word.follows_comma
    if word.text == "and" or word.follows_comma:
        return _verb_after_openers(words, i) or (word.follows_comma and _subordinate(words, i))
    return _runs_on(words, i)


def _verb_after_openers(words: tuple[Word, ...], i: int) -> bool:
    after_then = False
    while i < len(words) and words[i].text in lexicon.CLAUSE_OPENERS:
        after_then |= words[i].text == "then"
        i += 1
    if i == len(words):
        return False
    text = words[i].text
    gerund = text in lexicon.STOP_GERUNDS or (after_then and text in lexicon.GERUNDS)
    return after_then or gerund or text in lexicon.VERBS


def _subordinate(words: tuple[Word, ...], i: int) -> bool:
    following = words[i + 1].text if i + 1 < len(words) else ""
    return words[i].text in lexicon.SUBORDINATORS and (
        following in {"you", "you've", "you're"} or following in lexicon.GERUNDS
    )


def _runs_on(words: tuple[Word, ...], i: int) -> bool:
    """A verb that opens a clause without any mark: "past the couch turn left"."""
    text, before = words[i].text, words[i - 1].text
    if text == "stopping":
        return before not in lexicon.NO_RUN_ON_AFTER
    if text not in lexicon.RUN_ON_VERBS or before in lexicon.NO_RUN_ON_AFTER:
        return False
    if text == "turn" and before in {"left", "right"}:
        return False
    compound = [word.text for word in words[i + 1 : i + 3]]
    return not (
        text == "walk" and compound[:1] == ["in"] and compound[1:] and compound[1] in _COMPOUNDS
    )
