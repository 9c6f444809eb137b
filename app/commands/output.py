"""What commands write: JSON on standard output, and files and folders that are checked first."""

from __future__ import annotations

import json
import os
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

from c2nav_engine.errors import UsageError
from c2nav_engine.traces.apart import keep_apart


def print_json(value: Mapping[str, object]) -> None:
    """Print one object on one line; a command with `--json` prints nothing else there."""
    sys.stdout.write(json.dumps(value, ensure_ascii=False) + "\n")


def check_file(out: Path, *inputs: Path) -> None:
    """Refuse, before any work, a file that cannot be written or that is an input; `UsageError`.

    Nothing is made. Devices are refused too: most formats are written beside and then renamed.
    """
    keep_apart(out, *inputs)
    if out.is_dir():
        message = f"expected a file to write, came the folder {out}; name a file in it"
        raise UsageError(message)
    if os.path.lexists(out) and not (out.is_file() or out.is_symlink()):
        message = f"expected a file to write, came {out}, which is a device; name a plain file"
        raise UsageError(message)
    if out.is_file() and not os.access(out, os.W_OK):
        message = f"expected a file to write, came {out}, which is read-only; name another"
        raise UsageError(message)
    _check_place(out.parent, out)


def check_folder(out: Path) -> None:
    """Refuse, before any work, a folder that cannot be made or written to; `UsageError`."""
    if os.path.lexists(out) and not out.is_dir():
        message = f"expected a folder to write to, came {out}, which is a file; name another"
        raise UsageError(message)
    _check_place(out, out)


def _check_place(folder: Path, out: Path) -> None:
    """Try the nearest folder that exists: missing ones are made in it later."""
    try:
        while not folder.exists() and folder != folder.parent:
            folder = folder.parent
        # Permissions alone do not tell: /proc can be written to by nobody, whatever they say.
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        why = error.strerror or error
        message = f"expected a place to write to, came {out} ({folder}: {why}); name another"
        raise UsageError(message) from None
