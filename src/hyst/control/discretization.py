"""From continuous to sampled linear systems: what a controller computes at every sample."""

from __future__ import annotations

from typing import Any, Literal, TypeAlias, get_args

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.checks.numbers import as_sample_time
from hyst.control.linear_system import LinearSystem, as_linear_system
from hyst.errors import InputError
from hyst.models import LinearDynamics

Array = NDArray[np.float64]

Method: TypeAlias = Literal["tustin", "zoh"]


def discretize(system: Any, dt: float, method: Method = "tustin") -> LinearSystem:
    """Sample a continuous system.

    ``"zoh"``, exact for inputs that are held between samples:
    ``[A_d B_d; 0 I] = exp([A B; 0 0] dt)``.
    ``"tustin"``, the trapezoidal rule, for inputs that run on between samples:
    ``A_d = (I - A dt/2)^-1 (I + A dt/2)``.
    Either keeps a stable system stable, for every dt.

    Parameters
    ----------
    system
        As ``as_linear_system`` takes it; with any number of inputs and outputs.
    dt
        Sample time, s, > 0.
    method
        ``"tustin"`` or ``"zoh"``.

    Returns
    -------
    LinearSystem
        With this dt. One that is sampled already, with the same dt, is given back as it is.

    Raises
    ------
    InputError
        If the system cannot be read or has another sample time, dt is not above 0, there is no
        such method, or the trapezoidal rule meets a pole at 2/dt.

    Examples
    --------
    >>> lag = discretize(([100.0], [1.0, 100.0]), dt=0.01, method="zoh")
    >>> bool(abs(lag.A[0, 0] - np.exp(-1.0)) < 1e-15)
    True
    """
    time = as_sample_time(dt)
    if method not in get_args(Method):
        raise InputError(f"method is {method!r}; give one of {', '.join(get_args(Method))}")
    given = as_linear_system(system)
    if given.dt > 0.0:
        if abs(given.dt - time) > 1e-6 * time:
            raise InputError(
                f"the system has dt = {given.dt:.6g} s, not {time:.6g} s; "
                "give the continuous system, or the same dt"
            )
        return given
    sampled = held(given, time) if method == "zoh" else _trapezoidal(given, time)
    return LinearSystem(*sampled, time)


def discretized_dynamics(
    system: Any, dt: float, method: Method = "tustin", *, of_input: int = 0, of_output: int = 0
) -> LinearDynamics:
    """Sample a continuous system, or one channel of it, as an operator.

    Parameters
    ----------
    system, dt, method
        As in ``discretize``. A disturbance observer has the inputs v, number 0, and y, number 1.
    of_input, of_output
        Which channel.

    Returns
    -------
    LinearDynamics
        With all states of the system, reached from this input or not.

    Raises
    ------
    InputError
        As ``discretize``, or if there is no such channel.

    Examples
    --------
    >>> pi = discretized_dynamics(([4.0, 8.0], [1.0, 0.0]), dt=0.5)
    >>> pi([1.0, 1.0, 1.0]).tolist()
    [6.0, 10.0, 14.0]
    """
    sampled = discretize(system, dt, method)
    if not (0 <= of_input < sampled.inputs and 0 <= of_output < sampled.outputs):
        raise InputError(
            f"there is no channel from input {of_input} to output {of_output}; the system has "
            f"{sampled.inputs} and {sampled.outputs}"
        )
    B, C = sampled.B[:, of_input], sampled.C[of_output]
    return LinearDynamics(sampled.A, B, C, float(sampled.D[of_output, of_input]), sampled.dt)


def held(system: LinearSystem, dt: float) -> tuple[Array, Array, Array, Array]:
    """Sample a continuous system whose inputs are held between samples; exact.

    Parameters
    ----------
    system
        In continuous time.
    dt
        Sample time, s, > 0.

    Returns
    -------
    A, B, C, D
    """
    n, m = system.B.shape
    if n == 0:
        return system.A, system.B, system.C, system.D
    block = np.zeros((n + m, n + m))
    # Canonical forms have entries of very different size, on which the exponential loses digits.
    balanced, scale = _balanced(system.A)
    block[:n, :n], block[:n, n:] = balanced * dt, system.B / scale[:, None] * dt
    sampled = scipy.linalg.expm(block)
    A = sampled[:n, :n] * scale[:, None] / scale
    return A, sampled[:n, n:] * scale[:, None], system.C, system.D


def _balanced(A: Array) -> tuple[Array, Array]:
    # Scales beyond 2^63 are cast to whole numbers for a permutation that nobody asks for.
    with np.errstate(invalid="ignore"):
        balanced, (scale, _) = scipy.linalg.matrix_balance(A, permute=False, separate=True)
    return balanced, scale


def _trapezoidal(system: LinearSystem, dt: float) -> tuple[Array, Array, Array, Array]:
    if system.order == 0:
        return system.A, system.B, system.C, system.D
    # Unbalanced, an observer whose states differ by 1e10 in size would look singular.
    balanced, scale = _balanced(system.A)
    half, one = 0.5 * dt * balanced, np.eye(system.order)
    if np.linalg.cond(one - half) > 1e14:
        raise InputError(
            f"the trapezoidal rule cannot sample a pole at 2/dt = {2.0 / dt:.6g} rad/s; "
            "give method='zoh' or another dt"
        )
    solved = np.linalg.solve(one - half, np.hstack([one + half, dt * system.B / scale[:, None]]))
    A: Array = solved[:, : system.order] * scale[:, None] / scale
    B: Array = solved[:, system.order :] * scale[:, None]
    C: Array = np.linalg.solve((one - half).T, (system.C * scale).T).T / scale
    return A, B, C, system.D + 0.5 * C @ (dt * system.B)
