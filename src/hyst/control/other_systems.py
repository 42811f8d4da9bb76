"""Linear systems as scipy.signal and the rest of hyst write them, as matrices."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.models import ContinuousDynamics
from hyst.models.realizations import cascade, companion, sections_of
from hyst.models.state_space import StateSpace
from hyst.operators import Operator

Array = NDArray[np.float64]
Given = tuple[Array, Array, Array, Array, Any]


def matrices_of_other(system: Any, name: str) -> Given | None:
    """Give A, B, C, D and the sample time, as it is written, of what is not of python-control.

    Parameters
    ----------
    system
        ``lti`` or ``dlti`` of scipy.signal, ``hyst.LinearDynamics``, or ``ContinuousDynamics``.
    name
        What messages call it.

    Returns
    -------
    tuple or None
        None if it is none of these.

    Raises
    ------
    InputError
        If it is one that has no matrices: a frequency response, a model with hysteresis, or a
        continuous system with dead time.
    """
    if isinstance(system, StateSpace):
        return *with_delay_states(system), system.dt
    if isinstance(system, ContinuousDynamics):
        if system.delay > 0.0:
            raise InputError(
                f"{name} has a dead time of {system.delay:.6g} s, which no continuous system of "
                "finite order has; give the sampled system, or its dead time beside it as delay"
            )
        return _as_matrices((system.A, system.B, system.C, system.D), 0.0)
    if type(system).__module__.startswith("scipy.signal"):
        return _of_scipy(system, name)
    _refuse_what_has_no_matrices(system, name)
    return None


def with_delay_states(system: StateSpace) -> tuple[Array, Array, Array, Array]:
    """Give the matrices of a sampled system whose whole delay is written as states.

    Parameters
    ----------
    system
        With n states and a delay of d samples.

    Returns
    -------
    A, B, C, D
        Of n + d states, those of the delay behind the others, the oldest value first.
    """
    n, d = system.order, system.delay
    if d == 0:
        return _as_matrices((system.A, system.B, system.C, system.D), 0.0)[:4]
    a, b, c = np.zeros((n + d, n + d)), np.zeros((n + d, 1)), np.zeros((1, n + d))
    a[:n, :n], c[0, :n] = system.A, system.C
    a[:n, n], c[0, n], b[-1, 0] = system.B, system.D, 1.0
    a[np.arange(n, n + d - 1), np.arange(n + 1, n + d)] = 1.0
    return a, b, c, np.zeros((1, 1))


def _of_scipy(system: Any, name: str) -> Given:
    if hasattr(system, "A"):
        return system.A, system.B, system.C, np.atleast_2d(system.D), system.dt
    if hasattr(system, "gain"):
        zeros, poles = np.atleast_1d(system.zeros), np.atleast_1d(system.poles)
        if zeros.ndim != 1:
            raise InputError(f"{name} has several outputs as zeros, poles and gain; give one")
        _require_proper(zeros.size, poles.size, name)
        return _as_matrices(cascade(sections_of(zeros, poles, float(system.gain))), system.dt)
    num, den = np.atleast_1d(system.num), np.atleast_1d(system.den)
    if num.ndim != 1:
        raise InputError(
            f"{name} is a transfer function of scipy.signal with {len(num)} outputs; give its "
            "state space (to_ss), or one output"
        )
    num, den = np.trim_zeros(num, "f"), np.trim_zeros(den, "f")
    _require_proper(num.size - 1, den.size - 1, name)
    return _as_matrices(companion(num if num.size else [0.0], den), system.dt)


def _as_matrices(parts: tuple[Array, Array, Array, float], dt: Any) -> Given:
    A, B, C, D = parts
    return A, np.reshape(B, (-1, 1)), np.reshape(C, (1, -1)), np.array([[D]]), dt


def _require_proper(above: int, below: int, name: str) -> None:
    if above > below:
        raise InputError(
            f"{name} is improper: its numerator has degree {above}, its denominator {below}; add "
            "poles beyond the frequencies of interest"
        )


def _refuse_what_has_no_matrices(system: Any, name: str) -> None:
    if is_frequency_response(system):
        raise InputError(
            f"{name} is a frequency response, {type(system).__name__}, which has no states; fit a "
            "system to it, or give it to hyst.control.uncertainty_weight as a response"
        )
    if isinstance(system, Operator) or hasattr(system, "hysteresis_family"):
        raise InputError(
            f"{name} is a {type(system).__name__} of hyst, which is no linear system; "
            "hyst.control.identified_plant takes one with hysteresis in front and dynamics behind "
            "it apart"
        )


def is_frequency_response(system: Any) -> bool:
    """Tell whether this is a frequency response: of python-control, measured, or identified."""
    of_control = hasattr(system, "omega") and (
        hasattr(system, "frdata") or hasattr(system, "fresp")
    )
    return of_control or (hasattr(system, "frequency") and hasattr(system, "response"))
