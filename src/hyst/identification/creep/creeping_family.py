"""A family whose models creep: any family with lags behind its hysteresis."""

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
from hyst.identification.result.identified import Identified

Array = NDArray[np.float64]

_TAKEN = (
    "name",
    "words",
    "methods",
    "has_memory",
    "settles_delay",
    "loops_tell_delay",
    "explains",
    "describes",
    "in_reserve",
    "compared",
)


@final
@dataclass(frozen=True)
class CreepingFamily(Family):
    """A family with creep between its hysteresis and its offset; it is in no registry.

    Parameters
    ----------
    base
        The family of the hysteresis.
    """

    depends_on_rate = True

    base: Family = None  # type: ignore[assignment]  # fields of the class before it have defaults

    def __post_init__(self) -> None:
        """Take the name and what else is said of it from the family of the hysteresis."""
        for each in _TAKEN:
            object.__setattr__(self, each, getattr(self.base, each))

    def least_parameters(self, size: int) -> int:
        """Give those of the hysteresis, and of one lag."""
        return self.base.least_parameters(size) + 2

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Give none: creep is found beside a fit without it."""
        return ()

    def root_weights(self, data: Data) -> Array | None:
        """Give the weights of the family of the hysteresis."""
        return self.base.root_weights(data)

    def fitted(self, data: Data) -> Data:
        """Give what the family of the hysteresis fits to."""
        return self.base.fitted(data)

    def solve(
        self, problem: Problem, theta: Array, max_iterations: int, tolerance: float = 1e-3
    ) -> Solution:
        """Minimise as the family of the hysteresis does."""
        return self.base.solve(problem, theta, max_iterations, tolerance)

    def renewed(self, fit: Fit, overview: Overview, max_iterations: int) -> Fit:
        """Solve again as the family of the hysteresis does."""
        return self.base.renewed(fit, overview, max_iterations)

    @property
    def estimates_noise(self) -> bool:
        """As of the family of the hysteresis."""
        return self.base.estimates_noise

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say what the family of the hysteresis says."""
        return self.base.notes(self.hysteresis_of(fit), data)

    def estimates(self, fit: Fit) -> Estimates:
        """Give the constants of the hysteresis, then weights and time constants."""
        front, size = self.base.estimates(self.hysteresis_of(fit)), fit.parametrization.size
        count = size - front.by_theta.shape[1]
        by_theta = np.zeros((len(front.names) + count, size))
        by_theta[: len(front.names), : front.by_theta.shape[1]] = front.by_theta
        by_theta[len(front.names) :, -count:] = np.eye(count)
        stage = staged_of(fit).stage.with_parameters(fit.solution.theta[-count:]).parameters()
        names = [f"creep.{name}" for name in stage.names]
        return Estimates(
            (*front.names, *names), np.concatenate([front.values, stage.values]), by_theta
        )

    def hysteresis_of(self, fit: Fit) -> Fit:
        """Give the hysteresis of a fit, as a fit of its own family.

        Parameters
        ----------
        fit
            With creep.
        """
        base = staged_of(fit).base
        solution = replace(fit.solution, theta=fit.solution.theta[: base.size])
        return Fit(self.base, fit.size, base, solution)

    def result(self, identified: Identified, fit: Fit, overview: Overview) -> Identified:
        """Add what the family of the hysteresis adds."""
        return self.base.result(identified, self.hysteresis_of(fit), overview)


def staged_of(fit: Fit) -> StagedParametrization:
    """Give the free parameters of a fit with a stage more than its family has.

    Parameters
    ----------
    fit
        Made from ``with_stage``.
    """
    parametrization = fit.parametrization
    assert isinstance(parametrization, StagedParametrization), "with_stage made it"
    return parametrization
