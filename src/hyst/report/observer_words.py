"""Words and numbers of loops in the answer of an observer."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.control import ClosedLoop
from hyst.report.tables import number

ComplexArray = NDArray[np.complex128]


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
