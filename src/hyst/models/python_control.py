"""The one door between hyst and python-control, which is optional."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError, MissingExtraError
from hyst.models.realizations import companion, zero_order_hold

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


def matrices_of(system: Any, dt: float | None) -> tuple[Array, Array, Array, float, float]:
    """Read a state space or transfer function of python-control.

    Parameters
    ----------
    system
        With one input and one output.
    dt
        Sample time, s, if the system has none.

    Returns
    -------
    A, B, C, D, dt

    Raises
    ------
    InputError
        If it is something else, has several inputs or outputs, or no sample time is known.
    """
    if getattr(system, "ninputs", None) != 1 or getattr(system, "noutputs", None) != 1:
        raise InputError(
            f"{type(system).__name__} is no system of python-control with one input and one output"
        )
    own = system.dt
    sampled = own is not None and own is not True and own > 0.0
    if sampled and dt is not None and not np.isclose(own, dt, rtol=1e-9):
        raise InputError(f"the system has dt = {own}, not {dt}; leave out dt")
    time = float(own) if sampled else dt
    if time is None:
        raise InputError("the system has no sample time; give dt in seconds")
    continuous = own is not True and not sampled
    num, den = _polynomials(system)
    if continuous:
        return (*zero_order_hold(num, den, time), time)
    if hasattr(system, "A"):
        return system.A, np.ravel(system.B), np.ravel(system.C), float(system.D[0, 0]), time
    return (*companion(num, den), time)


def state_space_of(A: Array, B: Array, C: Array, D: float, dt: float, delay: int) -> Any:
    """Give the ``control.StateSpace`` of a system, its delay written as poles at 0.

    Parameters
    ----------
    A, B, C, D
        Shapes (n, n), (n,), (n,) and a number.
    dt
        Sample time, s.
    delay
        Samples.

    Raises
    ------
    MissingExtraError
        If python-control is not installed.
    """
    control = _python_control()
    n, d = B.size, delay
    a, b, c = np.zeros((n + d, n + d)), np.zeros((n + d, 1)), np.zeros((1, n + d))
    a[:n, :n], c[0, :n] = A, C
    if d == 0:
        b[:n, 0] = B
    else:
        # The first of the line is the oldest value: it feeds the system, u enters at the end.
        a[:n, n], c[0, n], b[-1, 0] = B, D, 1.0
        a[np.arange(n, n + d - 1), np.arange(n + 1, n + d)] = 1.0
    return control.ss(a, b, c, D if d == 0 else 0.0, dt, remove_useless_states=False)


def continuous_state_space_of(
    A: Array, B: Array, C: Array, D: float, delay: float, order: int
) -> Any:
    """Give the ``control.StateSpace`` of a continuous system, its dead time by Pade.

    Parameters
    ----------
    A, B, C, D
        Shapes (n, n), (n,), (n,) and a number.
    delay
        Dead time, s.
    order
        Of Pade's approximation; 0: without the dead time.

    Raises
    ------
    MissingExtraError
        If python-control is not installed.
    """
    control = _python_control()
    system = control.ss(A, B[:, None], C[None, :], D, remove_useless_states=False)
    if order == 0 or delay == 0.0:
        return system
    return control.series(control.tf2ss(*control.pade(delay, order)), system)


def frequency_response_data_of(response: Complex, frequency: Array, dt: float) -> Any:
    """Give the ``control.FrequencyResponseData`` of a sampled system.

    Parameters
    ----------
    response, frequency
        Shape (p,): complex values, and where, Hz.
    dt
        Sample time, s.

    Raises
    ------
    MissingExtraError
        If python-control is not installed.
    """
    return _python_control().frd(response, 2.0 * np.pi * frequency, dt)


def _python_control() -> Any:
    try:
        import control  # optional
    except ImportError:
        raise MissingExtraError(
            "python-control is not installed; install hyst[control] or the package control"
        ) from None
    return control


def _polynomials(system: Any) -> tuple[Array, Array]:
    if hasattr(system, "num") and not hasattr(system, "A"):
        return np.ravel(system.num[0][0]), np.ravel(system.den[0][0])
    den = np.atleast_1d(np.poly(system.A)).astype(np.float64)
    with_output = np.atleast_1d(np.poly(system.A - system.B @ system.C)).astype(np.float64)
    # det(sI - A + BC) = det(sI - A)(1 + C (sI - A)^-1 B)
    return with_output - den + float(system.D[0, 0]) * den, den
