"""Noise by name: the same words always give the same draw, in any order of asking.

That is what makes variants matched. Two runs that stand at the same step of the same episode see
the same evidence, whatever was asked before.
"""

from __future__ import annotations

import hashlib
from statistics import NormalDist

_STANDARD = NormalDist()
_BITS = 53


def uniform(*name: str | int) -> float:
    """A draw from the open interval (0, 1) that belongs to this name."""
    digest = hashlib.sha256("\x1f".join(map(str, name)).encode()).digest()
    integer = int.from_bytes(digest[:8], "big") >> (64 - _BITS)
    return (integer + 0.5) / 2**_BITS


def normal(*name: str | int) -> float:
    """A standard normal draw that belongs to this name."""
    return _STANDARD.inv_cdf(uniform(*name))


def normal_cdf(z: float) -> float:
    """Φ(z)."""
    return _STANDARD.cdf(z)
