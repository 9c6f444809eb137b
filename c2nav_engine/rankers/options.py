"""Options of a ranker, as `KEY=VALUE` words from the command line."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TypeVar

from c2nav_engine.errors import UsageError

Options = Mapping[str, str]
T = TypeVar("T")


class OptionReader:
    """Takes options by name and rejects what nobody took.

    Args:
        ranker: Name for messages.
        options: What was given.
    """

    def __init__(self, ranker: str, options: Options) -> None:
        self._ranker = ranker
        self._left = dict(options)
        self._known: list[str] = []

    def text(self, name: str, default: str = "") -> str:
        """An option as it stands."""
        self._known.append(name)
        return self._left.pop(name, default)

    def integer(self, name: str, default: int) -> int:
        """An option as a whole number."""
        return self._read(name, default, int)

    def number(self, name: str, default: float) -> float:
        """An option as a finite number."""
        return self._read(name, default, _finite)

    def flag(self, name: str, *, default: bool) -> bool:
        """An option as true or false."""
        return self._read(name, default, _flag)

    def optional_integer(self, name: str) -> int | None:
        """An option as a whole number, or None when absent."""
        return self._read(name, None, int)

    def optional_number(self, name: str) -> float | None:
        """An option as a number, or None when absent."""
        return self._read(name, None, _finite)

    def choice(self, name: str, default: str, *, among: tuple[str, ...]) -> str:
        """An option out of a few words."""
        value = self.text(name, default)
        if value not in among:
            message = f"expected {name} to be one of {', '.join(among)}; came {value!r}"
            raise UsageError(f"{message}. Give the ranker {self._ranker} one of them")
        return value

    def done(self) -> None:
        """Reject every option that nothing took."""
        if self._left:
            known = ", ".join(self._known) or "none"
            message = (
                f"the ranker {self._ranker} has no option {', '.join(sorted(self._left))}; "
                f"its options are: {known}"
            )
            raise UsageError(message)

    def _read(self, name: str, default: T, convert: Callable[[str], T]) -> T:
        text = self.text(name)
        if not text:
            return default
        try:
            return convert(text)
        except ValueError:
            message = f"expected a value for {name} of the ranker {self._ranker}, came {text!r}"
            raise UsageError(message) from None


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(text)
    return value


def _flag(text: str) -> bool:
    words = {"true": True, "1": True, "yes": True, "false": False, "0": False, "no": False}
    if text.casefold() not in words:
        raise ValueError(text)
    return words[text.casefold()]
