"""Sampled linear dynamics from a measured frequency response.

Poles move as vector fitting has them: a weighted linear least squares problem for residues and for
those of a common denominator, whose zeros are the next poles, until they stay. The basis is partial
fractions about the present poles, so that many states near z = 1 are no worse than few. Whole
samples of delay are searched; what is left of one is in the numerator.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.errors import NotIdentifiableError
from hyst.models import LinearDynamics
from hyst.signals import MeasuredResponse

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

ORDERS = (1, 2, 3, 4, 6, 8, 10, 12)
"""Tried one after the other: a resonance takes two states at once."""

WORST_FIT = 0.1
"""Rms error, of the rms of the response: more is no description of it."""

_FEWEST_POINTS = 8
_FLOOR = 0.02  # of the largest magnitude: smaller values count no more than this
_ITERATIONS, _SETTLED = 25, 1e-10
_ENOUGH = 1e-5  # relative error: no analyser measures better
_A_PARAMETER = 3.0  # times the criterion's penalty: poles go where noise helps most
_MOST_DELAYS = 10  # tried at once, evenly between 0 and the longest
_PATIENCE = 2  # orders that may pay nothing before the search ends
_BEYOND = 512  # frequencies between the last that was measured and half the sample rate
_OUTERMOST = 1.0 - 1e-9


@dataclass(frozen=True, eq=False)
class FittedResponse:
    """Dynamics fitted to a frequency response, and how well.

    Parameters
    ----------
    dynamics
        Stable, with their gain as it was measured.
    error
        Rms of what is left, over the rms of the response.
    largest_error, at
        The largest of it, over the largest magnitude, and the frequency where it is, Hz.
    used
        Points below half the sample rate.
    """

    dynamics: LinearDynamics
    error: float
    largest_error: float
    at: float
    used: int


@dataclass(frozen=True, eq=False)
class _Points:
    """A response on the unit circle, with weights."""

    z: Complex
    values: Complex
    weights: Array

    def advanced(self, delay: int) -> Complex:
        """Give the values without so many samples of delay."""
        return np.asarray(self.values * self.z**delay)


@dataclass(frozen=True, eq=False)
class _Candidate:
    poles: Complex
    delay: int
    cost: float


def fitted_response(measured: MeasuredResponse, dt: float) -> FittedResponse:
    """Fit stable sampled dynamics to a frequency response, of the least order that pays.

    ``G(z) = z^-delay (D + sum_i c_i / (z - p_i))`` is fitted to relative errors, values below a
    fiftieth of the largest counting as if they were that. The order is that of the least Bayesian
    criterion, with three times its penalty; no order is taken whose response is larger beyond the
    frequencies given than at them.

    Parameters
    ----------
    measured
        The response; what is at or above half the sample rate is not used.
    dt
        Sample time, s.

    Returns
    -------
    FittedResponse

    Raises
    ------
    NotIdentifiableError
        If fewer than eight points are left, or no order up to 12 fits to a tenth.

    Notes
    -----
    Gustavsen and Semlyen, Rational approximation of frequency domain responses by vector fitting,
    IEEE Trans. Power Delivery 14 (1999), eqs. 2-9; Sanathanan and Koerner (1963).
    """
    below = measured.frequency < 0.5 / dt * (1.0 - 1e-9)
    if int(below.sum()) < _FEWEST_POINTS:
        raise NotIdentifiableError(
            f"the frequency response has {int(below.sum())} points below half the sample rate, "
            f"{0.5 / dt:.6g} Hz; give at least {_FEWEST_POINTS}"
        )
    f, values = measured.frequency[below], measured.response[below]
    size = np.abs(values)
    z = np.exp(2j * np.pi * f * dt)
    points = _Points(z, values, 1.0 / np.maximum(size, _FLOOR * size.max()))
    best = _best(points, _longest_delay(f, values, dt))
    dynamics = _dynamics(points, best, dt)
    left = np.abs(dynamics.frequency_response(f) - values)
    error = float(np.sqrt(np.mean(left**2) / np.mean(size**2)))
    if not error <= WORST_FIT:
        raise NotIdentifiableError(
            f"linear dynamics of order {dynamics.order} leave {100.0 * error:.3g} % of the "
            f"frequency response, and no order up to {ORDERS[-1]} leaves {100 * WORST_FIT:.0f} %; "
            "give more frequencies where it changes quickly, leave out those that are noise, or "
            "check magnitude and phase"
        )
    worst = int(left.argmax())
    return FittedResponse(
        dynamics, error, float(left[worst] / size.max()), float(f[worst]), int(f.size)
    )


def _longest_delay(f: Array, values: Complex, dt: float) -> int:
    """Give the whole samples that would make all of the phase, as stable systems without lead."""
    phase = np.unwrap(np.angle(values))
    turned = float((phase[0] - phase).max())
    return int(min(max(np.ceil(turned / (2.0 * np.pi * float(f[-1]) * dt)), 0), 10_000)) + 1


def _best(points: _Points, longest: int) -> _Candidate:
    """Give poles and delay of the order with the least criterion."""
    count = 2 * points.z.size
    found: _Candidate | None = None
    best, least, without_gain = None, np.inf, 0
    for order in ORDERS:
        if 2 * order + 1 > count // 2:
            break
        found = _with_delay(points, order, longest, found)
        mean = max(found.cost / count, _ENOUGH**2)
        if best is not None and _rises_beyond(points, found):
            continue
        criterion = count * np.log(mean) + _A_PARAMETER * (2 * order + 1) * np.log(count)
        if criterion < least:
            best, least, without_gain = found, criterion, 0
        else:
            without_gain += 1
        if mean <= _ENOUGH**2 or without_gain > _PATIENCE:
            break
    assert best is not None, "eight points allow the first order"
    return best


def _rises_beyond(points: _Points, found: _Candidate) -> bool:
    """Tell whether dynamics are larger where nothing was measured than where something was."""
    highest = float(np.angle(points.z).max())
    beyond = np.exp(1j * np.linspace(min(1.05 * highest, np.pi), np.pi, _BEYOND))
    own = _residues(points, found)
    with_constant = np.column_stack([_basis(beyond, found.poles), np.ones(beyond.size)])
    return bool(np.abs(with_constant @ own).max() > np.abs(points.values).max())


def _with_delay(points: _Points, order: int, longest: int, before: _Candidate | None) -> _Candidate:
    """Give the best delay of an order: a coarse search, then its neighbours, until none is less."""
    tried: dict[int, _Candidate] = {}

    def cost(delay: int) -> float:
        if delay not in tried:
            tried[delay] = _relocated(points, order, delay)
        return tried[delay].cost

    step = max((longest + _MOST_DELAYS - 1) // _MOST_DELAYS, 1)
    starts = list(range(0, longest + 1, step))
    if before is not None:
        starts.append(before.delay)
    best = min(starts, key=cost)
    while step >= 1:
        near = [each for each in (best - step, best + step) if each >= 0]
        nearest = min([best, *near], key=cost)
        if nearest == best:
            step //= 2
        best = nearest
    return tried[best]


def _relocated(points: _Points, order: int, delay: int) -> _Candidate:
    """Move poles until they stay, and give the least of the costs on the way."""
    values = points.advanced(delay)
    poles = _first_poles(points, order)
    best = _Candidate(poles, delay, _cost(points, values, poles))
    for _ in range(_ITERATIONS):
        moved = _moved(points, values, poles)
        change = np.abs(np.sort_complex(moved) - np.sort_complex(poles)).max()
        poles = moved
        now = _cost(points, values, poles)
        if now < best.cost:
            best = _Candidate(poles, delay, now)
        if change < _SETTLED:
            break
    return best


def _first_poles(points: _Points, order: int) -> Complex:
    """Give lightly damped pairs over the band, and a real pole where the order is odd."""
    angles = np.angle(points.z)
    low, high = max(float(angles[angles > 0.0].min()), 1e-4), float(angles.max())
    pairs = order // 2
    beta = np.geomspace(max(low, 0.02 * high), high, pairs + 2)[1:-1] if pairs else np.zeros(0)
    upper = np.exp(-0.05 * beta + 1j * beta)
    real = [np.exp(-0.3 * high) + 0j] if order % 2 else []
    return np.concatenate([np.ravel(np.column_stack([upper, upper.conj()])), real])


def _basis(z: Complex, poles: Complex) -> Complex:
    """Give partial fractions with real coefficients: of a pair, their sum and i their difference.

    Poles come as conjugate pairs, the upper first, then real ones.
    """
    columns = np.empty((z.size, poles.size), dtype=np.complex128)
    i = 0
    while i < poles.size:
        one = 1.0 / (z - poles[i])
        if poles[i].imag != 0.0:
            other = 1.0 / (z - poles[i + 1])
            columns[:, i], columns[:, i + 1] = one + other, 1j * (one - other)
            i += 2
        else:
            columns[:, i] = one
            i += 1
    return columns


def _stacked(rows: Complex | Array) -> Array:
    return np.concatenate([rows.real, rows.imag])


def _weighted(points: _Points, values: Complex, poles: Complex) -> tuple[Array, Array]:
    with_constant = np.column_stack([_basis(points.z, poles), np.ones(points.z.size)])
    weighted = points.weights[:, None] * with_constant
    return _stacked(weighted), _stacked(points.weights * values)


def _cost(points: _Points, values: Complex, poles: Complex) -> float:
    columns, target = _weighted(points, values, poles)
    left = target - columns @ scipy.linalg.lstsq(columns, target)[0]
    return float(left @ left)


def _moved(points: _Points, values: Complex, poles: Complex) -> Complex:
    """Give the zeros of the common denominator, mirrored into the unit circle."""
    columns, target = _weighted(points, values, poles)
    basis = columns[:, :-1]
    times_values = _stacked((points.weights * values)[:, None] * _basis(points.z, poles))
    q, _ = scipy.linalg.qr(columns, mode="economic")
    left = -(times_values - q @ (q.T @ times_values))
    scale = np.maximum(np.linalg.norm(left, axis=0), 1e-300)
    own = scipy.linalg.lstsq(left / scale, target - q @ (q.T @ target))[0] / scale
    assert basis.shape[1] == own.size, "one residue for each pole"
    A, B = _real_form(poles)
    return _mirrored(np.linalg.eigvals(A - np.outer(B, own)).astype(np.complex128))


def _real_form(poles: Complex) -> tuple[Array, Array]:
    """Give A and B of the basis, real: its fractions are ``e_i' (z - A)^-1 B``."""
    A, B = np.zeros((poles.size, poles.size)), np.ones(poles.size)
    i = 0
    while i < poles.size:
        if poles[i].imag != 0.0:
            re, im = poles[i].real, poles[i].imag
            A[i : i + 2, i : i + 2] = [[re, im], [-im, re]]
            B[i : i + 2] = 2.0, 0.0
            i += 2
        else:
            A[i, i] = poles[i].real
            i += 1
    return A, B


def _mirrored(poles: Complex) -> Complex:
    """Give conjugate pairs, the upper first, then real poles; all inside the unit circle."""
    size = np.abs(poles)
    inside = np.where(size > 1.0, poles / np.maximum(size, 1e-300) ** 2, poles)
    size = np.abs(inside)
    inside = np.where(size > _OUTERMOST, inside * (_OUTERMOST / np.maximum(size, 1e-300)), inside)
    upper = inside[inside.imag > 0.0]
    real = inside[inside.imag == 0.0]
    return np.concatenate([np.ravel(np.column_stack([upper, upper.conj()])), real])


def _residues(points: _Points, found: _Candidate) -> Array:
    """Give the numerators of the basis, then the constant."""
    columns, target = _weighted(points, points.advanced(found.delay), found.poles)
    scale = np.linalg.norm(columns, axis=0)
    return np.asarray(scipy.linalg.lstsq(columns / scale, target)[0] / scale)


def _dynamics(points: _Points, found: _Candidate, dt: float) -> LinearDynamics:
    residues = _residues(points, found)
    A, B = _real_form(found.poles)
    return LinearDynamics(A, B, residues[:-1], float(residues[-1]), dt, found.delay)
