"""What kind of observer is simulated."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from c2nav_engine.errors import UsageError
from c2nav_engine.rankers.options import OptionReader


@dataclass(frozen=True, slots=True)
class SimulatedOptions:
    """An equal-variance Gaussian observer (paper, text around eq. 3).

    Attributes:
        d_prime: Sensitivity: how far the target's evidence lies above the others', in standard
            deviations.
        beta: Bias towards what is shown first, in the same unit.
        lapse: Rate of answers drawn uniformly, whatever was seen.
        invalid_rate: Rate of answers that cannot be read.
        sigma_c: Standard deviation of the criterion between episodes; only the cardinal forms
            have a criterion.
        shared_orders: Whether every presentation order sees the same noise.
    """

    d_prime: float = 1.5
    beta: float = 0.0
    lapse: float = 0.0
    invalid_rate: float = 0.0
    sigma_c: float = 0.0
    shared_orders: bool = False

    def __post_init__(self) -> None:
        """Reject impossible observers; raises `UsageError`."""
        for name in ("lapse", "invalid_rate"):
            rate: float = getattr(self, name)
            if not 0.0 <= rate <= 1.0:
                message = f"expected {name} of the simulated observer within 0 … 1, came {rate}"
                raise UsageError(message)
        for name in ("d_prime", "sigma_c"):
            size: float = getattr(self, name)
            if not 0.0 <= size < float("inf"):
                message = f"expected {name} of the simulated observer as 0 or more, came {size}"
                raise UsageError(message)

    @staticmethod
    def from_options(options: Mapping[str, str]) -> SimulatedOptions:
        """From `--ranker-opt KEY=VALUE`; raises `UsageError` naming what is wrong."""
        read = OptionReader("simulated", options)
        default = SimulatedOptions()
        parsed = SimulatedOptions(
            d_prime=read.number("d_prime", default.d_prime),
            beta=read.number("beta", default.beta),
            lapse=read.number("lapse", default.lapse),
            invalid_rate=read.number("invalid_rate", default.invalid_rate),
            sigma_c=read.number("sigma_c", default.sigma_c),
            shared_orders=read.flag("shared_orders", default=default.shared_orders),
        )
        read.done()
        return parsed

    def as_options(self) -> dict[str, str]:
        """All values as records keep them."""
        return {
            "d_prime": repr(self.d_prime),
            "beta": repr(self.beta),
            "lapse": repr(self.lapse),
            "invalid_rate": repr(self.invalid_rate),
            "sigma_c": repr(self.sigma_c),
            "shared_orders": str(self.shared_orders).lower(),
        }
