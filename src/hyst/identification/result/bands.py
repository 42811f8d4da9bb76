"""Where an output will be measured for any drive: noise, constants, shape, and what is new to it.

The half-width of the band is the root of the sum of squares of

- the noise of the records, and three times what the model leaves beside it: on another drive a
  wrong shape is wrong by more than where it was fitted;
- the standard error of the model's output, from the covariance of its constants;
- how far rival models go apart that fit the records equally well;
- how far the drive leads the memory from all that the records contained;
- until the drive has covered the range, what the model leaves of the beginnings of the records,
  which took no part in the fit: how sure the memory at rest is.

What is new is a distance, not a probability: it was set on simulated actuators of no model's class
(benchmarks/bands.py), so that their minor loops are held where a record showed none.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.checks.arrays import finite_vector
from hyst.checks.numbers import as_positive
from hyst.diagnosis.repetition import noise_by_repetition
from hyst.errors import InputError
from hyst.identification.families.family import Fit
from hyst.identification.fit.problem import model_output
from hyst.identification.record_use.strokes import shows_minor_loops, stroke_lengths
from hyst.identification.record_use.used_samples import LARGEST_RADIUS, Data
from hyst.identification.result.fit_spread import FitSpread
from hyst.operators import Operator
from hyst.signals import estimate_noise

Array = NDArray[np.float64]

MISFIT_ELSEWHERE = 3.0
"""Times what the model leaves beside noise where it was fitted."""

SHARE_OF_OPENING = 12.0
"""Half-width, in openings of the loop, at a distance of half the input range."""

MISFITS = 150.0
"""The same in misfits: where records show minor loops, their misfit tells how wrong a shape is."""

SET_FOR = 0.95
"""The level for which the distances of rivals and of what is new were set."""

NEW = 0.1
"""Distance, of half the input range, from which on a state of the memory is called new."""

SURE_OF_NOISE = 6.0
"""Over the root of the number of samples: how much noise may be larger than it is measured."""

RADII = 6
MOST_STATES = 20_000
FINEST = 10
"""Steps between two samples: of coarse records more states than samples are known."""

FEWEST_FOR_QUANTILES = 400

BLOCK = 2**16
"""Samples whose memory is held at a time."""


@dataclass(frozen=True, eq=False)
class Bands:
    """What is needed to say where the output will be measured.

    Parameters
    ----------
    fit
        The final fit, in the user's units.
    spread
        How sure its constants are.
    noise, misfit
        Of the records, and what the model leaves beside it, output units rms.
    residual
        Shape (m,), sizes of what the model leaves, ascending, over their rms.
    growth
        Half-width for each half input range that a drive leads the memory away from the records.
    at_rest
        What the model leaves, beside noise, before the memory is known, output units rms.
    half_range, centre
        Of the inputs.
    states
        Shape (n, 1 + RADII), input and memory at samples of the records, over ``half_range``.
    spacing
        Distance of a state of the records to the next one.
    rivals
        Models of other kinds that fit the records equally well.
    """

    fit: Fit
    spread: FitSpread
    noise: float
    misfit: float
    residual: Array
    growth: float
    at_rest: float
    half_range: float
    centre: float
    states: Array
    spacing: float
    rivals: tuple[Operator, ...]

    def half_width(self, u: Array, output: Array, level: float) -> Array:
        """Give half the width of the band around the model's output.

        Parameters
        ----------
        u
            Shape (N,), input units.
        output
            Shape (N,), of the model for it.
        level
            Share of the samples that it is to hold, above 0 and below 1.
        """
        quantile = self._quantile(level)
        fitted = quantile**2 * (self.noise**2 + (MISFIT_ELSEWHERE * self.misfit) ** 2)
        deviations = _normal_quantile(level)
        constants = self._standard_errors(u) ** 2
        apart = [np.abs(rival(u) - output) for rival in self.rivals]
        shape = np.max(apart, axis=0) ** 2 if apart else 0.0
        new = (self.growth * self.distances(u)) ** 2
        share = (shape + new) / _normal_quantile(SET_FOR) ** 2
        rest = np.where(self._is_settled(u), 0.0, self.at_rest**2)
        return np.asarray(np.sqrt(fitted + deviations**2 * (constants + share + rest)))

    def distances(self, u: Array) -> Array:
        """Give how far input and memory are from any state of the records, over half the range."""
        found = self._tree.query(_states(u, self.centre, self.half_range))[0]
        return np.asarray(np.maximum(found / math.sqrt(1 + RADII) - self.spacing, 0.0))

    def _is_settled(self, u: Array) -> NDArray[np.bool_]:
        """Tell from where on the drive has covered the range, so that all memory is known."""
        covered = np.maximum.accumulate(u) - np.minimum.accumulate(u)
        return np.asarray(covered >= LARGEST_RADIUS * 2.0 * self.half_range)

    def _standard_errors(self, u: Array) -> Array:
        parametrization = self.fit.parametrization
        rows = self.fit.operator.jacobian(u) @ parametrization.transform
        return self.spread.of_what_is_determined(rows)

    def _quantile(self, level: float) -> float:
        """Give the factor of the rms: that of the residual itself where there is enough of it."""
        if self.residual.size < FEWEST_FOR_QUANTILES:
            return _normal_quantile(level)
        return float(np.quantile(self.residual, level))

    @functools.cached_property
    def _tree(self):  # type: ignore[no-untyped-def]
        from scipy.spatial import cKDTree  # only who asks for a band needs it

        return cKDTree(self.states)


def bands_of(data: Data, fit: Fit, spread: FitSpread, rivals: Sequence[Operator]) -> Bands:
    """Gather what bands are made of.

    Parameters
    ----------
    data
        The records.
    fit
        The final fit, in their units.
    spread
        How sure its constants are.
    rivals
        Models of other kinds that fit the records equally well.

    Returns
    -------
    Bands
    """
    residual = model_output(data, fit.operator) - data.measured()
    rms = float(np.sqrt(np.mean(np.square(residual))))
    noise = min(_noise(data, residual), rms)
    # Noise is known only so well: what it may explain is no misfit.
    explained = noise**2 * (1.0 + SURE_OF_NOISE / math.sqrt(residual.size))
    low = min(float(each.u.min()) for each in data.records)
    centre = low + data.half_range
    states = _met(data, centre)
    misfit = math.sqrt(max(rms**2 - explained, 0.0))
    growth = SHARE_OF_OPENING * _line_leaves(data.inputs(), data.measured())
    if shows_minor_loops(stroke_lengths(data)):
        growth = min(growth, MISFITS * misfit)
    return Bands(
        fit=fit,
        spread=spread,
        noise=noise,
        misfit=misfit,
        residual=np.sort(np.abs(residual)) / rms if rms > 0.0 else np.zeros(0),
        growth=growth,
        at_rest=_left_at_rest(data, fit.operator, noise),
        half_range=data.half_range,
        centre=centre,
        states=states,
        spacing=_spacing(states),
        rivals=tuple(rivals),
    )


def _left_at_rest(data: Data, operator: Operator, noise: float) -> float:
    """Give what a model leaves, beside noise, of the beginnings of records that were not used."""
    left = []
    begun = zip(data.records, data.windows(), data.brought_forward(), strict=True)
    for record, window, output in begun:
        if window.start:
            model = operator.at_sample_time(record.dt)(record.u[: window.start])
            left.append(model - output[: window.start])
    if not left:
        return 0.0
    residual = np.concatenate(left)
    explained = noise**2 * (1.0 + SURE_OF_NOISE / math.sqrt(residual.size))
    return math.sqrt(max(float(np.mean(np.square(residual))) - explained, 0.0))


def as_level(level: float) -> float:
    """Check the level of a band.

    Parameters
    ----------
    level
        Share of samples.

    Raises
    ------
    InputError
        If it is not between 0 and 1.
    """
    share = as_positive(level, "level", "a share of samples above 0 and below 1, as 0.95")
    if share >= 1.0:
        raise InputError(f"level is {level}; give a share of samples above 0 and below 1, as 0.95")
    return share


def _noise(data: Data, residual: Array) -> float:
    """Give the noise of the records by repetition, or what of the residual is white."""
    found = [noise_by_repetition(record) for record in data.records]
    known = [each for each in found if each is not None]
    if known:
        return math.sqrt(float(np.mean(np.square(known))))
    return estimate_noise(residual)


def _met(data: Data, centre: float) -> Array:
    """Give the states that the records met, those on the way from sample to sample too."""
    fine = max(1, min(FINEST, MOST_STATES // max(data.measured().size, 1)))
    parts = []
    passes = zip(data.records, data.windows(), data.counted(), strict=True)
    for record, window, counts in passes:
        u = record.u[: window.stop]
        at = np.arange(fine * (u.size - 1) + 1) / fine if fine > 1 else np.arange(u.size)
        used = at >= window.start
        if counts is not None:
            nearest = np.clip(np.round(at).astype(np.intp) - window.start, 0, counts.size - 1)
            used &= counts[nearest]
        fine_u = np.interp(at, np.arange(u.size), u) if fine > 1 else u
        parts.append((fine_u, np.flatnonzero(used)))
    every = 1 + sum(places.size for _, places in parts) // MOST_STATES
    states, passed = list[Array](), 0
    for u, places in parts:
        chosen = places[-passed % every :: every]
        states.append(_states(u, centre, data.half_range, chosen))
        passed += places.size
    return np.concatenate(states)


def _states(
    u: Array, centre: float, half_range: float, places: NDArray[np.intp] | None = None
) -> Array:
    """Give input and memory, relative to the records' range, at all samples or at some.

    Their shape is (n, 1 + RADII); a long record goes by in blocks, and only those asked for stay.
    """
    signal = np.ascontiguousarray((finite_vector(u, "u") - centre) / half_range)
    radii = (np.arange(RADII) + 1.0) / (RADII + 1.0)
    memory = np.full(RADII, np.clip(-centre / half_range, -1.0, 1.0))
    parts = [np.empty((0, 1 + RADII))]
    for first in range(0, signal.size, BLOCK):
        block = signal[first : first + BLOCK]
        z = np.empty((block.size, RADII))
        _engine.play_outputs(radii.tolist(), memory, block, z)
        rows = np.column_stack([block, z])
        if places is not None:
            low, high = np.searchsorted(places, [first, first + block.size])
            rows = rows[places[low:high] - first]
        parts.append(rows)
    return np.concatenate(parts)


def _spacing(states: Array) -> float:
    """Give twice the median distance between neighbours in time: within it, nothing is new."""
    steps = np.linalg.norm(np.diff(states, axis=0), axis=1)
    return 2.0 * float(np.median(steps)) / math.sqrt(states.shape[1]) if steps.size else 0.0


def _line_leaves(u: Array, y: Array) -> float:
    centred, spread = u - u.mean(), y - y.mean()
    energy = float(centred @ centred)
    slope = float(centred @ spread) / energy if energy > 0.0 else 0.0
    return float(np.sqrt(np.mean(np.square(spread - slope * centred))))


def _normal_quantile(level: float) -> float:
    """Give how many standard deviations hold a share of normal errors."""
    from scipy.special import ndtri

    return float(ndtri(0.5 + level / 2.0))
