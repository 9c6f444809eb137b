"""The paper's variants as named presets of one config; each differs from `full` in its name."""

from __future__ import annotations

from collections.abc import Mapping

from c2nav_engine.errors import UsageError
from c2nav_engine.navigator.config import Advance, Direction, LoopConfig, Terminal, Variant

_NO_ARRIVING = Variant(terminal=Terminal.BASIC, walkback=False)

PRESETS: Mapping[str, Variant] = {
    "full": Variant(),
    "base": Variant(
        direction=Direction.DIRECT,
        legs=False,
        sketch=False,
        terminal=Terminal.BASIC,
        walkback=False,
    ),
    "seeing": Variant(legs=False, sketch=False, terminal=Terminal.BASIC, walkback=False),
    "seeing-remembering": _NO_ARRIVING,
    "no-seeing": Variant(direction=Direction.DIRECT),
    "no-remembering": Variant(legs=False, sketch=False),
    "no-arriving": _NO_ARRIVING,
    "no-sketch": Variant(sketch=False),
    "no-transition": Variant(advance=Advance.BLIND),
    "no-walkback": Variant(walkback=False),
    "spatial-cardinal": Variant(direction=Direction.CARDINAL),
    "transition-cardinal": Variant(advance=Advance.CARDINAL),
    "terminal-absolute": Variant(terminal=Terminal.ABSOLUTE),
    "random": Variant(random_answers=True),
}
"""`seeing-remembering` and `no-arriving` are one configuration under two names, as in the paper."""


def preset(name: str) -> LoopConfig:
    """The config of a preset; raises `UsageError` naming those that exist."""
    if name not in PRESETS:
        message = f"expected a variant ({', '.join(PRESETS)}), came {name!r}"
        raise UsageError(message)
    return LoopConfig(variant=PRESETS[name])
