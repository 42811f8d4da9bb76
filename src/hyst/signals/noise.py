"""How noisy a signal is, and the dead band that hides its noise."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from hyst.checks.arrays import finite_vector

# Median of |x| for x normal with unit variance.
_NORMAL_MEDIAN = 0.6744897501960817


def estimate_noise(u: ArrayLike) -> float:
    """Estimate the standard deviation of white noise on a smooth signal.

        sigma = median |u[k-1] - 2 u[k] + u[k+1]| / (0.6745 sqrt(6))

    The second difference removes whatever is locally straight; of white noise it leaves
    variance 6 sigma^2. The median keeps corners and outliers from counting. A smooth signal
    with fewer than about 50 samples a period adds its own curvature, so the estimate is then
    too large; a quantised signal that mostly holds its level gives 0.

    Parameters
    ----------
    u
        Signal, shape (N,), finite, evenly sampled.

    Returns
    -------
    float
        Standard deviation in units of ``u``, >= 0; 0 for fewer than 3 samples.

    Raises
    ------
    InputError
        If ``u`` is not a finite vector.

    Examples
    --------
    >>> estimate_noise([0.0, 1.0, 2.0, 3.0, 2.0, 1.0])
    0.0
    """
    signal = finite_vector(u, "u")
    if signal.size < 3:
        return 0.0
    # Quarters cannot overflow in a second difference, and dividing by four does not round.
    curvature = np.diff(signal / 4.0, n=2)
    return 4.0 * float(np.median(np.abs(curvature))) / (_NORMAL_MEDIAN * math.sqrt(6.0))


def suggest_dead_band(u: ArrayLike) -> float:
    """Propose the dead band with which ``reversals`` overlooks the noise of a signal.

        D = min(max(2 sigma sqrt(2 ln N), 2.5 q), range / 4)

    sigma is ``estimate_noise(u)``; 2 sigma sqrt(2 ln N) is the width of the band that N samples
    of white noise hardly ever leave. q is the smallest step between two values of ``u``: a
    signal from a converter toggles between neighbouring levels. A quarter of the range bounds
    it, for signals with so few levels or samples that noise cannot be told from motion.

    Parameters
    ----------
    u
        Signal, shape (N,), finite, evenly sampled.

    Returns
    -------
    float
        Dead band in units of ``u``, >= 0; 0 for a constant signal.

    Raises
    ------
    InputError
        If ``u`` is not a finite vector.

    Source
    ------
    The factor sqrt(2 ln N) is the universal threshold of Donoho and Johnstone, Biometrika 81
    (1994) 425-455, theorem 1.

    Examples
    --------
    >>> suggest_dead_band([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 9.0, 8.0])
    2.5
    """
    signal = finite_vector(u, "u")
    quarters = np.unique(signal / 4.0)
    if quarters.size == 1:
        return 0.0
    step = 4.0 * float(np.min(np.diff(quarters)))
    quarter_range = float(quarters[-1] - quarters[0])
    noise = 2.0 * math.sqrt(2.0 * math.log(signal.size)) * estimate_noise(signal)
    return min(max(noise, 2.5 * step), quarter_range)
