"""The type checks that run in every test."""

from __future__ import annotations

import random
from typing import Any, cast

import pytest
from beartype.roar import BeartypeCallHintViolation

from tests.helpers.checker import checked


@checked
def total(numbers: list[float]) -> float:
    return sum(numbers)


def test_a_wrong_item_is_refused_and_an_int_is_a_float():
    assert total([1, 2.5]) == 3.5
    with pytest.raises(BeartypeCallHintViolation):
        total(cast("Any", ["one", "two"]))


def test_checks_leave_the_common_generator_alone():
    before = random.getstate()
    for _ in range(10):
        total([1.0, 2.0, 3.0])
    assert random.getstate() == before
