"""Hammerstein identification: hysteresis followed by linear dynamics.

``hyst.identify(record, family="hammerstein")`` takes all steps; here are the single ones.
"""

from __future__ import annotations

from hyst.identification.families.hammerstein.impulse_response.markov import (
    MarkovParameters,
    fit_markov,
)
from hyst.identification.families.hammerstein.impulse_response.realization import (
    Realization,
    realize,
)
from hyst.identification.families.hammerstein.told.distortion_levels import (
    BestLinearApproximation,
    average_periods,
    best_linear_approximation,
)
from hyst.identification.families.hammerstein.told.identified_hammerstein import (
    IdentifiedHammerstein,
    Loop,
)

__all__ = [
    "BestLinearApproximation",
    "IdentifiedHammerstein",
    "Loop",
    "MarkovParameters",
    "Realization",
    "average_periods",
    "best_linear_approximation",
    "fit_markov",
    "realize",
]


def __dir__() -> list[str]:
    return __all__
