"""The tree of branches, with outcomes and cost."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

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
        block.show(_block(snapshot, costs.of(snapshot.branches)))

    return update


class Costs:
    """What each branch took, counted again only when the branch has grown.

    A branch holds all its pictures, so those of an episode that was left are let go.
    """

    def __init__(self) -> None:
        """Know none yet."""
        self._known: dict[str, tuple[Branch, Cost]] = {}

    def of(self, branches: Sequence[Branch]) -> Mapping[str, Cost]:
        """The cost of each of the branches that there are now, by id."""
        self._known = {branch.branch_id: self._counted(branch) for branch in branches}
        return {branch_id: cost for branch_id, (_, cost) in self._known.items()}

    def _counted(self, branch: Branch) -> tuple[Branch, Cost]:
        known = self._known.get(branch.branch_id)
        if known is not None and known[0] is branch:
            return known
        return branch, cost_of(decisions_of(branch.exchanges, branch.pending))


def _block(snapshot: Snapshot, costs: Mapping[str, Cost]) -> str:
    roots = [branch for branch in snapshot.branches if not branch.parent]
    rows = m.join(_rows(snapshot, root, costs) for root in roots)
    return m.padded(
        m.heading("Branches"),
        Markup('<ul class="c2-branches">{}</ul>').format(rows),
        m.note("Rank at any decision and press Enter: what follows becomes a branch"),
    )


def _rows(
    snapshot: Snapshot, branch: Branch, costs: Mapping[str, Cost], *, depth: int = 0
) -> Markup:
    here = branch.branch_id == snapshot.branch.branch_id
    cost = costs[branch.branch_id]
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
