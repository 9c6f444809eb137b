"""The timeline: marks that can be hit, labels that can be read, a scrub that ends aright."""

from __future__ import annotations

from itertools import pairwise

import pytest

from app.session.worker import Session
from tests.helpers.page import Visit

pytestmark = pytest.mark.browser

Live = tuple[Visit, Session]

TIMELINE = "document.querySelector('timeline-bar')"
DRAWN = f"""[...{TIMELINE}.shadowRoot.querySelectorAll('svg *')].map((node) => [
  node.tagName, [...node.classList].sort().join(' '), node.textContent,
  ...['x', 'y', 'x1', 'text-anchor', 'd'].map((name) => node.getAttribute(name)),
].join('|'))"""


def test_timeline_marks_are_large_enough_to_hit_and_go_there(recorded: Live):
    seen, _ = recorded
    boxes = seen.page.evaluate(
        "[...document.querySelector('timeline-bar').shadowRoot.querySelectorAll('.mark rect')]"
        ".map(r => [r.getBoundingClientRect().width, r.getBoundingClientRect().height])"
    )
    assert boxes
    assert all(width >= 12 and height >= 24 for width, height in boxes)
    marks = seen.page.locator("timeline-bar .mark")
    marks.nth(2).dispatch_event("pointerdown")
    seen.until("s.place.decision === 2")


def test_a_timeline_that_follows_looks_like_one_that_is_drawn_anew(recorded: Live):
    seen, _ = recorded
    for decision in (9, 3, 6):
        seen.page.evaluate(f"c2nav.send('go', {{decision: {decision}}})")
        words = f"{TIMELINE}.shadowRoot.querySelector('.heretext').textContent"
        seen.page.wait_for_function(f"{words}.endsWith('decision {decision}')")
        followed = seen.page.evaluate(DRAWN)
        seen.page.evaluate(f"{TIMELINE}.draw({TIMELINE}.timeline)")
        assert followed == seen.page.evaluate(DRAWN)
        assert len(seen.page.locator("timeline-bar .mark.now").all()) == 1


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_the_label_of_the_place_in_view_does_not_lie_on_the_curve(recorded: Live, share: float):
    seen, _ = recorded
    between = seen.page.evaluate(
        """share => {
          const bar = document.querySelector("timeline-bar");
          const most = Math.max(...bar.timeline.curve.map(([, distance]) => distance));
          const curve = bar.timeline.curve.map(([step]) => [step, share * most]);
          curve.push([bar.timeline.last + 1, most]);
          bar.draw({ ...bar.timeline, curve, ghost: null, legs: [] });
          const text = bar.shadowRoot.querySelector(".heretext").getBBox();
          const line = bar.y(share * most);
          return Math.max(line - text.y - text.height, text.y - line);
        }""",
        share,
    )
    assert between >= 0.0


MARKS = f"""[...{TIMELINE}.shadowRoot.querySelectorAll('.mark')].map((node) => {{
  const box = node.querySelector('rect').getBoundingClientRect();
  return {{ sign: node.textContent, x: box.x + box.width / 2, y: box.y + box.height / 2 }};
}})"""


LADDER = f"""(steps) => {{
  const {{ marks, ...rest }} = {TIMELINE}.timeline;
  const step = {{ 4: 12, 5: 12, 6: 12, 7: 15 }};
  const drawn = marks.map((mark) =>
    mark.decision in step ? {{ ...mark, lane: 2, step: step[mark.decision] }} : mark);
  {TIMELINE}.draw({{ ...rest, marks: drawn, steps: steps ?? rest.steps }});
}}"""
"""Decisions 4 to 6 as ground, journey and look-back of one step, 7 as the next ground."""


def test_decisions_of_one_lane_at_one_step_stand_side_by_side(recorded: Live):
    seen, _ = recorded
    seen.page.evaluate(LADDER)
    places = seen.page.evaluate(MARKS)
    assert places[5]["x"] - places[4]["x"] >= 12
    for decision in (4, 5, 6):
        place = places[decision]
        seen.page.mouse.move(place["x"], place["y"])
        words = seen.page.locator("timeline-bar .tip").inner_text()
        assert words == seen.state()["timeline"]["marks"][decision]["words"]
        seen.page.mouse.click(place["x"], place["y"])
        seen.until(f"s.place.decision === {decision}")


def test_where_marks_crowd_further_clicks_reach_each(recorded: Live):
    seen, _ = recorded
    seen.page.evaluate(LADDER, 9000)
    spot = seen.page.evaluate(MARKS)[5]
    reached = set[int]()
    for _ in range(4):
        before = seen.state()["place"]["decision"]
        seen.page.mouse.click(spot["x"], spot["y"])
        seen.until(f"s.place.decision !== {before}", 10_000)
        reached.add(seen.state()["place"]["decision"])
    assert reached == {4, 5, 6, 7}
    words = seen.page.locator("timeline-bar .tip").inner_text()
    assert words.endswith("one of 4 here, click again for the next")


def test_a_mark_is_hit_where_it_is_drawn_and_not_where_its_neighbours_target_reaches(
    recorded: Live,
):
    seen, _ = recorded
    marks = seen.state()["timeline"]["marks"]
    above = {mark["step"] for mark in marks if mark["lane"] == 0}
    below = next(m for m in marks if m["lane"] == 1 and m["step"] in above)
    spot = seen.page.evaluate(MARKS)[below["decision"]]
    seen.page.mouse.click(spot["x"], spot["y"] - 4)
    seen.until(f"s.place.decision === {below['decision']}", 10_000)


def test_the_active_leg_has_its_colour_and_weight_on_the_timeline(recorded: Live):
    seen, _ = recorded
    looks = f"""[...{TIMELINE}.shadowRoot.querySelectorAll('.legname')].map((node) => {{
      const look = getComputedStyle(node);
      return [node.textContent, look.fill, look.fontWeight];
    }})"""
    number = seen.page.locator("route-strip .now-n")
    for leg, start in enumerate(seen.state()["timeline"]["legs"]):
        seen.page.evaluate(f"c2nav.send('go', {{step: {start['step'] + 1}}})")
        named = f"{TIMELINE}.shadowRoot.querySelector('.legname.now')?.textContent"
        seen.page.wait_for_function(f"() => {named} === 'leg {leg + 1}'", timeout=10_000)
        active = number.evaluate("node => getComputedStyle(node).color")
        drawn = seen.page.evaluate(looks)
        assert [words for words, fill, _ in drawn if fill == active] == [f"leg {leg + 1}"]
        assert [words for words, _, weight in drawn if weight == "600"] == [f"leg {leg + 1}"]


def test_names_of_legs_and_of_the_place_stand_on_what_crosses_them(recorded: Live):
    seen, _ = recorded
    drawn = seen.page.evaluate(
        f"""[...{TIMELINE}.shadowRoot.querySelectorAll('.curve, .rest, .legname, .heretext')]
        .map((node) => {{
          const look = getComputedStyle(node);
          const halo = look.paintOrder.startsWith("stroke") && look.stroke !== "none";
          return [node.classList[0], halo ? parseFloat(look.strokeWidth) : 0];
        }})"""
    )
    names = [name for name, _ in drawn]
    assert names.index("legname") > max(i for i, n in enumerate(names) if n in ("curve", "rest"))
    assert all(halo >= 6 for name, halo in drawn if name in ("legname", "heretext"))


@pytest.mark.parametrize("most_m", [4.9, 7.0, 11.0, 18.0, 60.0])
def test_labels_of_the_curves_axis_keep_a_line_apart(recorded: Live, most_m: float):
    seen, _ = recorded
    labels = seen.page.evaluate(
        f"""most => {{
          const bar = {TIMELINE};
          bar.draw({{ ...bar.timeline, ghost: null, curve: [[0, most], [9, 1]] }});
          return [...bar.shadowRoot.querySelectorAll("svg > text[text-anchor=end]:not(.heretext)")]
            .map((node) => [node.textContent, Number(node.getAttribute("y"))]);
        }}""",
        most_m,
    )
    assert [words for words, _ in labels] == ["0", "3", f"{most_m:.0f}"]
    heights = sorted(height for _, height in labels)
    assert min(b - a for a, b in pairwise(heights)) >= 12


SCRUB = """
async () => {
  const bar = document.querySelector("timeline-bar"), box = bar.getBoundingClientRect();
  const marks = c2nav.state.timeline.marks, target = marks[marks.length - 3];
  const fire = (node, type, step) => node.dispatchEvent(new PointerEvent(type, {
    bubbles: true, clientX: box.left + bar.x(step), clientY: box.top + 60, button: 0,
  }));
  fire(bar.shadowRoot.querySelector("svg"), "pointerdown", 0);
  for (let step = 1; step <= target.step; step++) fire(window, "pointermove", step);
  fire(window, "pointerup", target.step);
  return target;
}
"""


def test_a_scrub_ends_where_the_pointer_was_let_go_with_all_its_pictures(recorded: Live):
    seen, session = recorded
    target = seen.page.evaluate(SCRUB)
    seen.until(f"s.place.step === {target['step']}")
    assert session.snapshot.here.step == target["step"]
    seen.page.wait_for_function(
        """words => {
          const root = document.querySelector('rank-strip').shadowRoot;
          return root.querySelector('.chip').textContent.startsWith(words)
            && [...root.querySelectorAll('img')].every(one => one.complete && one.naturalWidth > 0);
        }""",
        arg=f"decision {target['decision']} ",
    )
    seen.page.reload()
    seen.until(f"s.place.step === {target['step']} && s.decision.number === {target['decision']}")
