"""What can be taken away: the trace, and the address of this very view."""

from __future__ import annotations

import viser

from app.inspector import markup as m
from app.inspector.panels.protocol import Dispatch, Html, Update
from app.session.snapshot import Snapshot


def build(gui: viser.GuiApi, dispatch: Dispatch) -> Update:  # noqa: ARG001 # links do the work
    """Build the panel."""
    block = Html(gui)
    return lambda snapshot: block.show(_block(snapshot))


def _block(snapshot: Snapshot) -> str:
    branch = snapshot.branch
    return m.padded(
        m.heading("This branch"),
        m.facts(
            [
                ("trace", branch.source),
                ("sha256", branch.trace_sha256[:16]),
                ("parent", branch.parent),
            ]
        ),
        m.note("The address of this page restores this view"),
    )
