"""One frame for the pages about runs, and the signs that they share."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import Any
from urllib.parse import quote, urlencode

import jinja2

from app.pages.index.columns import Value
from app.pages.index.drawing import map_of
from c2nav_engine.experiments.tags.rules import TAGS

MENU = {
    "run": "Run",
    "cases": "Cases",
    "compare": "Compare",
    "agreement": "Agreement",
    "inspector": "Inspector",
}
"""Pages that can stand behind one port, in the order in which the menu names them."""

ABOUT_RUNS = ("run", "cases", "compare")
"""The pages of this package that need nothing but a folder of runs."""


def figure_words(value: Value, digits: int = 1) -> str:
    """A number of a row for a page; an en dash where it is missing, ∞ where out of reach."""
    if value is None:
        return "–"
    if isinstance(value, float):
        return "∞" if math.isinf(value) else f"{value:.{digits}f}"
    return str(value)


def link(path: str, **fields: Any) -> str:
    """A relative address with its fields; empty ones are left out."""
    given = {name: value for name, value in fields.items() if value not in ("", None)}
    return f"{path}?{urlencode(given, quote_via=quote)}" if given else path


_TEMPLATES = jinja2.Environment(
    loader=jinja2.PackageLoader("app.pages"),
    autoescape=True,
    undefined=jinja2.StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)
_TEMPLATES.filters["figure"] = figure_words
_TEMPLATES.filters["json"] = json.dumps
_SHARED = {"MENU": MENU, "link": link, "map_of": map_of, "TAGS": TAGS}


def render(template: str, **facts: Any) -> str:
    """A whole document."""
    return _TEMPLATES.get_template(template).render(**_SHARED, **facts)


def framed(template: str, *, here: str, menu: Sequence[str], **facts: Any) -> str:
    """A page in the frame that all of them share.

    Args:
        template: Its file.
        here: Its own name in `MENU`.
        menu: The pages that are served with it: the frame links to no other.
        **facts: What the template shows.
    """
    return render(template, here=here, menu=menu, **facts)
