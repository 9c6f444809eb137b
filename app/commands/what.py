"""What words of the command line name: traces, a run, a folder of runs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from c2nav_engine.errors import UsageError


def trace_files(what: Sequence[str]) -> tuple[Path, ...]:
    """The traces that the words name: files, or the run folder's; () for a source of episodes."""
    found: list[Path] = []
    for word in what:
        path = Path(word)
        if path.is_dir():
            inside = sorted((path / "traces").glob("*.mcap")) or sorted(path.glob("*.mcap"))
            if not inside:
                message = f"expected a run folder with traces, came {word}: no .mcap in it"
                raise UsageError(message)
            found += inside
        elif path.suffix == ".mcap" or word.endswith(".mcap.part"):
            found.append(path)
        elif len(what) > 1:
            message = f"expected traces or run folders, or one source; came {' '.join(what)}"
            raise UsageError(message)
    return tuple(found)


def folder_of_runs(what: Sequence[str]) -> Path | None:
    """The one folder that was named, where it is a run or holds runs; None otherwise."""
    root = Path(what[0])
    if len(what) != 1 or not root.is_dir():
        return None
    inside = ("manifest.json", "*/manifest.json", "*.mcap", "traces/*.mcap", "*/traces/*.mcap")
    return root if any(any(root.glob(pattern)) for pattern in inside) else None


def traces_under(root: Path) -> tuple[Path, ...]:
    """Finished traces of a run, or of all runs in a folder."""
    for pattern in ("traces/*.mcap", "*.mcap", "*/traces/*.mcap"):
        found = sorted(root.glob(pattern))
        if found:
            return tuple(found)
    return ()
