"""The H-infinity norm by the Hamiltonian method of Bruinsma and Steinbuch."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.control.linear_system import LinearSystem, as_linear_system, balanced
from hyst.errors import SolverError

Array = NDArray[np.float64]

_ITERATIONS = 60
_AROUND = np.array([-2.0, -1.0, -0.5, -0.2, 0.0, 0.2, 0.5, 1.0, 2.0])


def hinf_norm(system: Any, tolerance: float = 1e-8) -> tuple[float, float]:
    r"""Give the H-infinity norm of a system and the frequency at which it is reached.

    ``norm = sup over w of sigma_max(G(jw))``, infinite unless all poles are stable.

    Parameters
    ----------
    system
        Transfer function or state space of python-control, pair (num, den), matrices
        (A, B, C, D) or LinearSystem; continuous or sampled, any number of inputs and outputs.
    tolerance
        Relative accuracy of the norm.

    Returns
    -------
    norm, frequency
        The frequency in rad/s; ``inf`` if the norm is that of D. Without stability the norm is
        ``inf`` and the frequency that of the pole that is furthest from stable.

    Raises
    ------
    InputError
        If system is none of these, or is improper.
    SolverError
        If the iteration does not settle.

    Source
    ------
    N.A. Bruinsma and M. Steinbuch, A fast algorithm to compute the H-infinity norm of a transfer
    function matrix, Systems and Control Letters 14, 1990.

    Examples
    --------
    A resonance with damping 0.1 peaks at 1 / (2 zeta sqrt(1 - zeta^2)).

    >>> norm, frequency = hinf_norm(([1.0], [1.0, 0.2, 1.0]))
    >>> round(norm, 6), round(frequency, 4)
    (5.025189, 0.9899)
    """
    given = as_linear_system(system)
    continuous = given if given.dt == 0.0 else bilinear(given)
    if continuous is None:
        return np.inf, np.pi / given.dt
    poles = continuous.poles()
    # An eigenvalue is known to the rounding of A, and no better.
    margin = 10.0 * np.finfo(float).eps * max(np.abs(balanced(continuous).A).max(initial=0.0), 0.0)
    if poles.size and poles.real.max() >= -margin:
        norm, frequency = np.inf, float(abs(poles[np.argmax(poles.real)].imag))
    else:
        norm, frequency = peak_gain(continuous, tolerance)
    if given.dt:
        frequency = 2.0 * np.arctan(frequency) / given.dt
    return norm, frequency


def peak_gain(system: LinearSystem, tolerance: float = 1e-8) -> tuple[float, float]:
    """Give the largest gain over all frequencies of a continuous system without poles on the axis.

    Raises
    ------
    SolverError
        If the iteration does not settle, at the given tolerance.
    """
    scale = float(np.abs(system.poles()).max(initial=0.0)) or 1.0
    A, B, C, D = _in_units(balanced(system), scale)
    plain = LinearSystem(A, B, C, D)
    norm, frequency = _start(plain)
    for _ in range(_ITERATIONS):
        if norm == 0.0:
            break
        test = (1.0 + 0.5 * tolerance) * norm
        crossings = _crossings(plain, test)
        middles = np.sqrt(crossings[:-1] * crossings[1:])
        # Those off the axis by rounding are kept as well: a value of the gain cannot mislead.
        tried = np.concatenate([crossings, middles])
        gains = _gains(plain, tried)
        if gains.size == 0 or gains.max() <= test:
            return norm, frequency * scale
        norm, frequency = float(gains.max()), float(tried[np.argmax(gains)])
    else:
        raise SolverError(
            f"the norm did not settle in {_ITERATIONS} steps, at {norm:.6g}; scale the system or "
            f"allow more than {tolerance:g}"
        )
    return norm, frequency * scale


def _in_units(system: LinearSystem, scale: float) -> tuple[Array, Array, Array, Array]:
    """Measure time in 1/scale: the gains are the same, at frequencies divided by scale."""
    root = np.sqrt(scale)
    return system.A / scale, system.B / root, system.C / root, system.D


def _start(system: LinearSystem) -> tuple[float, float]:
    """Gain at 0, at infinity and near each resonance: a good lower bound saves steps."""
    norm, frequency = float(np.linalg.norm(system.D, 2)), np.inf
    poles = system.poles()
    # Around each pole too: where eigenvalues are ill-conditioned a sharp peak shows only here.
    around = np.abs(poles.imag)[:, None] + np.abs(poles.real)[:, None] * _AROUND
    tried = np.unique(np.concatenate([[0.0], np.abs(poles), np.abs(around).ravel()]))
    gains = _gains(system, tried)
    if gains.max() >= norm:
        norm, frequency = float(gains.max()), float(tried[np.argmax(gains)])
    return norm, frequency


def _gains(system: LinearSystem, frequencies: Array) -> Array:
    if frequencies.size == 0:
        return np.zeros(0)
    return np.asarray(np.linalg.norm(system.response(1j * frequencies), 2, axis=(1, 2)))


def _crossings(system: LinearSystem, level: float) -> Array:
    """Frequencies at which a singular value may equal the level, ascending.

    Eigenvalues of the Hamiltonian pencil; written with the outputs as unknowns, so that a level
    near the norm of D needs no inverse.
    """
    n, m, q = system.order, system.inputs, system.outputs
    B, C, D = system.B / np.sqrt(level), system.C / np.sqrt(level), system.D / level
    left = np.block(
        [
            [system.A, np.zeros((n, n)), B, np.zeros((n, q))],
            [np.zeros((n, n)), -system.A.T, np.zeros((n, m)), -C.T],
            [np.zeros((m, n)), B.T, -np.eye(m), D.T],
            [C, np.zeros((q, n)), D, -np.eye(q)],
        ]
    )
    right = np.zeros_like(left)
    right[: 2 * n, : 2 * n] = np.eye(2 * n)
    with np.errstate(divide="ignore", invalid="ignore"):
        values = scipy.linalg.eigvals(left, right)
    values = values[np.isfinite(values)]
    return np.unique(np.abs(values.imag[np.abs(values.imag) > 0.0]))


def bilinear(system: LinearSystem) -> LinearSystem | None:
    """Give the continuous system of the same gains; None if there is a pole at -1."""
    shifted = system.A + np.eye(system.order)
    if system.order and np.linalg.cond(shifted) > 1.0 / np.finfo(float).eps:
        return None
    inverse = np.linalg.inv(shifted)
    return LinearSystem(
        inverse @ (system.A - np.eye(system.order)),
        np.sqrt(2.0) * inverse @ system.B,
        np.sqrt(2.0) * system.C @ inverse,
        system.D - system.C @ inverse @ system.B,
    )
