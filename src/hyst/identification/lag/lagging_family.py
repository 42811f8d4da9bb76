"""A family whose drive lags: any family with a first-order lag before its hysteresis."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.estimates import Estimates
from hyst.identification.families.family import Fit
from hyst.identification.families.staged_family import StagedFamily
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.identification.result.identified import LAG, Identified
from hyst.models import Lag

Array = NDArray[np.float64]


@final
@dataclass(frozen=True)
class LaggingFamily(StagedFamily):
    """A family with a lag of its drive; it is in no registry.

    Parameters
    ----------
    base
        The family of what comes after the lag.
    """

    def __post_init__(self) -> None:
        """Take over what is said of the family; a lag makes loops grow with the rate."""
        super().__post_init__()
        object.__setattr__(self, "rate_between_samples", self.base.rate_between_samples)
        more = ("rate dependence", "dynamics")
        object.__setattr__(self, "explains", (*self.base.explains, *more))

    def least_parameters(self, size: int) -> int:
        """Give those of the hysteresis, and the time constant."""
        return self.base.least_parameters(size) + 1

    def in_units(self, input_scale: float, output_scale: float) -> LaggingFamily:
        """Give the family of the hysteresis in other units, with its lag."""
        return LaggingFamily(self.base.in_units(input_scale, output_scale))

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say what the family of the hysteresis says."""
        return self.base.notes(self.without_stage(fit), _behind(data, fit))

    def estimates(self, fit: Fit) -> Estimates:
        """Give the constants of the hysteresis, and the time constant where it is free."""
        behind = self.base.estimates(self.without_stage(fit))
        own, theta = fit.parametrization, fit.solution.theta
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
        return self.base.result(identified, self.without_stage(fit), behind)


def _behind(data: Data, fit: Fit) -> Data:
    """Give the records with the drive as it leaves the lag, for what knows of no lag."""
    tau = float(fit.solution.theta[-1])
    records = tuple(replace(each, u=Lag(tau, each.dt)(each.u)) for each in data.records)
    return replace(data, records=records, measured_inputs=())
