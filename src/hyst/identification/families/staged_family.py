"""A family with a stage more: what comes from the family around which it is made."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.family import Family, Fit, Start
from hyst.identification.fit.stages import StagedParametrization
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data

Array = NDArray[np.float64]

TAKEN = (
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
"""What is said of the family, of which the one with a stage more says the same."""


@dataclass(frozen=True)
class StagedFamily(Family):
    """A family whose models have a stage more; it is found beside a fit and in no registry.

    Parameters
    ----------
    base
        The family of the hysteresis.
    """

    depends_on_rate = True

    base: Family = None  # type: ignore[assignment]  # fields of the class before it have defaults

    def __post_init__(self) -> None:
        """Take the name and what else is said of it from the family of the hysteresis."""
        for each in TAKEN:
            object.__setattr__(self, each, getattr(self.base, each))

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Give none: the stage is found beside a fit without it."""
        return ()

    def root_weights(self, data: Data) -> Array | None:
        """Give the weights of the family of the hysteresis."""
        return self.base.root_weights(data)

    def fitted(self, data: Data) -> Data:
        """Give what the family of the hysteresis fits to."""
        return self.base.fitted(data)

    def renewed(self, fit: Fit, overview: Overview, max_iterations: int) -> Fit:
        """Solve again as the family of the hysteresis does."""
        return self.base.renewed(fit, overview, max_iterations)

    @property
    def estimates_noise(self) -> bool:
        """As of the family of the hysteresis."""
        return self.base.estimates_noise

    def without_stage(self, fit: Fit) -> Fit:
        """Give the hysteresis of a fit, as a fit of its own family.

        Parameters
        ----------
        fit
            With the stage.
        """
        base = staged_of(fit).base
        solution = replace(fit.solution, theta=fit.solution.theta[: base.size])
        return Fit(self.base, fit.size, base, solution)


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


def without_stage(fit: Fit) -> Fit:
    """Give the hysteresis of a fit with a stage more, as a fit of its own family.

    Parameters
    ----------
    fit
        Of a ``StagedFamily``.
    """
    assert isinstance(fit.family, StagedFamily), "it has a stage more"
    return fit.family.without_stage(fit)
