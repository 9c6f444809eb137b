"""The tree of branches, with outcomes and cost."""

from __future__ import annotations

import viser
from markupsafe import Markup

from app.inspector import markup as m
from app.inspector.panels.controls import Picker
from app.inspector.panels.protocol import Dispatch, Html, Update
from app.session import commands as c
from app.session.branches import Branch, Cost, Origin, cost_of, ended_words
from app.session.decisions import decisions_of
from app.session.snapshot import Snapshot
from app.session.wording import plural, seconds


def build(gui: viser.GuiApi, dispatch: Dispatch) -> Update:
    """Build the panel."""
    picker = Picker(gui, "branch", lambda chosen: dispatch(c.Go(branch=chosen)))
    block = Html(gui)
    costs = Costs()

    def update(snapshot: Snapshot) -> None:
        titles = {b.branch_id: f"{b.branch_id} · {_title(b)}" for b in snapshot.branches}
        picker.show(titles, snapshot.branch.branch_id, least=2)
        block.show(_block(snapshot, costs))

    return update


class Costs:
    """What each branch took, counted again only when the branch has grown."""

    def __init__(self) -> None:
        """Know none yet."""
        self._known: dict[str, tuple[Branch, Cost]] = {}

    def of(self, branch: Branch) -> Cost:
        """The cost of a branch."""
        known = self._known.get(branch.branch_id)
        if known is None or known[0] is not branch:
            known = (branch, cost_of(decisions_of(branch.exchanges, branch.pending)))
            self._known[branch.branch_id] = known
        return known[1]


def _block(snapshot: Snapshot, costs: Costs) -> str:
    roots = [branch for branch in snapshot.branches if not branch.parent]
    rows = m.join(_rows(snapshot, root, costs) for root in roots)
    return m.padded(
        m.heading("Branches"),
        Markup('<ul class="c2-branches">{}</ul>').format(rows),
        m.note("Rank at any decision and press Enter: what follows becomes a branch"),
    )


def _rows(snapshot: Snapshot, branch: Branch, costs: Costs, *, depth: int = 0) -> Markup:
    here = branch.branch_id == snapshot.branch.branch_id
    cost = costs.of(branch)
    spent = ", ".join(
        [plural(cost.decisions, "decision"), plural(cost.queries, "query"), seconds(cost.seconds)]
    )
    label = Markup("<span>{}</span><small>{}</small>").format(_title(branch), spent)
    row = Markup('<li style="--depth:{}" class="{}">{}</li>').format(
        depth, "c2-now" if here else "", m.action(label, c.Go(branch=branch.branch_id))
    )
    children = [child for child in snapshot.branches if child.parent == branch.branch_id]
    return m.join([row, *(_rows(snapshot, child, costs, depth=depth + 1) for child in children)])


def _title(branch: Branch) -> str:
    how = "live" if branch.running else ended_words(branch.footer)
    match branch.origin:
        case Origin.RECORDED:
            return f"recorded · {how}"
        case Origin.LIVE:
            return f"first run · {how}"
        case Origin.FORK:
            return f"override at {branch.fork_decision} · {how}"
