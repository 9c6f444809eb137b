"""The used part of each font inside an SVG: its text looks the same on every machine."""

from __future__ import annotations

import base64
import importlib
import io
import re
from typing import Any

_TEXT = re.compile(r"<text[^>]*>([^<]*)</text>")
_FAMILY = "DejaVu Sans"
_WEIGHTS = (400, 700)


def with_fonts(svg: str) -> str:
    """The SVG with an `@font-face` per weight that holds the glyphs of its words."""
    letters = {ord(letter) for words in _TEXT.findall(svg) for letter in _plain(words)}
    if not letters:
        return svg
    faces = "".join(_face(weight, letters) for weight in _WEIGHTS)
    return svg.replace("<defs>", f"<defs>\n  <style>{faces}</style>", 1)


def _plain(words: str) -> str:
    for escaped, letter in (("&lt;", "<"), ("&gt;", ">"), ("&quot;", '"'), ("&amp;", "&")):
        words = words.replace(escaped, letter)
    return words


def _face(weight: int, letters: set[int]) -> str:
    data = base64.b64encode(_subset(weight, letters)).decode()
    return (
        f"@font-face{{font-family:'{_FAMILY}';font-weight:{weight};"
        f"src:url(data:font/woff;base64,{data}) format('woff')}}"
    )


def _subset(weight: int, letters: set[int]) -> bytes:
    """fontTools, which matplotlib depends on, has no types; this function is where we meet it."""
    subset: Any = importlib.import_module("fontTools.subset")
    tt: Any = importlib.import_module("fontTools.ttLib")
    manager: Any = importlib.import_module("matplotlib.font_manager")
    found = manager.findfont(manager.FontProperties(family=_FAMILY, weight=weight))
    font = tt.TTFont(found, recalcTimestamp=False)
    options = subset.Options(flavor="woff", layout_features=[], hinting=False, notdef_outline=True)
    options.drop_tables += ["FFTM"]  # the editor's own timestamps
    cutter = subset.Subsetter(options)
    cutter.populate(unicodes=sorted(letters))
    cutter.subset(font)
    font.flavor = "woff"
    data = io.BytesIO()
    font.save(data, reorderTables=True)
    return data.getvalue()
