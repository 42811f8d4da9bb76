"""Columns whose weighted sums are models richer than hysteresis with dynamics behind it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.models import Dahl, LinearDynamics

Array = NDArray[np.float64]

RADII = np.concatenate([[0.0], np.geomspace(0.03, 0.9, 8)])
"""Of plays in front, over half the drive's range."""

OWN_RADII = RADII[[1, 3, 5, 7]]
"""Of plays with dynamics of their own, and of plays of the output."""

SOFT = (0.03, 0.1, 0.3, 1.0)
"""Ways, over half the drive's range, after which smooth hysteresis has forgotten a reversal."""

_MOST_STATES = 8


def columns_of_front(u: Array, dynamics: LinearDynamics) -> Array:
    """Give any rate-independent hysteresis, followed by given dynamics.

    Plays make up what is congruent and Dahl's loops what bends smoothly; their powers and products
    with the input make loops that are asymmetric or not congruent.

    Parameters
    ----------
    u
        Shape (n,), from rest at 0.
    dynamics
        Behind it.

    Returns
    -------
    numpy.ndarray
        Shape (n, k); the first column is the input behind the dynamics.
    """
    half = float(np.ptp(u)) / 2.0
    plays = _plays(u, RADII * half) / half
    drive = u[:, None] / half
    soft = np.column_stack([Dahl(1.0, each * half)(u) for each in SOFT]) / half
    few, some = plays[:, ::2], plays[:, 2:8:2]
    shapes = [plays, few**2, few**3, drive * some, drive**2 * some, drive * some**2]
    shapes += [soft, drive * soft, drive**2 * soft]
    return _through(dynamics, np.column_stack(shapes))


def columns_behind(dynamics: LinearDynamics, signal: Array) -> Array:
    """Give what small changes of poles, zeros and delay do to the output of dynamics.

    Parameters
    ----------
    dynamics
        That gave the signal.
    signal
        Shape (n,), from rest at 0.
    """
    late = [np.concatenate([np.zeros(k), signal])[: signal.size] for k in (1, 2)]
    return np.column_stack([*late, _states(dynamics, signal)])


def columns_of_own_dynamics(u: Array, dynamics: LinearDynamics) -> Array:
    """Give plays each of which is followed by dynamics of its own, with poles in common.

    Parameters
    ----------
    u
        Shape (n,), from rest at 0.
    dynamics
        With the poles.
    """
    plays = _plays(u, OWN_RADII * (float(np.ptp(u)) / 2.0))
    return np.column_stack([_states(dynamics, each) for each in plays.T])


def columns_of_output(modelled: Array, dynamics: LinearDynamics) -> Array:
    """Give hysteresis and curves of the output: behind the dynamics, or fed back into them.

    Parameters
    ----------
    modelled
        Shape (n,), output of a model without noise, from rest at 0.
    dynamics
        Into which they are fed.
    """
    reach = float(np.ptp(modelled)) / 2.0 or 1.0
    scaled = modelled[:, None] / reach
    plays = _plays(modelled, OWN_RADII * reach) / reach
    shapes = np.column_stack([plays, scaled**2, scaled**3])
    return np.column_stack([shapes, _through(dynamics, shapes)])


def _plays(signal: Array, radii: Array) -> Array:
    """Give the outputs of plays that start from rest, one a column."""
    z = np.empty((signal.size, radii.size))
    _engine.play_outputs(radii.tolist(), np.zeros(radii.size), signal, z)
    return z


def _through(dynamics: LinearDynamics, columns: Array) -> Array:
    return np.column_stack([dynamics(np.ascontiguousarray(each)) for each in columns.T])


def _states(dynamics: LinearDynamics, signal: Array) -> Array:
    """Give the states of the dynamics behind a signal: their sums are all dynamics of its poles."""
    signal = np.ascontiguousarray(signal)
    late = np.concatenate([np.zeros(dynamics.delay), signal])[: signal.size]
    behind = [
        LinearDynamics(dynamics.A, dynamics.B, row, 0.0, dynamics.dt, dynamics.delay)(signal)
        for row in np.eye(dynamics.order)[:_MOST_STATES]
    ]
    return np.column_stack([late, *behind])
