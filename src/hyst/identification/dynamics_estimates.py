"""What is told of linear dynamics that were fitted as a whole: modes, gain, coefficients.

Entries of matrices belong to a realization, of which every system has endless many. Frequencies,
damping, time constants and the coefficients of the transfer function belong to the system.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.family import Estimates, Fit
from hyst.identification.families.hammerstein.coefficients import (
    coefficients,
    coefficients_by_theta,
)
from hyst.identification.fit.chain_parametrization import ChainParametrization
from hyst.identification.fit.free_dynamics import FreeDynamics

Array = NDArray[np.float64]
Told = list[tuple[str, float, Array]]
"""Name, value and derivative by a stage's own numbers."""

ONE_POLE = 1e-6
"""Poles nearer than this share of their size are one, and move as no derivative tells."""


def chain_of(fit: Fit) -> ChainParametrization:
    """Give the free constants of a fit of a model of one's own.

    Parameters
    ----------
    fit
        Made by ``hyst.fit``.
    """
    parametrization = fit.parametrization
    assert isinstance(parametrization, ChainParametrization), "hyst.fit made it"
    return parametrization


def estimates_of_chain(fit: Fit) -> Estimates:
    """Give the single constants, then of every stage of dynamics what is known of it.

    Parameters
    ----------
    fit
        Made by ``hyst.fit``.
    """
    parametrization, theta = chain_of(fit), fit.solution.theta
    constants = fit.operator.parameters()
    places = list(parametrization.single)
    rows = np.eye(len(places), theta.size)
    told = list(
        zip(
            (constants.names[i] for i in places),
            constants.values[places].tolist(),
            rows,
            strict=True,
        )
    )
    held = parametrization.sizes_held
    for each, is_held in zip(parametrization.dynamics, held, strict=True):
        prefix = f"{each.name}." if each.name else ""
        for name, value, by_own in told_of(each, theta, is_held):
            row = np.zeros(theta.size)
            row[each.own] = by_own
            told.append((prefix + name, value, row))
    names, values, by_theta = zip(*told, strict=True)
    return Estimates(tuple(names), np.array(values), np.array(by_theta))


def told_of(stage: FreeDynamics, theta: Array, size_is_held: bool) -> Told:
    """Give modes, gain at rest and coefficients of one stage.

    Parameters
    ----------
    stage
        Which one.
    theta
        Free parameters of the model.
    size_is_held
        Whether its gain is no estimate.
    """
    told = _modes(stage, theta)
    if not size_is_held:
        told.append(("gain", *stage.gain(theta)))
    dynamics = stage.dynamics(theta)
    n = dynamics.order
    if n == 0:  # the gain says it all
        return told
    values = coefficients(dynamics)
    rows = stage.by_own(coefficients_by_theta(dynamics, stage.feedthrough))
    names = [f"a[{i}]" for i in range(1, n + 1)] + [f"b[{i}]" for i in range(n + 1)]
    for i, name in enumerate(names):
        if name != "b[0]" or stage.feedthrough:  # without D it is 0, and no estimate
            told.append((name, float(values[i]), rows[i]))
    return told


def _modes(stage: FreeDynamics, theta: Array) -> Told:
    """Give frequency and damping of each pair of poles, the time constant of each single one."""
    dynamics = stage.dynamics(theta)
    if dynamics.order == 0:
        return []
    poles, right = np.linalg.eig(dynamics.A)
    apart = np.abs(poles[:, None] - poles[None, :]) + np.diag(np.full(poles.size, np.inf))
    if (apart < ONE_POLE * np.abs(poles)[:, None]).any():
        return []
    # The rows of the inverse are the left eigenvectors, scaled so that w' v = 1.
    by_k = np.linalg.solve(right, dynamics.B.astype(complex))[:, None] * right.T
    told, pairs, singles, dt = Told(), 0, 0, dynamics.dt
    for i in np.argsort(-np.abs(poles), kind="stable"):
        pole = complex(poles[i])
        row = np.zeros((1, 2 * dynamics.order + int(stage.feedthrough)), dtype=complex)
        row[0, : dynamics.order] = by_k[i]
        slope = stage.by_own(row.real)[0] + 1j * stage.by_own(row.imag)[0]
        if pole.imag > 0.0:
            pairs += 1
            told += _pair(pole, slope, dt, pairs)
        elif pole.imag == 0.0:
            singles += 1
            told += _single(pole.real, slope.real, dt, singles)
    return told


def _pair(pole: complex, slope: NDArray[np.complex128], dt: float, number: int) -> Told:
    """Give natural frequency, Hz, and damping, a share of the critical one, of a pair of poles."""
    s, by = np.log(pole), slope / pole
    size = abs(s)
    by_size = (np.conj(s) * by).real / size
    damping = -s.real / size
    by_damping = -(by.real + damping * by_size) / size
    hertz = 1.0 / (2.0 * np.pi * dt)
    return [
        (f"frequency[{number}]", float(size * hertz), by_size * hertz),
        (f"damping[{number}]", float(damping), by_damping),
    ]


def _single(pole: float, slope: Array, dt: float, number: int) -> Told:
    """Give the time constant, s, of a real pole; one without, at 0 or below, is told itself."""
    if pole <= 0.0:
        return [(f"pole[{number}]", pole, slope)]
    rate = np.log(pole)
    return [(f"time_constant[{number}]", float(-dt / rate), dt * slope / (pole * rate**2))]
