"""The Ramberg-Osgood model: a power law of the way since a reversal, with three constants."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst import models
from hyst.checks.numbers import as_not_negative
from hyst.errors import InputError
from hyst.identification.families.family import Family, Fit, Start, Words
from hyst.identification.families.option import Option, choice, option, read_number
from hyst.identification.families.power_law_fit import (
    SMALLEST_POWER,
    PowerLawFit,
    fit_power_law,
)
from hyst.identification.fit.bounded_least_squares import CONVERGED, Problem, Solution
from hyst.identification.fit.parametrization import SMALLEST_SLOPE, Parametrization, selection
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.models.masing import as_mode
from hyst.operators import Affine

Array = NDArray[np.float64]

OUTPUT, SLOPE = "output", "slope"

_SIGNAL_TO_NOISE = 3.0


@final
@dataclass(frozen=True)
class RambergOsgood(Family):
    """``dy/du = c1 + c2 p^c3``, p the way since the last reversal (S3).

    Parameters
    ----------
    memory
        ``"masing"`` (nested reversals, loops close) or ``"last-reversal"`` (the paper's, drifts).
    regression
        ``"output"`` fits y; ``"slope"`` fits dy/du, as S3 does, which is more sensitive to noise
        and gives no standard errors.
    signal_to_noise
        With ``"slope"``: what a difference of y must be in units of its noise to take part.
    """

    name = "ramberg-osgood"
    words = Words(
        full_name="Ramberg-Osgood model",
        equations=(
            "y(t) = {sign}R[u](t) + offset",
            "dR/du = c1 + c2 p^c3,  p = |u - u at the last reversal|",
        ),
        explanations=(
            "Right after a reversal the output follows the input with the slope c1; the further "
            "the input goes, the steeper it gets. With nested memory a branch that closes a loop "
            "goes on along the branch the loop started from, so that minor loops close.",
        ),
    )
    has_memory = False  # a delay bends a power law's loop as another exponent does

    memory: Any = option(
        "masing",
        choice(("masing", "last-reversal"), "Reversals remembered: masing (loops close) or one."),
    )
    regression: Any = option(
        OUTPUT, choice((OUTPUT, SLOPE), "Fit the output, or its slope over the input.")
    )
    signal_to_noise: Any = option(
        _SIGNAL_TO_NOISE,
        Option(
            as_not_negative, "With slopes: what a step must be over its noise.", read_number, "X"
        ),
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.regression != SLOPE and self.signal_to_noise != _SIGNAL_TO_NOISE:
            raise InputError(
                f"signal_to_noise is {self.signal_to_noise:g}, which regression "
                f"{self.regression!r} does not use; leave it out, or choose regression {SLOPE!r}"
            )

    def least_parameters(self, size: int) -> int:
        """Give 4: c1, c2, c3 and the offset."""
        return 4

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Give the constants found by variable projection."""
        found = fit_power_law(
            overview.data,
            overview.sign,
            memory=self.memory,
            regression=self.regression,
            signal_to_noise=self.signal_to_noise,
        )
        return [self.parametrize(found, overview.sign, overview.mean_slope)]

    def parametrize(self, found: PowerLawFit, sign: float, mean_slope: float) -> Start:
        """Give theta = (c1, c2, c3, offset).

        Parameters
        ----------
        found
            Where to start.
        sign
            +1, or -1 where the output falls as the input rises.
        mean_slope
            Of the records, output units per input unit.
        """
        # A slope of less than that is none: the records show a curve that starts flat.
        least = SMALLEST_SLOPE * mean_slope
        c1 = found.c1 if found.c1 >= least else 0.0
        model = models.RambergOsgood(
            c1, found.c2, found.c3, as_mode(self.memory), dead_band=found.dead_band
        )
        parametrization = Parametrization(
            template=Affine(sign, found.offset) @ model,
            transform=selection(5, [0, 1, 2, 4]),
            fixed=np.array([0.0, 0.0, 0.0, sign, 0.0]),
            lower=np.array([least if c1 > 0.0 else 0.0, 0.0, SMALLEST_POWER, -np.inf]),
            upper=np.array([np.inf, np.inf, found.largest_power, np.inf]),
        )
        return parametrization, np.array([c1, found.c2, found.c3, found.offset])

    def solve(
        self, problem: Problem, theta: Array, max_iterations: int, tolerance: float = 1e-3
    ) -> Solution:
        """Fit the output in all constants at once, unless the slopes were fitted."""
        if self.regression == OUTPUT:
            return super().solve(problem, theta, max_iterations, tolerance)
        residual = problem.residual(theta)
        return Solution(theta, float(residual @ residual), 0, CONVERGED)

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say if the exponent ended at a limit, so that it is no estimate, or c1 at 0."""
        found = at_limit_of_power(fit.parametrization, fit.solution.theta)
        if fit.solution.theta[0] > 0.0:
            return found
        return (
            *found,
            "c1 came out at 0: right after a turn the output rests at first, so that the inverse "
            "answers small changes there with large ones; a slope that grows less and less is "
            "told better by family 'masing'",
        )

    @property
    def estimates_noise(self) -> bool:
        """Whether y was fitted: errors of such a fit would be too small for one of slopes."""
        return bool(self.regression == OUTPUT)


def at_limit_of_power(parametrization: Parametrization, theta: Array) -> tuple[str, ...]:
    """Say if the exponent of a power law ended at a limit, so that it is no estimate.

    Parameters
    ----------
    parametrization, theta
        A fit of a Ramberg-Osgood model.

    Returns
    -------
    tuple of str
        A sentence, or nothing.
    """
    low, high, c3 = parametrization.lower[2], parametrization.upper[2], theta[2]
    margin = 1e-3 * c3
    if low + margin < c3 < high - margin:
        return ()
    which, shape = (
        ("upper", "the loop bends more sharply at its ends")
        if c3 >= high - margin
        else ("lower", "the slope grows more suddenly after a reversal")
    )
    return (
        f"c3 came out at its {which} limit {c3:.4g}: {shape} than a power law that this record can "
        "tell, so c3 and c2 are no estimates; compare family 'pi', or sample more often",
    )
