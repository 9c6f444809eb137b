"""A variant differs from `full` in the named thing alone: questions, pictures, seeds."""

from __future__ import annotations

import dataclasses

import pytest

from c2nav_engine.contract.question import Slot
from c2nav_engine.errors import UsageError
from c2nav_engine.navigator.config import Variant
from c2nav_engine.navigator.variants import PRESETS, preset
from tests.helpers.open_floor import drive, prefer, task

CHANGES = {
    "full": set(),
    "base": {"direction", "legs", "sketch", "terminal", "walkback"},
    "seeing": {"legs", "sketch", "terminal", "walkback"},
    "seeing-remembering": {"terminal", "walkback"},
    "no-seeing": {"direction"},
    "no-remembering": {"legs", "sketch"},
    "no-arriving": {"terminal", "walkback"},
    "no-sketch": {"sketch"},
    "no-transition": {"advance"},
    "no-walkback": {"walkback"},
    "spatial-cardinal": {"direction"},
    "transition-cardinal": {"advance"},
    "terminal-absolute": {"terminal"},
    "random": {"random_answers"},
}


@pytest.mark.parametrize("name", sorted(PRESETS))
def test_a_preset_changes_the_named_switches_alone(name):
    full, mine = Variant(), PRESETS[name]
    changed = {
        f.name
        for f in dataclasses.fields(Variant)
        if getattr(full, f.name) != getattr(mine, f.name)
    }
    assert changed == CHANGES[name]
    assert preset(name).controller == preset("full").controller
    assert preset(name).gates == preset("full").gates


def test_one_configuration_under_two_names_has_one_hash():
    assert preset("no-arriving").sha256() == preset("seeing-remembering").sha256()
    hashes = {preset(name).sha256() for name in PRESETS}
    assert len(hashes) == len(PRESETS) - 1


def test_an_unknown_variant_is_named_with_those_that_exist():
    with pytest.raises(UsageError, match=r"full, base.*came 'fulll'"):
        preset("fulll")


@pytest.mark.parametrize("name", ["transition-cardinal", "terminal-absolute", "no-walkback"])
def test_matched_variants_ask_the_same_first_elections(name):
    answers = prefer(seeing="front", transition="stay", ground="ahead", journey="missing")
    first, second = (drive(task(v), answers, asks=4).asked(Slot.SEEING) for v in ("full", name))
    assert first[0].question == second[0].question
    assert first[0].facts == second[0].facts


def test_the_same_seed_gives_the_same_seeds_of_presentation_in_every_variant():
    seeds = {}
    for name in ("full", "spatial-cardinal", "no-sketch", "no-transition"):
        (ask,) = drive(task(name), prefer(), asks=1).asked(Slot.SEEING)
        seeds[name] = ask.question.shuffle_seed
    assert len(set(seeds.values())) == 1


def test_another_seed_or_slot_gives_another_presentation():
    one = drive(task(seed=0), prefer(seeing="front"), asks=3)
    two = drive(task(seed=1), prefer(seeing="front"), asks=3)
    assert one.answers[0][0].question.shuffle_seed != two.answers[0][0].question.shuffle_seed
    mine = {ask.question.shuffle_seed for ask, _ in one.answers}
    assert len(mine) == len(one.answers)
