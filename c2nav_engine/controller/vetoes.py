"""Physical vetoes: facts that turn a stop into a hold (paper, "Arriving")."""

from __future__ import annotations

from c2nav_engine.controller.config import ControllerConfig
from c2nav_engine.controller.sensed import DepthStats


def stop_vetoes(depth: DepthStats, *, collided: bool, config: ControllerConfig) -> tuple[str, ...]:
    """Every reason against stopping here, in plain words; empty when none."""
    vetoes: list[str] = []
    if depth.median_m < config.veto_median_m:
        vetoes.append(
            f"depth median {depth.median_m:.2f} m, plausible from {config.veto_median_m:.2f} m"
        )
    if depth.holes > config.veto_holes:
        vetoes.append(f"depth holes {depth.holes:.0%}, plausible up to {config.veto_holes:.0%}")
    if collided:
        vetoes.append("the last forward step collided")
    return tuple(vetoes)
