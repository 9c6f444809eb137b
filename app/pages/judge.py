"""The page on which a person judges blind: one still document, the same for everybody."""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Mapping, Sequence
from typing import Any

import jinja2

from c2nav_engine.contract.prompt import Prompt
from c2nav_engine.contract.question import Form

_TEMPLATES = jinja2.Environment(
    loader=jinja2.PackageLoader("app.pages"), autoescape=True, undefined=jinja2.StrictUndefined
)


def judge_page() -> str:
    """The document; it holds nothing of any study."""
    return _TEMPLATES.get_template("judge.html.j2").render()


def packed_page(study: Mapping[str, Any], *, scripts: Sequence[str], style: str) -> str:
    """The same page in one file that asks nothing of any network.

    Args:
        study: What its script reads.
        scripts: The scripts' texts, in the order in which they run.
        style: The style sheet's text.
    """
    # Inside a script element only "<" could end it; the template marks all three as they are.
    text = json.dumps(study, ensure_ascii=False).replace("<", "\\u003c")
    return _TEMPLATES.get_template("packed.html.j2").render(
        study=text,
        scripts=scripts,
        style=style,
        sources=" ".join(f"'{_digest(script)}'" for script in scripts),
        style_source=_digest(style),
    )


def _digest(text: str) -> str:
    return f"sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}"


def question_json(prompt: Prompt) -> dict[str, Any]:
    """What the model was sent, and nothing else: words, pictures in their bytes, labels.

    Keys, digests, slots and seeds stay behind: they are the controller's, not the question's.
    """
    return {
        "parts": [
            {"text": part}
            if isinstance(part, str)
            else {
                "jpeg": base64.b64encode(part.jpeg).decode("ascii"),
                "width": part.width_px,
                "height": part.height_px,
            }
            for part in prompt.parts
        ],
        "labels": [label for label, _ in prompt.labels],
        "one": prompt.form is Form.ACTION,
    }
