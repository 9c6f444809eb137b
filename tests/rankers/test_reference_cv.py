from __future__ import annotations

import itertools
import subprocess
import sys
from dataclasses import replace

import cv2
import numpy as np
import pytest

from c2nav_engine.contract.outcome import Abstention, Answered, Ordering
from c2nav_engine.contract.question import Form, Picture, Question, Slot
from c2nav_engine.contract.render import render
from c2nav_engine.rankers.random_order import RandomOrder
from c2nav_engine.rankers.reading import read
from c2nav_engine.rankers.reference_cv import ReferenceCv
from c2nav_engine.rankers.reference_cv.judging import seen_spot
from c2nav_engine.rankers.reference_cv.pixels import Pixels, likeness
from c2nav_engine.rankers.reference_cv.words import (
    Landmark,
    amount_in_leg,
    on_first_leg,
    read_leg,
    turns_made,
)
from c2nav_engine.rankers.wrapper import AskingRanker
from tests.helpers.questions import encoded, question

RED, BLUE, GREEN = (205, 30, 30), (30, 60, 200), (40, 150, 50)
RED_LEG = ("Walk to the red bench", "turn left at the table", "stop by the blue bench")
FAN: tuple[str, ...] = ("left", "front", "right")


def room(
    colour: tuple[int, int, int] | None = None, *, size: int = 60, grey: bool = False
) -> Picture:
    """A tan wall over a wooden floor, with a box on the floor."""
    rgb = np.full((224, 224, 3), (215, 205, 180), np.uint8)
    rgb[150:] = (170, 150, 120)
    if colour is not None:
        rgb[215 - size : 215, 112 - size // 2 : 112 + size // 2] = colour
    if grey:
        rgb = np.repeat(cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY)[..., None], 3, axis=-1)
    return encoded(rgb)


def said(asked: Question, order: int = 0) -> Answered:
    prompt = render(asked, order)
    return read(prompt, ReferenceCv().answer(prompt))


def winner(asked: Question) -> str:
    outcome = said(asked)
    assert isinstance(outcome, Ordering)
    return outcome.winner


@pytest.mark.parametrize("places", list(itertools.permutations(FAN)))
def test_permuting_the_views_permutes_the_answer(places: tuple[str, ...]):
    shown = dict(zip(places, (room(RED), room(BLUE), room(GREEN)), strict=True))
    for seed in range(4):
        assert winner(question(legs=RED_LEG, pictures=shown, seed=seed, sketch="")) == places[0]


def test_grey_pictures_leave_a_colour_word_undecided():
    grey = {key: room(RED if key == "left" else None, grey=True) for key in FAN}
    assert isinstance(said(question(legs=RED_LEG, pictures=grey)), Abstention)
    for slot in (Slot.GROUND, Slot.TRANSITION):
        assert isinstance(said(question(slot, legs=RED_LEG, now=room(RED, grey=True))), Abstention)


def test_grey_pictures_do_not_stop_a_leg_without_a_colour():
    legs = ("go on to the hall", "stop")
    grey = {key: room(RED if key == "left" else None, grey=True) for key in FAN}
    assert isinstance(said(question(legs=legs, pictures=grey)), Ordering)


@pytest.mark.parametrize(("word", "expected"), [("red", "left"), ("blue", "right")])
def test_the_leg_s_colour_word_moves_the_answer(word: str, expected: str):
    shown = {"left": room(RED), "front": room(), "right": room(BLUE)}
    legs = (f"Walk to the {word} bench", "stop")
    assert winner(question(legs=legs, pictures=shown, sketch="")) == expected


def test_recolouring_the_thing_moves_the_answer():
    before = {"left": room(RED), "front": room(), "right": room(BLUE)}
    after = {"left": room(BLUE), "front": room(), "right": room(RED)}
    outcomes = [
        winner(question(legs=RED_LEG, pictures=shown, sketch="")) for shown in (before, after)
    ]
    assert outcomes == ["left", "right"]


def test_the_keys_of_alternatives_are_not_read():
    asked = question(legs=RED_LEG, pictures={"left": room(RED), "right": room(BLUE)})
    renamed = replace(
        asked,
        alternatives=tuple(
            replace(item, key=f"k{index}") for index, item in enumerate(asked.alternatives)
        ),
    )
    for order in range(2):
        first, second = (ReferenceCv().answer(render(one, 0)).text for one in (asked, renamed))
        assert first == second, order


def test_a_near_destination_is_here_and_a_missing_one_ahead():
    legs = ("go on", "stop by the red bench")
    near = question(Slot.GROUND, legs=legs, now=room(RED, size=70))
    assert winner(near) == "here"
    assert winner(question(Slot.GROUND, legs=legs, now=room())) == "ahead"


@pytest.mark.parametrize("thing", ["dining table", "sink"])
def test_a_thing_without_a_colour_of_its_own_is_here_after_a_long_way_only(thing: str):
    legs = ("go on", f"stop by the {thing}")
    white = room((255, 255, 255), size=70)
    way = "Leg done: moved many steps.\nThis leg so far: moved {} steps."
    early = question(Slot.GROUND, legs=legs, now=white, sketch=way.format("several"))
    late = question(Slot.GROUND, legs=legs, now=white, sketch=way.format("many"))
    assert [winner(early), winner(late)] == ["ahead", "here"]


def test_the_patch_that_stands_where_such_a_thing_can_stand_is_the_thing():
    rgb = np.full((224, 224, 3), (215, 205, 180), np.uint8)
    rgb[20:90, 20:120] = RED
    rgb[170:210, 150:190] = RED
    view = Pixels(encoded(rgb))
    low, high = (seen_spot(view, Landmark("red", 1.0, noun)) for noun in ("bench", "painting"))
    assert low.top > 0.7
    assert high.reach < 0.5
    assert [spot.share for spot in view.spots("red")] == [high.share, low.share]


def test_swapped_orders_agree_because_only_pixels_and_words_count():
    ranker = AskingRanker(ReferenceCv())
    for seed in range(5):
        asked = question(
            Slot.GROUND, legs=("go on", "stop by the red bench"), now=room(RED), seed=seed
        )
        assert isinstance(ranker.rank(asked).outcome, Ordering)


def test_the_look_back_prefers_the_frame_that_shows_the_destination():
    legs = ("go on", "stop by the red bench")
    shown = {"now": room(), "back": room(RED)}
    assert winner(question(Slot.LOOKBACK, legs=legs, pictures=shown)) == "back"
    empty = {"now": room(), "back": room()}
    assert isinstance(said(question(Slot.LOOKBACK, legs=legs, pictures=empty)), Abstention)


def test_an_opening_turn_favours_its_side_until_the_sketch_says_it_was_made():
    same = dict.fromkeys(FAN, room())
    legs = ("Turn left and go to the hall", "stop")
    before = "This leg so far: just begun."
    after = (
        "This leg so far: moved several steps, turned left.\n"
        "Latest moves, oldest first: turned left and moved a few steps; "
        "turned left and moved a few steps."
    )
    assert winner(question(legs=legs, pictures=same, sketch=before)) == "left"
    assert winner(question(legs=legs, pictures=same, sketch=after)) == "front"


def test_turning_around_goes_on_the_way_it_was_begun():
    same = dict.fromkeys(FAN, room())
    legs = ("Turn around and leave the room", "stop")
    for side in ("left", "right"):
        begun = (
            f"This leg so far: moved a few steps, turned {side}.\n"
            f"Latest moves, oldest first: turned {side} and moved a few steps."
        )
        assert winner(question(legs=legs, pictures=same, sketch=begun)) == side


def test_a_later_turn_gives_way_to_a_landmark_and_the_first_one_does_not_wait():
    shown = {"left": room(), "front": room(RED, size=14), "right": room()}
    first = "This leg so far: just begun."
    later = f"Leg done: moved many steps.\n{first}"
    legs = ("Turn left and walk to the red bench", "stop")
    assert winner(question(legs=legs, pictures=shown, sketch=first)) == "left"
    assert winner(question(legs=legs, pictures=shown, sketch=later)) == "front"


@pytest.mark.parametrize("way", ["go to", "go past"])
def test_the_landmark_of_the_next_leg_draws_already(way: str):
    shown = {"left": room(), "front": room(), "right": room(RED, size=14)}
    legs = ("Leave the room", f"{way} the red bench", "stop")
    assert winner(question(legs=legs, pictures=shown, sketch="")) == "right"


def test_a_view_of_many_things_is_preferred_to_a_wall():
    rgb = np.full((224, 224, 3), (215, 205, 180), np.uint8)
    rgb[110:140] = np.arange(224, dtype=np.uint8)[None, :, None]
    far = encoded(rgb)
    assert Pixels(far).variety > Pixels(room()).variety
    shown = {"left": room(), "front": room(), "right": far}
    assert winner(question(legs=("go on", "stop"), pictures=shown, sketch="")) == "right"


def test_every_inversion_is_answered_in_its_form():
    shown = {"left": room(RED), "front": room(), "right": room(BLUE)}
    asked = question(form=Form.DEGREES, legs=RED_LEG, pictures=shown, sketch="")
    prompt = render(asked)
    assert "45" in ReferenceCv().answer(prompt).text
    near = question(
        Slot.GROUND, form=Form.YES_NO, legs=("go", "stop by the red bench"), now=room(RED, size=70)
    )
    assert ReferenceCv().answer(render(near)).text == "yes"


def test_legs_are_read():
    leg = read_leg("Turn slightly left past the red sofa and stop in front of the blue painting")
    assert leg.turn is not None
    assert (leg.turn.side, leg.turn.cycles, leg.turn.opening) == ("left", 1, True)
    assert [landmark.colour for landmark in leg.landmarks] == ["red", "blue"]
    assert leg.target is not None
    assert leg.target.hanging
    assert read_leg("Exit the room with the red chair behind you").target is None


def test_the_sketch_s_words_are_read():
    sketch = (
        "Leg done: moved many steps.\nThis leg so far: moved several steps, turned left.\n"
        "Latest moves, oldest first: turned sharply left; turned right and moved a few steps."
    )
    assert amount_in_leg(sketch) == 2
    assert turns_made(sketch, "left") == 1
    assert amount_in_leg("") == 0
    assert not on_first_leg(sketch)
    assert on_first_leg("This leg so far: just begun.")
    assert not on_first_leg("")


def test_other_walls_are_unlike():
    green = np.full((64, 64, 3), (60, 160, 60), np.uint8)
    here, same, other = Pixels(room()), Pixels(room()), Pixels(encoded(green))
    assert likeness(here, same) == pytest.approx(1.0)
    assert likeness(here, other) < 0.2


def test_it_loads_nothing_that_knows_where_the_robot_is():
    code = (
        "import sys, c2nav_engine.rankers.reference_cv as _\n"
        "print('\\n'.join(name for name in sys.modules))"
    )
    out = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    loaded = out.stdout.split()
    packages = ("geometry", "world", "sensing", "controller", "metrics", "navigator", "runner")
    forbidden = (*(f"c2nav_engine.{name}" for name in packages), "torch", "openai", "httpx")
    assert [name for name in loaded if name.startswith(forbidden)] == []


def test_it_beats_chance_on_easy_triplets():
    def share(ranker: AskingRanker) -> float:
        right = 0
        for seed, place in itertools.product(range(5), FAN):
            others = [room(BLUE), room(GREEN)]
            shown = {key: room(RED) if key == place else others.pop() for key in FAN}
            asked = question(legs=RED_LEG, pictures=shown, seed=seed, sketch="")
            outcome = ranker.rank(asked).outcome
            right += isinstance(outcome, Ordering) and outcome.winner == place
        return right / 15

    assert share(AskingRanker(ReferenceCv())) == 1.0
    assert share(AskingRanker(RandomOrder(2))) < 0.8
