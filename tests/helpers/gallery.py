"""Every panel in light and dark, as pictures for the docs and the README.

    python -m tests.helpers.gallery TRACE --scenes DIR --out docs/gallery

The trace is of a failure, so that there are suspects to show.

`tests/browser/test_gallery.py` walks the same views and measures their layout.
"""

from __future__ import annotations

import argparse
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path

from app.commands.sources import opened_traces
from c2nav_engine.experiments.spec import Setting
from tests.helpers.page import Visit, chromium, inspector, picture, visit

Arrange = Callable[[Visit], None]

SMALL, LARGE = (1280, 720), (1920, 1080)
"""The windows in which everything must fit."""


def tab(*names: str) -> Arrange:
    """Show dock tabs."""

    def arrange(seen: Visit) -> None:
        for name in names:
            seen.page.get_by_role("tab", name=name, exact=True).click()

    return arrange


def go(decision: int) -> Arrange:
    """Stand at a decision."""

    def arrange(seen: Visit) -> None:
        seen.page.evaluate(f"c2nav.send('go', {{decision: {decision}}})")
        seen.until(f"s.place.decision === {decision}")

    return arrange


def send(command: str) -> Arrange:
    """Send a command as the page would."""
    return lambda seen: seen.page.evaluate(f"c2nav.send({command})")


def key(name: str) -> Arrange:
    """Press a key."""
    return lambda seen: seen.page.keyboard.press(name)


def until(script: str) -> Arrange:
    """Wait until an expression over the state holds."""
    return lambda seen: seen.until(script)


def then(*steps: Arrange) -> Arrange:
    """One after the other."""

    def arrange(seen: Visit) -> None:
        for step in steps:
            step(seen)

    return arrange


def first(seen: Visit, lane: int, *, after: int = 0) -> int:
    """The first decision of a lane, else the last decision."""
    marks = seen.state()["timeline"]["marks"]
    found = [m["decision"] for m in marks if m["lane"] == lane and m["decision"] >= after]
    return found[0] if found else marks[-1]["decision"]


def costliest(seen: Visit, *, otherwise: int) -> int:
    """The decision with the greatest regret."""
    regrets = seen.state()["timeline"]["regret"]
    return max(regrets, key=lambda each: each["m"])["decision"] if regrets else otherwise


_OTHERS = "c2nav.state.decision.cards.filter((card) => card.letter && card.rank !== 1)"
SECOND = f"{_OTHERS}.sort((a, b) => a.rank - b.rank)[0].key"
"""What came second, or was offered without a rank, as a script."""


def shots(seen: Visit) -> dict[str, Arrange]:
    """Name → how to get there, in an order that needs no way back."""
    marks = seen.state()["timeline"]["marks"]
    half = marks[len(marks) // 2]["decision"]
    election = first(seen, 0, after=half // 2)
    looks = [m["decision"] for m in marks if "look-back" in m["words"]]
    return {
        "decision": then(
            key("Escape"),  # The sheet of the walk before is in the way of keys.
            go(election),
            send("'layer', {name: 'goal', on: true}"),
            tab("Decision", "Run"),
        ),
        "ranking": then(key("2"), until("s.decision.source === 'draft'"), tab("Export")),
        # Without the scene it is refused instead.
        "fork-offer": then(
            key("Enter"), until("s.offer || s.no_scene && s.notice.fault"), tab("Branches")
        ),
        "transition-sketch": then(
            key("Escape"), go(first(seen, 1, after=half // 3)), tab("Sketch", "Review")
        ),
        "look-back": then(go(looks[0] if looks else election), tab("Look-back", "Export")),
        "arriving-ladder": then(go(marks[-1]["decision"]), tab("Ladder", "Branches")),
        "asked-place": then(
            go(election),
            tab("Decision", "Run"),
            send("'place', {goal: true}"),
            until("s.timeline.place"),
        ),
        "follow": then(send("'forget_place'"), send("'camera', {mode: 'follow'}")),
        "top-down": send("'camera', {mode: 'top'}"),
        "ego": send("'camera', {mode: 'ego'}"),
        "review": then(
            send("'camera', {mode: 'free'}"),
            go(costliest(seen, otherwise=election)),
            tab("Decision", "Review"),
            key("w"),
            send(f"'better', {{key: {SECOND}}}"),
            send("'tag', {value: 'not visible'}"),
            send("'remark', {text: 'What the leg names shows at the edge of the other view.'}"),
            send("'leg_end', {leg: 0, step: c2nav.state.place.step}"),
            until("s.judgement.better && s.judgement.note && s.timeline.leg_ends.length"),
        ),
        "keys": then(send("'camera', {mode: 'free'}"), key("?")),
    }


def copy_of(trace: Path, folder: Path) -> Path:
    """The trace in another folder: reviews are stored beside it."""
    return Path(shutil.copy(trace, folder))


def main() -> None:
    """Make the gallery: light in the large window, dark in the small one."""
    reader = argparse.ArgumentParser(description=__doc__)
    reader.add_argument("trace", type=Path)
    reader.add_argument("--scenes", default="")
    reader.add_argument("--out", type=Path, required=True)
    reader.add_argument("--only", default="", help="names of views, with commas between")
    given = reader.parse_args()
    setting = Setting(source="builtin", scenes=given.scenes, profile="vlnce")
    for dark, size in ((False, LARGE), (True, SMALL)):
        with (
            tempfile.TemporaryDirectory() as folder,
            chromium() as browser,
            inspector(opened_traces((copy_of(given.trace, Path(folder)),), setting)) as (url, _),
            visit(browser, url, size=size, dark=dark) as seen,
        ):
            seen.until_node("/scene/section")
            seen.until("s.timeline.regret.length")
            for name, arrange in shots(seen).items():
                theme = "dark" if dark else "light"
                if given.only and name not in given.only.split(","):
                    continue
                picture(given.out, f"{name}-{theme}", seen, arrange=arrange)


if __name__ == "__main__":
    main()
