"""The same thing by pointer, by keyboard and by native control."""

from __future__ import annotations

from contextlib import suppress

import pytest
from playwright.sync_api import TimeoutError as NotYet

from app.session.worker import Session
from tests.helpers.page import Visit

pytestmark = pytest.mark.browser

Opened = tuple[Visit, Session]

_MIDDLE = """
key => {
  const { nodeRefFromName, camera } = window.__viserMutable;
  const ref = nodeRefFromName["/fan/" + key];
  let image = null;
  (ref.current ?? ref).traverse((one) => {
    if (one.geometry?.type === "PlaneGeometry") image = one;
  });
  const at = camera.position.clone().setFromMatrixPosition(image.matrixWorld).project(camera);
  const box = document.querySelector("canvas[data-engine]").getBoundingClientRect();
  return [box.left + ((at.x + 1) / 2) * box.width, box.top + ((1 - at.y) / 2) * box.height];
}
"""
"""Where the middle of a frustum's picture stands on the page, by three.js itself."""


def _point_at(seen: Visit, key: str) -> None:
    """Follow a picture with the pointer until it is lit: the map is framed anew as it opens."""
    for _ in range(60):
        x, y = seen.page.evaluate(_MIDDLE, key)
        seen.page.mouse.move(x, y)
        with suppress(NotYet):
            seen.until(f"s.view.hovered === '{key}'", patience_ms=2_000)
            return
    pytest.fail(f"pointing at the picture of {key} lights nothing")


def test_a_frustum_lights_its_card_and_the_card_its_frustum(live: Opened):
    seen, session = live
    seen.until("s.decision.source === 'proposal'")
    for key in ("left", "front"):
        seen.until_node(f"/fan/{key}")
        _point_at(seen, key)
        assert "lit" in (seen.card(key).get_attribute("class") or "")
    seen.page.locator("route-strip").hover()
    seen.until("s.view.hovered === ''")
    seen.card("left").hover()
    seen.until("s.view.hovered === 'left'")
    assert session.snapshot.view.hovered == "left"
    assert not seen.errors


def test_the_native_slider_steps_with_the_keyboard(recorded: Opened):
    seen, _ = recorded
    slider = seen.page.get_by_role("slider").first
    slider.focus()
    here = seen.state()["place"]["step"]
    seen.page.keyboard.press("ArrowRight")
    seen.until(f"s.place.step === {here + 1}")
    seen.page.keyboard.press("End")
    seen.until("s.place.step === s.timeline.last")
    seen.page.keyboard.press("Home")
    seen.until("s.place.step === 0")
    assert not seen.errors
