"""Constrained decoding over a finite list of answers: at each step only tokens that lead to one."""

from __future__ import annotations

from collections.abc import Sequence


class TokenTrie:
    """Token sequences of the allowed answers, each closed by the end token.

    Args:
        sequences: Token ids of each answer, without the end token.
        end: Id of the end token.
    """

    def __init__(self, sequences: Sequence[Sequence[int]], *, end: int) -> None:
        self._end = end
        self._next: dict[tuple[int, ...], list[int]] = {}
        for sequence in sequences:
            closed = (*sequence, end)
            for length in range(len(closed)):
                following = self._next.setdefault(closed[:length], [])
                if closed[length] not in following:
                    following.append(closed[length])
        self.longest = max(map(len, sequences)) + 1

    def allowed(self, written: Sequence[int]) -> list[int]:
        """Tokens that may follow what was written; the end token once nothing else may."""
        return self._next.get(tuple(written), [self._end])
