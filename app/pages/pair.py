"""Two recorded episodes as the compare page shows them."""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from app.pages.index.drawing import Map, drawing_of, map_of
from app.pages.library import Library
from app.pages.run import Difference, differences
from c2nav_engine.contract.prompt import Part as PromptPart
from c2nav_engine.contract.render import render as rendered
from c2nav_engine.experiments.pairing.alignment import Axis, Line, line_of, stands
from c2nav_engine.experiments.pairing.parting import Parting, answer_of, parting, said_words
from c2nav_engine.experiments.tags.account import Account
from c2nav_engine.navigator.requests import Look, Seen
from c2nav_engine.runner.recorded import open_trace

MAP_PX = (560.0, 400.0)
_OWN = ("run", "episode", "templates", "legs", "config_sha256")
"""Parts of a header that are told elsewhere, or that name the recording and nothing else."""


@dataclass(frozen=True, slots=True)
class Side:
    """One of the two.

    Attributes:
        name: "A" or "B".
        sha256: Digest of its trace.
        account: The episode.
        line: What it can be aligned by.
        entry: What the inspector calls its trace.
        ending: How it came out.
    """

    name: str
    sha256: str
    account: Account
    line: Line
    entry: str
    ending: str


@dataclass(frozen=True, slots=True)
class Word:
    """A run of words that both prompts have, or one of them."""

    text: str
    side: str


@dataclass(frozen=True, slots=True)
class PairView:
    """Everything the page draws.

    Attributes:
        sides: A and B.
        parted: Where they part; None when they never do.
        header: What differs in how they were made.
        prompt: The prompts at the parting, word by word.
        same_prompt: Whether they are the same.
        answers: What each answered there, in each order.
        maps: Both ways in one frame.
        data: For the page's script: stands by axis, and each step's place, picture and figures.
    """

    sides: tuple[Side, Side]
    parted: Parting | None
    header: tuple[Difference, ...]
    prompt: tuple[Word, ...]
    same_prompt: bool
    answers: tuple[tuple[str, ...], tuple[str, ...]]
    maps: tuple[Map, Map]
    data: str


def pair_of(library: Library, a: str, b: str) -> PairView:
    """Set two traces side by side; raises `InputError` or `TraceError`."""
    sides = (_side(library, "A", a), _side(library, "B", b))
    first, second = (side.account for side in sides)
    parted = parting(first.exchanges, second.exchanges)
    numbers = parted.decision if parted else (0, 0)
    prompts = [_prompt(each, n) for each, n in zip((first, second), numbers, strict=True)]
    maps = _maps(sides)
    return PairView(
        sides=sides,
        parted=parted,
        header=tuple(differences(_made(first), _made(second))),
        prompt=tuple(worded(prompts[0], prompts[1])) if parted else (),
        same_prompt=prompts[0] == prompts[1],
        answers=(_answers(first, numbers[0]), _answers(second, numbers[1])),
        maps=maps,
        data=json.dumps(_data(sides, parted, maps), separators=(",", ":")),
    )


def worded(one: str, other: str) -> Iterator[Word]:
    """Two texts word by word: what both say, what only A says, what only B says."""
    a, b = _tokens(one), _tokens(other)
    for kind, i, j, k, m in difflib.SequenceMatcher(None, a, b, autojunk=False).get_opcodes():
        if kind == "equal":
            yield Word("".join(a[i:j]), "")
        else:
            yield from (Word("".join(a[i:j]), "A"),) if j > i else ()
            yield from (Word("".join(b[k:m]), "B"),) if m > k else ()


def _tokens(text: str) -> list[str]:
    """Words with the blanks that follow them, so that joining them gives the text."""
    tokens: list[str] = []
    for line in text.splitlines(keepends=True):
        tokens += [f"{word} " for word in line.rstrip("\n").split(" ")]
        tokens[-1] = tokens[-1][:-1] + line[len(line.rstrip("\n")) :]
    return tokens


def _side(library: Library, name: str, sha256: str) -> Side:
    case = library.case(sha256)
    path = library.trace(case)
    with open_trace(path) as trace:
        account = Account(trace.header, trace.footer, tuple(trace.exchanges()))
    ending = str(case.values["ending"])
    return Side(name, sha256, account, line_of(account), str(path), ending)


def _made(account: Account) -> Mapping[str, Any]:
    """How an episode was made, as plain values; prompts by name and text."""
    header = asdict(account.header)
    told = {name: value for name, value in header.items() if name not in _OWN}
    return told | {"template": header["templates"], "legs": list(account.header.legs)}


def _prompt(account: Account, number: int) -> str:
    """What was sent at a decision in its first order; pictures by digest."""
    for exchange, ask in account.questions():
        if exchange.decision == number:
            queries = exchange.ranked.queries if exchange.ranked else ()
            parts = queries[0].prompt.parts if queries else rendered(ask.question).parts
            return "\n".join(map(_part, parts))
    return ""


def _part(part: PromptPart) -> str:
    return part if isinstance(part, str) else f"[picture {part.sha256[:12]}]"


def _answers(account: Account, number: int) -> tuple[str, ...]:
    for exchange, _ in account.questions():
        if exchange.decision == number and exchange.ranked is not None:
            return tuple(
                f"order {query.prompt.order + 1}: {said_words(query.outcome)}"
                for query in exchange.ranked.queries
            )
    return ()


# ---------------------------------------------------------------- the map and the script's data


def _maps(sides: Sequence[Side]) -> tuple[Map, Map]:
    """Both ways in one frame: each is drawn into what holds both."""
    # Every step is drawn: thinned ways of different lengths would seem to part before they do.
    drawings = [
        json.loads(drawing_of(side.account, most=len(side.account.way) + 1)) for side in sides
    ]
    within = [spot for each in drawings for spot in (*each["way"], *each["reference"])]
    width, height = MAP_PX
    made = [
        map_of(json.dumps(each), width=width, height=height, within=within) for each in drawings
    ]
    assert made[0] is not None
    assert made[1] is not None
    return made[0], made[1]


def _data(sides: Sequence[Side], parted: Parting | None, maps: tuple[Map, Map]) -> dict[str, Any]:
    lines = [side.line for side in sides]
    at = parted.step if parted else (lines[0].last, lines[1].last)
    steps = [exchange.step for exchange, _ in sides[0].account.questions()]
    shared = steps if parted is None else steps[: max(0, parted.decision[0] + 1)]
    known = all(line.along_m for line in lines)
    return {
        "axes": {
            axis.value: [
                [stand.words, stand.first, stand.second]
                for stand in stands(lines[0], lines[1], axis, shared=shared, parted=at[0])
            ]
            for axis in Axis
            if known or axis is not Axis.DISTANCE
        },
        "parted": len([step for place, step in enumerate(shared) if step < at[0] or not place]),
        "sides": [_steps(side, each) for side, each in zip(sides, maps, strict=True)],
    }


def _steps(side: Side, drawn: Map) -> dict[str, Any]:
    pictures = _pictures(side.account)
    shown, steps = "", list[list[Any]]()
    for point, leg in zip(side.account.way, side.line.legs, strict=True):
        shown = pictures.get(point.step, shown)
        x, y = drawn.at((point.pose.position_m[0], point.pose.position_m[2]))
        goal_m = None if point.goal_m is None else round(point.goal_m, 2)
        steps.append([x, y, goal_m if goal_m != float("inf") else None, leg + 1, shown])
    return {"trace": side.sha256, "steps": steps, "decisions": _decisions(side.account)}


def _pictures(account: Account) -> dict[int, str]:
    """Step → digest of the front view that was last read there."""
    found: dict[int, str] = {}
    for exchange in account.exchanges:
        if isinstance(exchange.request, Look) and isinstance(exchange.response, Seen):
            for view in exchange.response.views:
                if view.key in ("front", "ring0"):
                    found[exchange.step] = view.picture.sha256
    return found


def _decisions(account: Account) -> list[list[Any]]:
    """(step, number, slot, what was committed) of every question."""
    return [
        [exchange.step, exchange.decision, ask.question.slot.value, said_words(answer_of(exchange))]
        for exchange, ask in account.questions()
    ]
