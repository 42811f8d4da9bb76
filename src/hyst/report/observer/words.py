"""Words and numbers of loops in the answer of an observer."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hyst.report.table import number

ComplexArray = NDArray[np.complex128]

SIGNS = (
    "All of this is of the sampled block, with the hold between its samples and its delay. Pn is "
    "the nominal plant, v what controller and observer ask of it. Wu says how far the true plant P "
    "may be off: |P / Pn - 1| <= |Wu|; what that does above half the sample rate folds down and is "
    "counted in Wu T. T leads from a disturbance at the plant's input to v. E is what the observer "
    "leaves of such a disturbance, 1 - Q in continuous time; Wp asks for |E| < 1 / |Wp|. The slope "
    "of hysteresis after inverse is 1 where the inverse is exact. A loop is proven if it is stable "
    "for every plant within Wu and all slopes that hysteresis after inverse can have. Errors count "
    "from the spec's settle on."
)
"""What the letters on the page mean."""

STANDINGS = {"proven": "proven", "simulated": "simulated, not proven", "not safe": "NOT SAFE"}
"""How a table says what is known of a loop."""


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


def hertz(w: float) -> str:
    """Write a frequency.

    Parameters
    ----------
    w
        rad/s.

    Returns
    -------
    str
        In Hz.
    """
    return f"{number(w / (2.0 * math.pi))} Hz"


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


def bandwidth_told(bandwidth: float) -> str:
    """Write a bandwidth of rejection.

    Parameters
    ----------
    bandwidth
        rad/s; 0 for none, infinite for all frequencies.

    Returns
    -------
    str
    """
    if bandwidth == 0.0:
        return "none"
    if math.isinf(bandwidth):
        return "|E| stays below 0.707 at all frequencies"
    return f"{hertz(bandwidth)}, where |E| first is 0.707"
