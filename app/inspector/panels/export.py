"""What can be taken away: this view's address, and the commands that make files of this branch."""

from __future__ import annotations

import shlex

import viser
from markupsafe import Markup

from app.inspector import markup as m
from app.inspector.panels.protocol import Dispatch, Html, Update
from app.session.snapshot import Snapshot
from app.session.wording import ranking


def build(gui: viser.GuiApi, _dispatch: Dispatch) -> Update:
    """Build the panel."""
    block = Html(gui)
    return lambda snapshot: block.show(_block(snapshot))


def _block(snapshot: Snapshot) -> str:
    branch = snapshot.branch
    ended = branch.footer is not None
    return m.padded(
        m.heading("This view"),
        Markup('<div class="c2-buttons">{}</div>').format(
            Markup('<button type="button" class="c2-link" data-copy="address">{}</button>').format(
                "Copy the address"
            )
        ),
        m.heading("Figure for a paper"),
        Markup('<div class="c2-buttons">{}</div>').format(
            Markup('<button type="button" class="c2-link" data-open="figure">{}</button>').format(
                "Figure…"
            )
        ),
        m.heading("This branch"),
        m.facts(
            [
                ("trace", branch.trace + ("" if ended else ", once it has ended")),
                ("sha256", branch.trace_sha256[:16]),
                ("forked at", str(branch.fork_decision) if branch.fork_decision >= 0 else ""),
            ]
        ),
        m.heading("As files"),
        *(
            [_command(words, line) for words, line in commands_of(snapshot)]
            if ended
            else [m.note("Their commands stand here once the episode has ended")]
        ),
    )


def commands_of(snapshot: Snapshot) -> list[tuple[str, str]]:
    """What each command makes, and the command."""
    trace = shlex.quote(snapshot.branch.trace)
    number = max(snapshot.here.decision, 0)
    lines = [
        ("table of decisions", f"c2nav trace export {trace} --to parquet --out decisions.parquet"),
        ("one page to share", f"c2nav trace export {trace} --to html --out episode.html"),
        ("video", f"c2nav trace export {trace} --to video --out episode.mp4"),
        (
            "figure of this decision",
            f"c2nav figure {trace} --decisions {number} --kind strip "
            "--width 7.16in --out figure.pdf",
        ),
        ("the question as it was sent", f"c2nav question {trace} --at {number}"),
    ]
    if not snapshot.draft.empty and snapshot.decision is not None:
        order = shlex.quote(ranking(snapshot.draft.tiers, snapshot.decision.letters))
        lines.append(
            (
                "your ranking as a fork",
                f"c2nav fork {trace} --at {number} --ranking {order} --out fork.mcap",
            )
        )
    return lines


def _command(words: str, line: str) -> Markup:
    return Markup(
        '<p class="c2-note">{}</p><button type="button" class="c2-code" data-copy="{}" '
        'title="copy">{}</button>'
    ).format(words, line, line)
