"""Printing for machines: one JSON object on standard output, nothing else there."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping


def print_json(value: Mapping[str, object]) -> None:
    """Print one object on one line."""
    sys.stdout.write(json.dumps(value, ensure_ascii=False) + "\n")
