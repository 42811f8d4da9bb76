"""A straight line: what hysteresis is compared with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.family import Family, Start, Words
from hyst.identification.fit.parametrization import SMALLEST_SLOPE, Parametrization
from hyst.identification.fit.weights import fit_weights
from hyst.identification.record_use.overview import Overview
from hyst.operators import Affine

Array = NDArray[np.float64]


@final
@dataclass(frozen=True)
class Linear(Family):
    """``y = gain u + offset``."""

    name = "linear"
    words = Words(
        full_name="straight line",
        equations=("y(t) = gain \u00b7 u(t) + offset",),
        explanations=(
            "This model has no hysteresis: the output depends on the present input alone.",
        ),
    )
    compared = True
    has_memory = False

    def least_parameters(self, size: int) -> int:
        """Give 2: gain and offset."""
        return 2

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Give the least squares line."""
        line = fit_weights(overview.data, np.empty(0), overview.sign)
        sign = overview.sign
        least = SMALLEST_SLOPE * overview.mean_slope
        slope = max(line.p0, 0.01 * overview.mean_slope)
        parametrization = Parametrization(
            template=Affine(sign * slope, line.offset),
            transform=np.diag([sign, 1.0]),
            fixed=np.zeros(2),
            lower=np.array([least, -np.inf]),
            upper=np.full(2, np.inf),
        )
        return [(parametrization, np.array([slope, line.offset]))]
