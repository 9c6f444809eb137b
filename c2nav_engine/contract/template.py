"""Prompt templates: text files with ids and hashes, the only prose that a model is sent.

A file `templates/NAME/VERSION.txt` has the id `NAME/VERSION`. It holds the body and, below the
line `=== reminder`, the one-line format reminder of the repair attempt. Placeholders in braces:

| placeholder      | becomes                                                        |
|------------------|----------------------------------------------------------------|
| `{instruction}`  | the whole instruction, verbatim, in a marked span              |
| `{leg}`          | the active leg, verbatim, in a marked span                     |
| `{sketch}`       | the route sketch's words, or nothing                           |
| `{context}`      | the shared pictures, each after its words                      |
| `{alternatives}` | the labelled alternatives, each label right before its picture |
| `{labels}`       | the offered labels, in presentation order                      |

A published file is never edited: new words get a new version, so that a recorded id and hash
always name the same text.
"""

from __future__ import annotations

import functools
import hashlib
from dataclasses import dataclass
from importlib import resources
from importlib.resources.abc import Traversable

from c2nav_engine.errors import UsageError

_REMINDER = "\n=== reminder\n"


@dataclass(frozen=True, slots=True)
class Template:
    """One prompt template.

    Attributes:
        id: "seeing/1".
        text: The whole file.
        sha256: Hex digest of the file's bytes.
    """

    id: str
    text: str
    sha256: str

    @property
    def body(self) -> str:
        """What every attempt sends."""
        return self.text.partition(_REMINDER)[0].strip()

    @property
    def reminder(self) -> str:
        """The one line that the repair attempt adds."""
        return self.text.partition(_REMINDER)[2].strip()


@functools.cache
def load(template_id: str) -> Template:
    """The template of that id; raises `UsageError` for a name that does not exist."""
    if template_id not in ids():
        message = f"expected a prompt template among {', '.join(ids())}; came {template_id!r}"
        raise UsageError(message)
    name, version = template_id.split("/")
    data = _folder().joinpath(name, f"{version}.txt").read_bytes()
    return Template(template_id, data.decode("utf-8"), hashlib.sha256(data).hexdigest())


@functools.cache
def ids() -> tuple[str, ...]:
    """Every template id that ships, sorted."""
    return tuple(
        sorted(
            f"{folder.name}/{file.name.removesuffix('.txt')}"
            for folder in _folder().iterdir()
            if folder.is_dir()
            for file in folder.iterdir()
            if file.name.endswith(".txt")
        )
    )


def texts() -> dict[str, str]:
    """Template id → text, for the record of a run."""
    return {template_id: load(template_id).text for template_id in ids()}


def _folder() -> Traversable:
    return resources.files("c2nav_engine.contract") / "templates"
