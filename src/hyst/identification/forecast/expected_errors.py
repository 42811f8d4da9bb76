"""Forecast the standard errors of an identification from its drive."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.checks.arrays import finite_vector
from hyst.checks.numbers import as_positive
from hyst.errors import InputError
from hyst.identification.forecast.advice import advice_on
from hyst.identification.forecast.drive_forecast import DriveForecast, ExpectedError
from hyst.identification.forecast.free_numbers import (
    FreeNumbers,
    free_numbers,
    frequency_and_damping,
    poles_by_directions,
)
from hyst.identification.forecast.information import Information
from hyst.identification.forecast.own_excitation import OwnLines
from hyst.identification.forecast.shared_numbers import places_to_hold, shared_directions
from hyst.models import LinearDynamics
from hyst.operators import Operator
from hyst.signals import Drive

Array = NDArray[np.float64]

MOST_SAMPLES = 200_000
"""Of a drive that are looked at; a longer one can only be better."""

_OFFSET = "offset"
_SHARED = 1e-6  # of a direction of scaled constants: more than its rounding

_HALF_RATE = (1.0 - 1e-9) * math.pi  # rad per sample

_SMALLEST, _LARGEST = 1e-100, 1e100  # of a signal, whose squares are formed

_MOST_ENTRIES = 4e7  # of the Jacobian, 0.3 GB


def forecast_drive(
    drive: Drive, model: Operator, *, noise: float | None = None, noise_db: float = 40.0
) -> DriveForecast:
    """Tell what a drive will determine of a stated model, and how well.

    The output is simulated; with J its derivative by the free numbers and white noise of standard
    deviation s, no unbiased fit has a covariance below ``s^2 (J'J)^-1``, and least squares comes to
    it on long records. Dynamics of order n count 2 n numbers and a feedthrough; their gain is held
    where hysteresis can take it up. An offset is found beside it all.

    Parameters
    ----------
    drive
        What will be played, from rest.
    model
        What the actuator is thought to be, as ``dynamics @ hysteresis``.
    noise
        Standard deviation of the sensor's noise, output units; ``noise_db`` is not used then.
    noise_db
        How far the noise lies below the rms of the output, dB.

    Returns
    -------
    DriveForecast
        It holds close to the stated model: a fit must come there first, and noise that is not white
        or other dynamics than stated make errors larger.

    Raises
    ------
    InputError
        If the drive or the model's output does not move, the model is for another sample time or
        has no constants, the drive has fewer samples than the model has numbers, or the noise is
        not above 0; or a signal is in units in which its squares overflow or vanish.

    Notes
    -----
    L. Ljung, System Identification, 2nd ed. (1999), sec. 7.4 (Cramer-Rao bound) and ch. 13.

    Examples
    --------
    >>> import hyst
    >>> from hyst.identification import sketched_stage
    >>> front = hyst.PrandtlIshlinskii([0.3], [0.4], 1.0)
    >>> stage = sketched_stage(1e-3, [(80.0, 0.05)], front=front)
    >>> slow = hyst.signals.multisine(1e-3, 4000, amplitude=1.0, band=(1.0, 20.0))
    >>> wide = hyst.signals.multisine(1e-3, 4000, amplitude=1.0, band=(1.0, 200.0))
    >>> forecast_drive(slow, stage).sufficient, forecast_drive(wide, stage).sufficient
    (False, True)
    """
    u = finite_vector(drive.u, "the drive")
    if np.ptp(u) == 0.0:
        raise InputError(f"the drive rests at {u[0]:.6g}, so it determines nothing; let it move")
    _require_possible_size(u, "the drive")
    model.require_sample_time(drive.dt, "the drive")
    free = free_numbers(model)
    numbers = free.directions.shape[1]
    if numbers == len(free.held):
        raise InputError("the model has no number to determine; give one with constants")
    u = u[: int(min(MOST_SAMPLES, _MOST_ENTRIES // len(free.directions)))]
    if u.size <= numbers:
        raise InputError(
            f"the drive has {u.size} samples and the model {numbers} numbers to determine; give a "
            "longer drive"
        )
    y = free.model(u)
    _require_possible_size(y, "the model's output")
    sigma = _noise_of(y, noise, noise_db)
    jacobian = free.model.jacobian(u) @ free.directions
    shared = shared_directions(free, u, jacobian)
    pivots = places_to_hold(shared)
    known = Information.of(jacobian, np.concatenate([free.held, np.eye(numbers)[pivots]]))
    dynamics = _errors_of_dynamics(free, known, sigma, drive, u)
    front = _errors_of_front(free, known, sigma, float(y.std()), (shared, pivots))
    delayed = any(each.delay for _, each in free.dynamics)
    evidence = _delay_evidence(y, known, sigma, delayed) if free.dynamics else None
    of_dynamics = free.count_of_dynamics - len(free.held)
    return DriveForecast(
        dynamics,
        front,
        of_dynamics,
        numbers - len(free.held) - of_dynamics,
        float(y.std()),
        sigma,
        int(u.size),
        evidence,
        advice_on(drive, free.leaves, dynamics, front, evidence),
    )


def _require_possible_size(signal: Array, what: str) -> None:
    size = float(np.abs(signal).max())
    if size and not _SMALLEST <= size <= _LARGEST:
        raise InputError(
            f"{what} goes to {size:.3g}; choose units in which that lies between {_SMALLEST:g} "
            f"and {_LARGEST:g}"
        )


def _noise_of(y: Array, noise: float | None, noise_db: float) -> float:
    if noise is not None:
        return as_positive(noise, "noise", "the standard deviation of the noise in output units")
    if not math.isfinite(noise_db):
        raise InputError(
            f"noise_db is {noise_db}; give how many dB the noise lies below the output"
        )
    size = float(y.std())
    if size == 0.0:
        raise InputError(
            "the model's output does not move, so this drive determines nothing; give a drive that "
            "moves, of an amplitude that the hysteresis answers"
        )
    return float(size * 10.0 ** (-noise_db / 20.0))


def _errors_of_dynamics(
    free: FreeNumbers, known: Information, sigma: float, drive: Drive, u: Array
) -> tuple[ExpectedError, ...]:
    """Give resonance and damping of pairs of poles, and the frequency of lags."""
    found = []
    for first, dynamics in free.dynamics:
        own = _own_lines(free, dynamics, drive, u, sigma)
        poles, by_k = poles_by_directions(dynamics)
        for index in np.argsort(np.abs(poles), kind="stable"):
            pole, slope = poles[index], by_k[index]
            # What turns its sign from sample to sample, or is gone after one, has no frequency.
            if pole.imag < 0.0 or not np.isfinite(pole) or pole.imag * dynamics.dt > _HALF_RATE:
                continue
            hertz, damping, slopes = frequency_and_damping(complex(pole), slope)
            there = float(np.abs(dynamics.frequency_response(hertz)[0]))
            shares = own.shares(complex(pole), there)
            lag = pole.imag == 0.0
            name = f"{'lag' if lag else 'resonance'} [Hz]"
            rows = np.zeros((2, known.scale.size))
            rows[:, first : first + slope.size] = slopes
            errors = known.standard_errors(rows, sigma)
            found.append(_expected(name, hertz, float(errors[0]), shares[0]))
            if not lag:
                what = f"damping of {hertz:.4g} Hz"
                found.append(_expected(what, damping, float(errors[1]), shares[1]))
    return tuple(found)


def _expected(name: str, value: float, error: float, share: float) -> ExpectedError:
    return ExpectedError(name, value, error, abs(value), share * abs(value))


def _own_lines(
    free: FreeNumbers, dynamics: LinearDynamics, drive: Drive, u: Array, sigma: float
) -> OwnLines:
    """Give the drive's lines behind what stands before the dynamics, as far as it is a gain."""
    v = u
    for leaf in free.leaves:
        if leaf is dynamics:
            break
        v = leaf(v)
    moved = u - u.mean()
    power = float(moved @ moved)
    gain = abs(float(moved @ v)) / power if power > 0.0 else 0.0
    return OwnLines.of(u, drive.dt, gain, sigma, drive.period)


def _errors_of_front(
    free: FreeNumbers,
    known: Information,
    sigma: float,
    size: float,
    shared: tuple[Array, NDArray[np.intp]],
) -> tuple[ExpectedError, ...]:
    found = []
    errors = known.standard_errors(np.eye(known.scale.size), sigma)
    samples = len(known.seen)
    is_shared = np.abs(shared[0]).max(axis=1, initial=0.0) > _SHARED
    for first, each in zip(free.first, free.leaves, strict=False):
        if isinstance(each, LinearDynamics):
            continue
        constants = each.parameters()
        for place, (name, value) in enumerate(zip(constants.names, constants.values, strict=True)):
            column = first + place
            # What would change the output as much as all of it.
            whole = size * math.sqrt(samples) / float(known.scale[column])
            by_chance = name == _OFFSET or value == 0.0  # its size says nothing of what matters
            scale = max(abs(float(value)), whole) if by_chance else abs(float(value))
            held = column in shared[1]
            error = 0.0 if held else float(errors[column])
            expected = ExpectedError(name, float(value), error, scale)
            found.append(replace(expected, shared=bool(is_shared[column]), held=held))
    return tuple(found)


def _delay_evidence(y: Array, known: Information, sigma: float, delayed: bool) -> float:
    """Tell by how much the output of a delay of one sample more, or less, is off at best."""
    later = known.unexplained(np.concatenate([y[:1], y[:-1]]) - y)
    earlier = known.unexplained(np.concatenate([y[1:], y[-1:]]) - y) if delayed else later
    return min(later, earlier) / sigma
