"""One file that opens from disk: the inspector's own elements over recorded states."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from pathlib import Path

from app.exports.family import Member, family_of
from app.exports.licence import LicenceRule, licence_words
from app.exports.tale import Assessed, tale_of, title_of
from app.figures.plan import Plan
from app.session.pictures import Album
from app.session.snapshot import Assessment
from c2nav_engine.errors import InternalError
from c2nav_engine.runner.recorded import Trace

_PAGE = Path(__file__).with_name("page")

_ELEMENTS = ("look.js", "route-strip.js", "rank-strip.js", "timeline-bar.js", "image-pair.js")
"""The inspector's own modules; ours stand in for its store, which would ask a server."""

_IMPORT = re.compile(r"""(\bfrom\s+|\bimport\s+)(["'])\./([\w-]+\.js)\2""")

_DIGEST = re.compile(r'"(?:sha)": "([0-9a-f]{64})"')

POLICY = "; ".join(
    (
        "default-src 'none'",
        "script-src 'unsafe-inline' 'unsafe-eval' data: blob:",
        "style-src 'unsafe-inline'",
        "img-src data: blob:",
        "font-src data:",
        "connect-src data: blob:",
        "worker-src data: blob:",
        "frame-src 'self' data: blob:",
        "form-action 'none'",
        "base-uri 'none'",
    )
)
"""Nothing can be fetched, whatever the page holds; viser's view needs eval and workers."""


@dataclass(frozen=True, slots=True)
class HtmlOptions:
    """What goes into the file.

    Attributes:
        licensed_pictures: Whether pictures of licensed scenes come along.
        no_scene: Whether the 3-D view is left out on purpose.
        rule: When a scene counts as licensed.
    """

    licensed_pictures: bool = False
    no_scene: bool = False
    rule: LicenceRule = field(default_factory=LicenceRule)


@dataclass(frozen=True, slots=True)
class Setting:
    """What stands around the runs, as far as it is to be had.

    Attributes:
        plan: Floor and walls for the map.
        world: viser's own page of the scene, complete; "" for none.
        why_not: Why there is no 3-D view; "" where there is one.
        assessed: Digest of a trace → decision → what the truth says of it, for suspects.
    """

    plan: Plan = field(default_factory=Plan)
    world: str = ""
    why_not: str = ""
    assessed: Assessed = field(default_factory=dict[str, Mapping[int, Assessment]])


@dataclass(frozen=True, slots=True)
class Page:
    """What was written.

    Attributes:
        size_bytes: Of the file.
        pictures: How many it holds.
        left_out: What it lacks and why, one sentence each.
    """

    size_bytes: int
    pictures: int
    left_out: tuple[str, ...]


def licensed(traces: Sequence[Trace], options: HtmlOptions) -> bool:
    """Whether the scene's pictures, mesh and floor plan must stay out of the file."""
    if options.licensed_pictures:
        return False
    return any(options.rule.licensed(trace.header) for trace in traces)


def export_html(
    traces: Sequence[Trace],
    out: Path,
    *,
    options: HtmlOptions | None = None,
    setting: Setting | None = None,
) -> Page:
    """Write a recording and its forks as one page.

    Args:
        traces: One family, in any order.
        out: The file.
        options: What goes in.
        setting: Floor plan and 3-D view; left out for a licensed scene.

    Raises:
        UsageError: The traces are not of one family.
    """
    options, setting = options or HtmlOptions(), setting or Setting()
    members = family_of(traces)
    closed = licensed(traces, options)
    tale = tale_of(members, Plan() if closed else setting.plan, setting.assessed)
    text = json.dumps(tale, ensure_ascii=False)
    pictures = {} if closed else dict(_pictures(members, set(_DIGEST.findall(text))))
    left_out = tuple(_left_out(members, options, setting, closed=closed, found=len(pictures)))
    world = "" if closed else setting.world
    body = _assembled(
        {
            "title": escape(f"C²Nav · {title_of(members[0].story)}"),
            "policy": POLICY,
            "style": _asset("app.css") + _read("page.css"),
            "modules": _modules(),
            "tale": _safe(json.dumps({**tale, "left_out": left_out}, ensure_ascii=False)),
            "pictures": json.dumps(pictures),
            "world": _safe(json.dumps(world, ensure_ascii=False)),
        }
    )
    data = body.encode()
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_bytes(data)
    return Page(len(data), len(pictures), left_out)


def _left_out(
    members: Sequence[Member],
    options: HtmlOptions,
    setting: Setting,
    *,
    closed: bool,
    found: int,
) -> Iterator[str]:
    if closed:
        licence = licence_words(members[0].story.header)
        yield (
            f"Pictures, 3-D view and floor plan are left out: the scene's licence is {licence}. "
            "The words, answers and the way walked are complete."
        )
        return
    if not found:
        yield "The trace holds its pictures as digests only."
    if options.no_scene:
        yield "The 3-D view was left out on request."
    elif not setting.world:
        yield f"No 3-D view: {setting.why_not or 'the scene is not here'}."


def _pictures(members: Sequence[Member], wanted: Iterable[str]) -> Iterator[tuple[str, str]]:
    """Digest → the bytes as they were sent, each once, in the order of their digests."""
    album = Album()
    for member in members:
        album.take(member.branch.branch_id, member.branch.exchanges, None)
    for sha256 in sorted(wanted):
        picture = album.get(sha256)
        if picture is not None and picture.jpeg:
            yield sha256, base64.b64encode(picture.jpeg).decode()


# ------------------------------------------------------------ putting it together


def _assembled(parts: Mapping[str, str]) -> str:
    """The page with every `{{name}}` filled in one pass, so that no part is read as a template."""
    return re.sub(r"\{\{(\w+)\}\}", lambda found: parts[found[1]], _read("page.html"))


def _modules() -> str:
    """An import map from bare names to the modules themselves."""
    sources = {name: _asset(name) for name in _ELEMENTS}
    sources |= {path.name: path.read_text("utf-8") for path in sorted(_PAGE.glob("*.js"))}
    imports = {f"c2/{name}": _as_data(text) for name, text in sources.items()}
    return json.dumps({"imports": imports})


def _as_data(text: str) -> str:
    """A module as a data URL; siblings go by bare names, which a data URL can resolve."""
    named = _IMPORT.sub(r"\1\2c2/\3\2", text)
    return "data:text/javascript;base64," + base64.b64encode(named.encode()).decode()


def _safe(text: str) -> str:
    """JSON that no HTML parser can take for markup."""
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def _read(name: str) -> str:
    return (_PAGE / name).read_text(encoding="utf-8")


def _asset(name: str) -> str:
    """One of the inspector's own files: inside the package where installed, else beside it."""
    app = Path(__file__).resolve().parents[1]
    for folder in (app / "_web_assets", app.parent / "web_assets"):
        if (folder / name).is_file():
            return (folder / name).read_text(encoding="utf-8")
    message = f"expected the file web_assets/{name} beside {app}; install the package again"
    raise InternalError(message)
