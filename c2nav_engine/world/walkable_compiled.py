"""The one place that touches numba: kernels compiled to machine code and cached on disk."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar, cast

import numba

_P = ParamSpec("_P")
_R = TypeVar("_R")


def compiled(function: Callable[_P, _R]) -> Callable[_P, _R]:
    """The function as a machine-code kernel: same arguments, same bytes on every run.

    Run-time type checks that tests wrap around functions are taken off first: a kernel can
    only call kernels.
    """
    kernel: Any = numba.njit(cache=True)(inspect.unwrap(function))
    return cast("Callable[_P, _R]", kernel)
