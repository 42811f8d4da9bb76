"""A family whose drive lags: any family with a first-order lag before its hysteresis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.estimates import Estimates
from hyst.identification.families.family import Family, Fit, Start
from hyst.identification.fit.bounded_least_squares import Problem, Solution
from hyst.identification.fit.stages import StagedParametrization
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.identification.result.identified import LAG, Identified
from hyst.models import Lag

Array = NDArray[np.float64]

TAKEN = (
    "name",
    "words",
    "methods",
    "has_memory",
    "settles_delay",
    "loops_tell_delay",
    "rate_between_samples",
    "describes",
    "in_reserve",
    "compared",
)


@final
@dataclass(frozen=True)
class LaggingFamily(Family):
    """A family with a lag of its drive; it is in no registry.

    Parameters
    ----------
    base
        The family of what comes after the lag.
    """

    depends_on_rate = True

    base: Family = None  # type: ignore[assignment]  # fields of the class before it have defaults

    def __post_init__(self) -> None:
        """Take the name and what else is said of it from the family of the hysteresis."""
        for each in TAKEN:
            object.__setattr__(self, each, getattr(self.base, each))
        # A lag makes loops grow with the rate.
        more = ("rate dependence", "dynamics")
        object.__setattr__(self, "explains", (*self.base.explains, *more))

    def least_parameters(self, size: int) -> int:
        """Give those of the hysteresis, and the time constant."""
        return self.base.least_parameters(size) + 1

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Give none: a lag is found beside a fit without it."""
        return ()

    def in_units(self, input_scale: float, output_scale: float) -> LaggingFamily:
        """Give the family of the hysteresis in other units, with its lag."""
        return LaggingFamily(self.base.in_units(input_scale, output_scale))

    def root_weights(self, data: Data) -> Array | None:
        """Give the weights of the family of the hysteresis."""
        return self.base.root_weights(data)

    def fitted(self, data: Data) -> Data:
        """Give what the family of the hysteresis fits to."""
        return self.base.fitted(data)

    def solve(
        self, problem: Problem, theta: Array, max_iterations: int, tolerance: float = 1e-3
    ) -> Solution:
        """Minimise as all families do: the time constant is one more free parameter."""
        return super().solve(problem, theta, max_iterations, tolerance)

    def renewed(self, fit: Fit, overview: Overview, max_iterations: int) -> Fit:
        """Solve again as the family of the hysteresis does."""
        return self.base.renewed(fit, overview, max_iterations)

    @property
    def estimates_noise(self) -> bool:
        """As of the family of the hysteresis."""
        return self.base.estimates_noise

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say what the family of the hysteresis says."""
        return self.base.notes(behind_lag(fit), _behind(data, fit))

    def estimates(self, fit: Fit) -> Estimates:
        """Give the constants of the hysteresis, and the time constant where it is free."""
        behind = self.base.estimates(behind_lag(fit))
        own, theta = lagged_of(fit), fit.solution.theta
        by_theta = np.pad(behind.by_theta, ((0, 0), (0, 1)))
        if own.lower[-1] == own.upper[-1]:
            return Estimates(behind.names, behind.values, by_theta)
        row = np.zeros((1, theta.size))
        row[0, -1] = 1.0
        return Estimates(
            (*behind.names, LAG),
            np.append(behind.values, theta[-1]),
            np.concatenate([by_theta, row]),
        )

    def result(self, identified: Identified, fit: Fit, overview: Overview) -> Identified:
        """Add what the family of the hysteresis adds."""
        behind = Overview(_behind(overview.data, fit), overview.delay, overview.rates_matter)
        return self.base.result(identified, behind_lag(fit), behind)


def _behind(data: Data, fit: Fit) -> Data:
    """Give the records with the drive as it leaves the lag, for what knows of no lag."""
    tau = float(fit.solution.theta[-1])
    records = tuple(replace(each, u=Lag(tau, each.dt)(each.u)) for each in data.records)
    return replace(data, records=records, measured_inputs=())


def lagged_of(fit: Fit) -> StagedParametrization:
    """Give the free parameters of a fit whose last one is the time constant.

    Parameters
    ----------
    fit
        Made from ``with_stage``.
    """
    parametrization = fit.parametrization
    assert isinstance(parametrization, StagedParametrization), "with_stage made it"
    return parametrization


def behind_lag(fit: Fit) -> Fit:
    """Give what comes after the lag, as a fit of its own family.

    Parameters
    ----------
    fit
        With the lag.
    """
    assert isinstance(fit.family, LaggingFamily), "it has a lag"
    base = lagged_of(fit).base
    solution = replace(fit.solution, theta=fit.solution.theta[: base.size])
    return Fit(fit.family.base, fit.size, base, solution)
