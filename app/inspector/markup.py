"""HTML for panels: everything that comes from data is escaped, everything else is ours."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence

from markupsafe import Markup

from app.session.commands import Command

NOTHING = Markup("")


def join(pieces: Iterable[Markup | str]) -> Markup:
    """Pieces one after the other."""
    return Markup("").join(pieces)


def heading(text: str) -> Markup:
    """A small grey heading."""
    return Markup('<h3 class="c2-h">{}</h3>').format(text)


def chips(words: Iterable[str]) -> Markup:
    """Short facts in a row."""
    return Markup('<div class="c2-chips">{}</div>').format(
        join(Markup('<span class="c2-chip">{}</span>').format(word) for word in words if word)
    )


def facts(rows: Iterable[tuple[str, str | Markup]]) -> Markup:
    """Name and value, one pair a line; pairs without a value are left out."""
    lines = [Markup("<dt>{}</dt><dd>{}</dd>").format(name, value) for name, value in rows if value]
    return Markup('<dl class="c2-facts">{}</dl>').format(join(lines)) if lines else NOTHING


def table(head: Sequence[str], rows: Iterable[Sequence[str | Markup]]) -> Markup:
    """A table with one header row."""
    top = join(Markup("<th>{}</th>").format(cell) for cell in head)
    body = join(
        Markup("<tr>{}</tr>").format(join(Markup("<td>{}</td>").format(cell) for cell in row))
        for row in rows
    )
    return Markup(
        '<table class="c2-table"><thead><tr>{}</tr></thead><tbody>{}</tbody></table>'
    ).format(top, body)


def wide(content: Markup) -> Markup:
    """Something that may be wider than its panel: it scrolls within it."""
    return Markup('<div class="c2-wide">{}</div>').format(content)


def quote(text: str | Markup) -> Markup:
    """Literal prompt text."""
    return Markup('<pre class="c2-pre">{}</pre>').format(text)


def note(text: str) -> Markup:
    """A quiet sentence."""
    return Markup('<p class="c2-note">{}</p>').format(text)


def fault(text: str) -> Markup:
    """Something that went wrong, with its sign."""
    return Markup('<span class="c2-fault">✕</span> {}').format(text)


def picture(sha256: str, *, alt: str, size_px: int = 0) -> Markup:
    """A picture in the bytes that were sent."""
    style = Markup(' style="width:{}px"').format(size_px) if size_px else NOTHING
    return Markup('<img class="c2-img" src="api/image/{}.jpg" alt="{}"{} loading="lazy">').format(
        sha256, alt, style
    )


def action(
    label: str | Markup,
    command: Command,
    *,
    title: str = "",
    pressed: bool = False,
    primary: bool = False,
) -> Markup:
    """A button that sends a command; the page's script adds the state's id."""
    body = json.dumps(command.model_dump(exclude={"id", "tab"}))
    return Markup(
        '<button type="button" class="{}" data-command="{}" title="{}" aria-pressed="{}">'
        "{}</button>"
    ).format(
        "c2-link c2-go" if primary else "c2-link",
        body,
        title,
        "true" if pressed else "false",
        label,
    )


def padded(*pieces: Markup | str) -> str:
    """The content of one `add_html`."""
    return str(Markup('<div class="c2-pane">{}</div>').format(join(pieces)))
