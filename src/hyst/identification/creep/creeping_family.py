"""A family whose models creep: any family with lags behind its hysteresis."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.estimates import Estimates
from hyst.identification.families.family import Fit
from hyst.identification.families.staged_family import StagedFamily, staged_of
from hyst.identification.fit.bounded_least_squares import Problem, Solution
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.identification.result.identified import Identified

Array = NDArray[np.float64]


@final
@dataclass(frozen=True)
class CreepingFamily(StagedFamily):
    """A family with creep between its hysteresis and its offset; it is in no registry.

    Parameters
    ----------
    base
        The family of the hysteresis.
    """

    def least_parameters(self, size: int) -> int:
        """Give those of the hysteresis, and of one lag."""
        return self.base.least_parameters(size) + 2

    def solve(
        self, problem: Problem, theta: Array, max_iterations: int, tolerance: float = 1e-3
    ) -> Solution:
        """Minimise as the family of the hysteresis does."""
        return self.base.solve(problem, theta, max_iterations, tolerance)

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say what the family of the hysteresis says."""
        return self.base.notes(self.without_stage(fit), data)

    def estimates(self, fit: Fit) -> Estimates:
        """Give the constants of the hysteresis, then weights and time constants."""
        front, size = self.base.estimates(self.without_stage(fit)), fit.parametrization.size
        count = size - front.by_theta.shape[1]
        by_theta = np.zeros((len(front.names) + count, size))
        by_theta[: len(front.names), : front.by_theta.shape[1]] = front.by_theta
        by_theta[len(front.names) :, -count:] = np.eye(count)
        stage = staged_of(fit).stage.with_parameters(fit.solution.theta[-count:]).parameters()
        names = [f"creep.{name}" for name in stage.names]
        return Estimates(
            (*front.names, *names), np.concatenate([front.values, stage.values]), by_theta
        )

    def result(self, identified: Identified, fit: Fit, overview: Overview) -> Identified:
        """Add what the family of the hysteresis adds."""
        return self.base.result(identified, self.without_stage(fit), overview)
