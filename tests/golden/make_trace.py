"""Writes the golden trace of the current schema version, unless it is there."""

from __future__ import annotations

import dataclasses
import enum
import json
import sys
from hashlib import sha256
from pathlib import Path
from typing import Any

from c2nav_engine.contract.question import Picture
from c2nav_engine.runner.recorded import Trace, read_trace
from c2nav_engine.traces.topics import SCHEMA_VERSION
from tests.helpers.exchanges import write_fake

FOLDER = Path(__file__).parent


def plain(value: Any) -> Any:
    """Anything in an exchange as JSON values; types by name, bytes by digest."""
    if isinstance(value, Picture):
        return {"picture": value.sha256, "held": bool(value.jpeg)}
    if isinstance(value, bytes):
        return sha256(value).hexdigest() if value else ""
    if isinstance(value, enum.Enum):
        return value.value
    if dataclasses.is_dataclass(value):
        # A prompt's question is the decision's own; told once is enough.
        names = [each.name for each in dataclasses.fields(value) if each.name != "question"]
        if type(value).__name__ == "Ask":
            names.append("question")
        fields = {name: plain(getattr(value, name)) for name in sorted(names)}
        return {"type": type(value).__name__, **fields}
    if isinstance(value, dict):
        return {str(key): plain(each) for key, each in value.items()}
    if isinstance(value, tuple | list):
        return [plain(each) for each in value]
    return value


def story(trace: Trace) -> dict[str, Any]:
    """What a trace says, for comparison in years to come."""
    return {
        "header": plain(dataclasses.replace(trace.header, templates={})),
        "footer": plain(trace.footer),
        "exchanges": [plain(exchange) for exchange in trace.exchanges],
    }


def main() -> None:
    """Write the pair."""
    path = FOLDER / f"trace-v{SCHEMA_VERSION}.mcap"
    if path.exists():
        sys.exit(f"{path} is there: golden traces are never written anew")
    write_fake(path, cycles=4, side_px=16)
    text = json.dumps(story(read_trace(path)), indent=1, ensure_ascii=False, sort_keys=True)
    path.with_suffix(".json").write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
