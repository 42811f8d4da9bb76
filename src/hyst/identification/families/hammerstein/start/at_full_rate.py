"""Dynamics found at a lower sample rate, brought back to that of the record.

Poles go to the power of the ratio of the rates. The rest is linear with them: numerator and delay
from what the states correlate with, then the weights of the inputs. States are scaled to be of one
size and independent for white drives, since powers of 1/z are nearly alike at a high rate.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.identification.families.hammerstein.start.output_error import (
    Guess,
    free_response,
    orthonormal,
    weights_behind,
)
from hyst.identification.families.hammerstein.start.play_inputs import Piece
from hyst.models import LinearDynamics

Array = NDArray[np.float64]

_NO_POLE = 0.02  # nearer to 0 than this at the low rate, a pole is over within a sample
_ROUNDS = 2
_RIDGE = 1e-12
_AS_LITTLE = 1.05  # times the least squared error
_ROUNDING = 1e-12  # of the output's power


@dataclass(frozen=True, eq=False)
class Dynamic:
    """Dynamics at the rate of the record, and the weights of the inputs before them.

    Parameters
    ----------
    dynamics
        With their delay; gain and weights are determined together only.
    weights
        Shape (m,), of the inputs.
    cost
        Mean squared error of the output.
    """

    dynamics: LinearDynamics
    weights: Array
    cost: float


def raised_poles(a: Array, factor: int) -> NDArray[np.complex128]:
    """Give the poles at a rate higher by a factor; those without a counterpart there are left out.

    Parameters
    ----------
    a
        Denominator at the low rate, in rising powers of 1/z.
    factor
        Ratio of the rates.
    """
    poles = np.roots(a).astype(complex)
    if factor == 1:
        return poles
    real = np.abs(poles.imag) < 1e-9
    has = (np.abs(poles) > _NO_POLE) & ~(real & (poles.real < 0.0))
    return np.asarray(poles[has] ** (1.0 / factor))


def independent_states(poles: NDArray[np.complex128], dt: float) -> LinearDynamics:
    """Give dynamics with these poles, whose states are independent and of size 1 for white drives.

    Parameters
    ----------
    poles
        Inside the unit circle, in conjugate pairs.
    dt
        Sample time, s.
    """
    G = LinearDynamics.from_zeros_poles_gain([], poles, 1.0, dt)
    n = G.order
    equation = np.eye(n * n) - np.kron(G.A, G.A)
    gramian = np.linalg.solve(equation, np.outer(G.B, G.B).ravel()).reshape(n, n)
    values, vectors = np.linalg.eigh((gramian + gramian.T) / 2.0)
    root = vectors * np.sqrt(np.maximum(values, 1e-14 * values[-1]))
    A, B = np.linalg.solve(root, G.A @ root), np.linalg.solve(root, G.B)
    return LinearDynamics(A, B, np.zeros(B.size), 0.0, dt)


def at_full_rate(
    pieces: Sequence[Piece], low: Guess, factor: int, dt: float, delays: range
) -> Dynamic | None:
    """Bring a guess at a low rate back to that of the record.

    Parameters
    ----------
    pieces
        At the rate of the record.
    low
        At the low one.
    factor
        Ratio of the rates.
    dt
        Sample time of the record, s.
    delays
        Samples, to choose from.

    Returns
    -------
    Dynamic or None
        None where the poles have no counterpart.
    """
    poles = raised_poles(low.a, factor)
    if poles.size == 0:
        return None
    try:
        base = independent_states(poles, dt)
    except (InputError, np.linalg.LinAlgError):
        return None
    weights, found = np.zeros(pieces[0].inputs.shape[1]), None
    weights[:: 2 if weights.size > low.weights.size else 1] = low.weights
    for _ in range(_ROUNDS):
        dynamics = best_numerator(pieces, base, weights, delays)
        if dynamics is None:
            break
        again = with_best_weights(pieces, dynamics)
        if again is None or (found is not None and again.cost >= found.cost):
            break
        found, weights = again, again.weights
    return found


def with_best_weights(pieces: Sequence[Piece], dynamics: LinearDynamics) -> Dynamic | None:
    """Give the best weights of the inputs before known dynamics.

    Parameters
    ----------
    pieces
        Inputs and output.
    dynamics
        With their delay.
    """
    a = np.atleast_1d(np.poly(dynamics.A).real)
    answers = [np.stack([dynamics(each) for each in piece.inputs.T], axis=1) for piece in pieces]
    found = weights_behind(pieces, answers, a, dynamics.delay)
    return None if found is None else Dynamic(dynamics, *found)


def best_numerator(
    pieces: Sequence[Piece], base: LinearDynamics, weights: Array, delays: range
) -> LinearDynamics | None:
    """Give C, D and the delay that leave the least, for given A and B and a known drive of them.

    Products of late states with the output are those of the states with an early output, for all
    delays at once; what a delay moves over the ends of a piece is left out.

    Parameters
    ----------
    pieces
        Inputs and output.
    base
        Its A and B are taken.
    weights
        Of the inputs.
    delays
        Samples, to choose from.
    """
    import scipy.signal  # slow, and only dynamics need it

    a, order = np.atleast_1d(np.poly(base.A).real), base.order
    normal = np.zeros((order + 1, order + 1))
    moments, power = np.zeros((delays.stop, order + 1)), 0.0
    for each in pieces:
        first, stop = each.first, each.output.size
        if stop - first <= delays.stop + order:
            continue
        drive = each.inputs @ weights
        columns = np.column_stack([_states(base, drive), drive])
        own = orthonormal(free_response(a, stop - first))
        target = each.output[first:] - own @ (own.T @ each.output[first:])
        target, power = np.concatenate([np.zeros(first), target]), power + float(target @ target)
        # sum_k x_{k - d} y_k over the rows in use
        for place, column in enumerate(columns.T):
            products = scipy.signal.correlate(target, column, mode="full", method="fft")
            moments[:, place] += products[column.size - 1 : column.size - 1 + delays.stop]
        inside = columns[first:] - own @ (own.T @ columns[first:])
        normal += inside.T @ inside
    scale = np.sqrt(np.maximum(np.diag(normal), 1e-300))
    matrix = normal / np.outer(scale, scale) + _RIDGE * np.eye(scale.size)
    wanted = (moments[delays.start :] / scale).T
    try:
        solutions = np.linalg.solve(matrix, wanted)
    except np.linalg.LinAlgError:
        return None
    explained = np.sum(solutions * (2.0 * wanted - matrix @ solutions), axis=0)
    # A periodic drive repeats itself: the least delay that leaves as little is meant.
    left = np.maximum(power - explained, 0.0)
    best = int(np.argmax(left <= _AS_LITTLE * left.min() + _ROUNDING * power))
    solution = solutions[:, best] / scale
    delay = delays.start + best
    if not np.isfinite(solution).all():
        return None
    return LinearDynamics(base.A, base.B, solution[:-1], solution[-1], base.dt, delay)


def _states(base: LinearDynamics, drive: Array) -> Array:
    """Give the states of A and B, from rest, shape (samples, order)."""
    units = np.eye(base.order)
    each = [LinearDynamics(base.A, base.B, row, 0.0, base.dt)(drive) for row in units]
    return np.stack(each, axis=1)
