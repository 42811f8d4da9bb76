"""What an identification leaves unknown of a plant: samples of ``|P / Pn - 1|``.

In the bands that the drive showed: so many standard errors of noise, and what the model visibly
lacks. What was not shown is not known: towards the end of a band, and beyond it, the deviation
grows with the square of the frequency to 1, and then in proportion to it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_not_negative
from hyst.control.plants.identified import IdentifiedPlant
from hyst.control.uncertainty.responses import Deviations
from hyst.errors import InputError
from hyst.operators.dynamics_errors import DynamicsErrors

Array = NDArray[np.float64]

STANDARD_ERRORS = 3.0
"""Of the identification, that a weight made from it bears."""

SLOW = 0.1
"""Deviation from a tenth of the lowest frequency that the drive shows downwards, as by creep."""

_TOWARDS_EDGE = 2.0  # power of the frequency with which the deviation grows to 1
_LARGEST = 10.0  # a larger deviation is none: nothing is known
_SLOW_FROM = 0.1  # of the lowest frequency shown
_CONTINUOUS = 0.5  # of half the sample rate, up to which a continuous plant is as sure as samples
_ABOVE = np.geomspace(1.0, 30.0, 24)  # of half the sample rate, for continuous plants
_PER_GAP = 8


def deviations_left(
    plant: IdentifiedPlant,
    standard_errors: float = STANDARD_ERRORS,
    *,
    slow: float = SLOW,
    continuous: bool = False,
) -> Deviations:
    """Give ``|P / Pn - 1|`` of plants that an identification does not exclude.

    Parameters
    ----------
    plant
        As ``identified_plant`` gives it.
    standard_errors, slow, continuous
        How many standard errors count, the deviation far below the band, and whether it is of the
        continuous plant.

    Returns
    -------
    Deviations

    Raises
    ------
    InputError
        If the plant has no errors, its drive shows nothing of it, or a number is below 0.
    """
    errors, count = _errors(plant), as_not_negative(standard_errors, "standard_errors")
    at_rest = as_not_negative(slow, "slow", "a deviation")
    nyquist = 0.5 / plant.dt
    frequency = np.array(errors.frequency)
    frequency = np.unique(np.concatenate([frequency, *_edges(errors, nyquist)]))
    if continuous:
        frequency = np.union1d(frequency, nyquist * _ABOVE)
    known = within_bands(errors, frequency, count)
    if continuous:
        # Towards half the sample rate samples of G tell of its aliases as well.
        known[frequency > _CONTINUOUS * nyquist] = 0.0
    radius = np.maximum(known, _where_not_shown(errors, frequency, nyquist, continuous))
    below = at_rest * np.minimum(_SLOW_FROM * errors.bands[0][0] / frequency, 1.0)
    return Deviations(2.0 * np.pi * frequency, np.maximum(radius, below))


def within_bands(errors: DynamicsErrors, frequency: Array, standard_errors: float) -> Array:
    """Give the deviation by noise, and what the model visibly lacks, at any frequency.

    Parameters
    ----------
    errors
        Of the identification.
    frequency
        Shape (p,), Hz.
    standard_errors
        How many of them.

    Returns
    -------
    numpy.ndarray
        Shape (p,). ``ln P/Pn`` is within so many of its standard errors, so ``|P/Pn - 1|`` below
        the exponential of them, less 1; at most 10, as good as nothing known.
    """
    at, known = np.log(frequency), np.log(errors.frequency)
    noise = np.interp(at, known, errors.standard_error) * standard_errors
    lacks = np.interp(at, known, errors.missing)
    return np.asarray(np.minimum(np.expm1(np.minimum(noise, 50.0)) + lacks, _LARGEST))


def shown_deviations(
    plant: IdentifiedPlant, standard_errors: float = STANDARD_ERRORS
) -> list[Deviations]:
    """Give what is not known in each band that the drive shows, and nothing of what is beyond.

    Parameters
    ----------
    plant, standard_errors
        As for ``deviations_left``.

    Returns
    -------
    list of Deviations
        One a band; none of a plant that has no errors.
    """
    if plant.errors is None:
        return []
    found, known = [], np.array(plant.errors.frequency)
    for low, high in plant.errors.bands:
        frequency = known[(known >= low) & (known <= high)]
        if frequency.size:
            radius = within_bands(plant.errors, frequency, standard_errors)
            found.append(Deviations(2.0 * np.pi * frequency, radius))
    return found


def _errors(plant: IdentifiedPlant) -> DynamicsErrors:
    errors = plant.errors
    if errors is None:
        raise InputError(
            f"{plant.name} does not tell how well its dynamics are known: they were given, or it "
            "was written by an older hyst; identify again, or give Wu"
        )
    if not errors.bands or not errors.frequency:
        raise InputError(
            f"the drive that {plant.name} was identified from shows nothing of its dynamics; "
            "record one with power where the controller is to work, or give Wu"
        )
    return errors


def _unshown(errors: DynamicsErrors, nyquist: float, continuous: bool) -> list[tuple[float, float]]:
    """Give the gaps between bands, and what is above them, Hz."""
    edges = [
        (below[1], above[0]) for below, above in zip(errors.bands, errors.bands[1:], strict=False)
    ]
    highest = min(errors.bands[-1][1], nyquist)
    if continuous or highest < nyquist * (1.0 - 1e-6):
        edges.append((highest, np.inf))
    return edges


def _where_not_shown(
    errors: DynamicsErrors, frequency: Array, nyquist: float, continuous: bool
) -> Array:
    radius = np.zeros(frequency.size)
    for low, high in _unshown(errors, nyquist, continuous):
        grown = np.minimum(frequency / low, 1.0) ** _TOWARDS_EDGE
        grown *= np.minimum(high / frequency, 1.0) ** _TOWARDS_EDGE
        if np.isinf(high):
            grown *= np.maximum(frequency / low, 1.0)
        radius = np.maximum(radius, grown)
    return radius


def _edges(errors: DynamicsErrors, nyquist: float) -> list[Array]:
    """Give frequencies at and between the ends of bands, so that none is stepped over."""
    points = [np.array([each for band in errors.bands for each in band if each <= nyquist])]
    for low, high in zip(errors.bands, errors.bands[1:], strict=False):
        points.append(np.geomspace(low[1], high[0], _PER_GAP))
    points.append(errors.bands[0][0] * np.array([0.01, _SLOW_FROM]))
    return points
