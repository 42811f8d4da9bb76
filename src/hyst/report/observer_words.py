"""Words and numbers of loops in the answer of an observer."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.control import ClosedLoop
from hyst.report.tables import number

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_LEFT = math.sqrt(0.5)

SIGNS = (
    "Pn is the nominal plant, v what controller and observer ask of it. Wu says how far the true "
    "plant P may be off: |P / Pn - 1| <= |Wu|. T leads from a disturbance at the plant's input to "
    "v. Q filters the observer's estimate: of a disturbance 1 - Q is left, and Wp asks for "
    "|1 - Q| < 1 / |Wp|. The slope of hysteresis after inverse is 1 where the inverse is exact. "
    "Errors are without and with the observer, and count from the spec's settle on."
)
"""What the letters on the page mean."""


def told(error: float) -> str:
    """Write an error; one of a loop that diverged is infinite.

    Parameters
    ----------
    error
        In units of the output.

    Returns
    -------
    str
    """
    return "diverges" if math.isinf(error) else number(error)


def finite(value: float | None) -> float | str | None:
    """Give a number as JSON can hold it, infinity as text.

    Parameters
    ----------
    value
        Number, or None.

    Returns
    -------
    float | str | None
    """
    return "inf" if value is not None and math.isinf(value) else value


def errors(loop: ClosedLoop) -> dict[str, Any]:
    """Give errors and drive of a loop as plain numbers, None where it diverged.

    Parameters
    ----------
    loop
        Simulated loop.

    Returns
    -------
    dict[str, Any]
    """
    diverged = loop.diverged_at is not None
    return {
        "rms": None if diverged else loop.rms_error,
        "max": None if diverged else loop.max_error,
        "max_drive": None if diverged else loop.max_drive,
        "diverged_at": loop.diverged_at,
    }


def ended(loop: ClosedLoop) -> str:
    """Say when a loop that diverged did.

    Parameters
    ----------
    loop
        A loop with ``diverged_at``.

    Returns
    -------
    str
    """
    return f"diverges at {loop.diverged_at:.4g} s"


def rightmost(poles: ComplexArray) -> str:
    """Write the pole with the largest real part.

    Parameters
    ----------
    poles
        Shape (n,), 1/s.

    Returns
    -------
    str
    """
    if poles.size == 0:
        return "none"
    worst = complex(poles[int(np.argmax(poles.real))])
    if abs(worst.imag) < 1e-9 * abs(worst):
        return f"{worst.real:+.4g}"
    return f"{worst.real:+.4g} +- {abs(worst.imag):.4g}j"


def rejection_bandwidth(numerator: Array, denominator: Array) -> float:
    """Give the frequency below which an observer rejects: where ``|1 - Q|`` first is 0.707.

    Parameters
    ----------
    numerator, denominator
        Of Q(s), highest power first, s in 1/s.

    Returns
    -------
    float
        Hz; infinite where all frequencies are below 0.707.

    Examples
    --------
    >>> Q = np.array([10.0]), np.array([1.0, 10.0])  # 1 - Q = s / (s + 10)
    >>> round(2.0 * math.pi * rejection_bandwidth(*Q), 6)
    10.0
    """
    poles = np.abs(np.roots(denominator))
    poles = poles[poles > 0.0]
    if poles.size == 0:
        return math.inf
    w = np.geomspace(1e-4 * poles.min(), 1e4 * poles.max(), 20_000)
    reached = np.flatnonzero(_left(numerator, denominator, w) >= _LEFT)
    if reached.size == 0:
        return math.inf
    high = float(w[reached[0]])
    low = float(w[max(reached[0] - 1, 0)])
    for _ in range(50):
        middle = math.sqrt(low * high)
        is_left = _left(numerator, denominator, np.array([middle]))[0] >= _LEFT
        low, high = (low, middle) if is_left else (middle, high)
    return high / (2.0 * math.pi)


def bandwidth_told(numerator: Array, denominator: Array) -> str:
    """Write the bandwidth of rejection.

    Parameters
    ----------
    numerator, denominator
        Of Q(s), highest power first.

    Returns
    -------
    str
    """
    bandwidth = rejection_bandwidth(numerator, denominator)
    if math.isinf(bandwidth):
        return "|1 - Q| stays below 0.707 at all frequencies"
    return f"{number(bandwidth)} Hz, where |1 - Q| first is 0.707"


def _left(numerator: Array, denominator: Array, w: Array) -> Array:
    s = 1j * w
    of = np.polyval(denominator, s)
    return np.asarray(np.abs((of - np.polyval(numerator, s)) / of))
