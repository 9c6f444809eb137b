"""A person's ranking while it is being made: pure operations on tiers."""

from __future__ import annotations

from dataclasses import dataclass, replace

from c2nav_engine.contract.outcome import Abstention, Key, Said, ranking_of

NONE_OF_THESE = "none of these"
"""Reason of the abstention when a person rejects every alternative."""


@dataclass(frozen=True, slots=True)
class Draft:
    """What a person has said so far about one decision.

    Attributes:
        tiers: Keys by rank; unranked keys come last when it is committed.
        none: Whether the person said "none of these".
        tie_next: Whether the next key joins the last tier.
    """

    tiers: tuple[tuple[Key, ...], ...] = ()
    none: bool = False
    tie_next: bool = False

    @property
    def empty(self) -> bool:
        """Whether nothing was said."""
        return not self.tiers and not self.none

    @property
    def keys(self) -> tuple[Key, ...]:
        """Ranked keys, best first."""
        return tuple(key for tier in self.tiers for key in tier)


def press(draft: Draft, key: Key) -> Draft:
    """Rank one more key; pressing a ranked key takes it out again."""
    if key in draft.keys:
        return without(draft, key)
    if draft.tie_next and draft.tiers:
        return Draft((*draft.tiers[:-1], (*draft.tiers[-1], key)))
    return Draft((*draft.tiers, (key,)))


def without(draft: Draft, key: Key) -> Draft:
    """Take a key out; emptied tiers close up."""
    tiers = (tuple(k for k in tier if k != key) for tier in draft.tiers)
    return Draft(tuple(tier for tier in tiers if tier))


def take_back(draft: Draft) -> Draft:
    """Undo the last press."""
    if draft.none or draft.tie_next:
        return replace(draft, none=False, tie_next=False)
    return without(draft, draft.keys[-1]) if draft.keys else draft


def tie(draft: Draft) -> Draft:
    """Let the next key share the last rank."""
    return replace(draft, tie_next=bool(draft.tiers), none=False)


def none_of_these() -> Draft:
    """Reject every alternative."""
    return Draft(none=True)


def arranged(tiers: tuple[tuple[Key, ...], ...]) -> Draft:
    """A ranking made at once, by dragging."""
    return Draft(tuple(tier for tier in tiers if tier))


def outcome_of(draft: Draft, offered: tuple[Key, ...]) -> Said:
    """What the draft commits; keys that were left out share the last rank."""
    if draft.none or not draft.tiers:
        return Abstention(NONE_OF_THESE)
    return ranking_of(draft.tiers, offered)
