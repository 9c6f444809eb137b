"""The table of built-in houses."""

from __future__ import annotations

from c2nav_engine.world.builtin.plan import Plan
from c2nav_engine.world.builtin.plans.alder import ALDER
from c2nav_engine.world.builtin.plans.aspen import ASPEN
from c2nav_engine.world.builtin.plans.birch import BIRCH
from c2nav_engine.world.builtin.plans.cedar import CEDAR
from c2nav_engine.world.builtin.plans.chestnut import CHESTNUT
from c2nav_engine.world.builtin.plans.hazel import HAZEL
from c2nav_engine.world.builtin.plans.juniper import JUNIPER
from c2nav_engine.world.builtin.plans.linden import LINDEN
from c2nav_engine.world.builtin.plans.maple import MAPLE
from c2nav_engine.world.builtin.plans.rowan import ROWAN
from c2nav_engine.world.builtin.plans.walnut import WALNUT
from c2nav_engine.world.builtin.plans.willow import WILLOW

PLANS: dict[str, Plan] = {
    plan.name: plan
    for plan in (
        MAPLE,
        BIRCH,
        CEDAR,
        ASPEN,
        WILLOW,
        JUNIPER,
        HAZEL,
        ROWAN,
        ALDER,
        LINDEN,
        CHESTNUT,
        WALNUT,
    )
}
"""House name → plan; the built-in episodes follow this order."""
