"""Answers on disk, by the full request: for repeated runs on a paid or slow model.

Off by default, because a cached answer hides a sampling model's spread; a record says of each
answer whether it came from here. One small JSON file per request, written whole or not at all, so
that several processes may share a folder.
"""

from __future__ import annotations

import hashlib
import json
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import cast

from c2nav_engine.contract.outcome import Empty, Refused, Truncated
from c2nav_engine.contract.prompt import Prompt, Reply

_OUTCOMES = {"refused": Refused(), "truncated": Truncated(), "empty": Empty()}
"""Finished outcomes worth keeping; a transport failure is asked again."""


class AnswerCache:
    """Replies by request hash, model and everything that shapes its answers.

    Args:
        folder: Where the files lie; made when first written.
        asked: Who is asked and how: adapter, model, sampling, every setting but the key.
    """

    def __init__(self, folder: Path, asked: Mapping[str, str]) -> None:
        self._folder = folder
        self._asked = json.dumps(dict(sorted(asked.items())))

    def get(self, prompt: Prompt) -> Reply | None:
        """The kept reply, marked as cached, or None."""
        try:
            kept = json.loads(self._path(prompt).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None
        return _reply(cast("dict[str, object]", kept)) if isinstance(kept, dict) else None

    def put(self, prompt: Prompt, reply: Reply) -> None:
        """Keep a reply that came from the model itself."""
        names = [name for name, outcome in _OUTCOMES.items() if outcome == reply.outcome]
        if reply.cached or (reply.outcome is not None and not names):
            return
        kept = {
            "request_sha256": prompt.request_sha256,
            "asked": self._asked,
            "outcome": names[0] if names else "",
            "text": reply.text,
            "tokens_in": reply.tokens_in,
            "tokens_out": reply.tokens_out,
            "model": reply.model,
        }
        self._write(self._path(prompt), json.dumps(kept))

    def _path(self, prompt: Prompt) -> Path:
        key = hashlib.sha256(f"{prompt.request_sha256}\n{self._asked}".encode()).hexdigest()
        return self._folder / key[:2] / f"{key}.json"

    def _write(self, path: Path, text: str) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent, suffix=".part")
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(text)
        Path(name).replace(path)


def _reply(kept: Mapping[str, object]) -> Reply | None:
    name, text = kept.get("outcome"), kept.get("text")
    if not isinstance(text, str) or name not in {"", *_OUTCOMES}:
        return None
    return Reply(
        outcome=_OUTCOMES[str(name)] if name else None,
        text=text,
        tokens_in=_count(kept.get("tokens_in")),
        tokens_out=_count(kept.get("tokens_out")),
        model=str(kept.get("model") or ""),
        cost_usd=0.0,
        cached=True,
    )


def _count(value: object) -> int | None:
    return value if isinstance(value, int) else None
