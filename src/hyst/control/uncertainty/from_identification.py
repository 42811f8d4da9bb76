"""Weights that bear what an identification leaves unknown of a plant."""

from __future__ import annotations

from typing import Any

import numpy as np

from hyst.control.linear_system import as_linear_system
from hyst.control.plants.identified import IdentifiedPlant
from hyst.control.uncertainty.left_unknown import (
    SLOW,
    STANDARD_ERRORS,
    deviations_left,
    shown_deviations,
)
from hyst.control.uncertainty.responses import response_at
from hyst.control.uncertainty.weight import UncertaintyWeight, cover_of
from hyst.errors import InputError

LEAST_STANDARD_ERRORS = 2.0
"""Of the identification, below which no weight is taken: it would claim more than is known."""

_TIGHT = 2.0  # excess of the weight: standard errors are no sharp limits


def identification_weight(
    plant: IdentifiedPlant,
    standard_errors: float = STANDARD_ERRORS,
    *,
    order: int | None = None,
    least: float = 0.01,
    slow: float = SLOW,
    continuous: bool = False,
) -> UncertaintyWeight:
    """Find the weight of what an identification leaves unknown of its plant.

    Parameters
    ----------
    plant
        As ``identified_plant`` gives it.
    standard_errors
        How many of them the weight bears, >= 0.
    order, least
        As for ``uncertainty_weight``.
    slow
        Deviation from a tenth of the lowest frequency that the drive shows downwards, >= 0.
    continuous
        For the continuous plant; then all above half the sample rate is unknown, too.

    Returns
    -------
    UncertaintyWeight
        Sampled, for the sampled plant, unless it is for the continuous one. It covers noise, and
        what the model visibly lacks over the records it was identified from; not what another
        amplitude, load, temperature or specimen changes: measure those, and give the responses to
        ``uncertainty_weight``.

    Raises
    ------
    InputError
        If the plant has no errors, its drive shows nothing of it, or a number is below 0.

    Examples
    --------
    ::

        plant = hyst.control.identified_plant("out/model.json")
        Wu = hyst.control.identification_weight(plant)
    """
    found = deviations_left(plant, standard_errors, slow=slow, continuous=continuous)
    return cover_of([found], 0.0 if continuous else plant.dt, order, least, _TIGHT)


def require_no_less_than_known(Wu: Any, plant: IdentifiedPlant) -> None:
    """Refuse a weight that claims to know a plant better than its identification does.

    Parameters
    ----------
    Wu
        As ``as_linear_system`` takes it.
    plant
        As ``identified_plant`` gives it; one without errors is not asked.

    Raises
    ------
    InputError
        If ``|Wu|`` is below two standard errors, and what the model visibly lacks, at a frequency
        that the drive shows; with that frequency and both numbers.
    """
    weight = as_linear_system(Wu, "Wu")
    for band in shown_deviations(plant, LEAST_STANDARD_ERRORS):
        gain = np.abs(response_at(weight, band.w))
        worst = int(np.argmin(gain / np.maximum(band.radius, np.finfo(float).tiny)))
        if gain[worst] < band.radius[worst]:
            raise InputError(
                f"Wu is {gain[worst]:.3g} at {band.w[worst] / (2.0 * np.pi):.4g} Hz, where the "
                f"identification of {plant.name} leaves {band.radius[worst]:.3g} unknown "
                f"({LEAST_STANDARD_ERRORS:g} standard errors and what the model lacks); give a "
                'larger one, as Wu = "identification" does'
            )
