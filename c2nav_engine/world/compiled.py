"""The one wrapper of numba: typed, cached on disk, free of the interpreter lock."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar, cast

Function = TypeVar("Function", bound=Callable[..., object])


def compiled(function: Function) -> Function:
    """Compile a numeric function at its first call; the machine code is kept on disk.

    Compiled functions hold no interpreter lock, so plain threads share their work. Arithmetic
    keeps its written order (no fast-math), so the same input gives the same bytes; division by
    zero gives inf or nan as in numpy.

    The code on disk is renewed when the function's own file changes, not when a compiled helper
    in another file does: after editing a helper, touch the files that use it.
    """
    import numba

    # Run-time type checks (switched on in tests) wrap functions in Python that cannot compile.
    while hasattr(function, "__wrapped__"):
        function = cast("Function", getattr(function, "__wrapped__"))  # noqa: B009
    jit = cast(
        "Callable[[Function], Function]", numba.njit(cache=True, nogil=True, error_model="numpy")
    )
    return jit(function)
