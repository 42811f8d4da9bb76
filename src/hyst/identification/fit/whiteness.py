"""Whether what a fit leaves is white: no part of it is like another."""

from __future__ import annotations

import numpy as np
import scipy.fft
import scipy.special
from numpy.typing import NDArray

Array = NDArray[np.float64]

LAGS, BY_CHANCE = 20, 5e-4
"""Autocorrelations that are looked at, and how often white noise fails."""

LONG = 4
"""As often again, of all lags up to this part of the errors: a miss may come again with the drive
and be like no error next to it."""


def is_white(errors: Array) -> bool:
    """Tell whether no error is like another, so that nothing is missing.

    Parameters
    ----------
    errors
        Shape (n,), one after the other in time; fewer than 80 are not white, unless all are 0.

    Notes
    -----
    Box and Pierce, J. Am. Stat. Assoc. 65 (1970), 1509-1526: n times the sum of squared
    autocorrelations is as the sum of as many squared normal numbers.
    """
    errors = errors - errors.mean()
    power, n = float(errors @ errors), errors.size
    if power <= np.finfo(np.float64).tiny or n < 4 * LAGS:
        return bool(power <= np.finfo(np.float64).tiny)
    most = n // LONG
    spectrum = np.abs(scipy.fft.rfft(errors, scipy.fft.next_fast_len(n + most, real=True))) ** 2
    alike = np.asarray(scipy.fft.irfft(spectrum))[1 : most + 1] / power
    # Over far lags fewer pairs are summed, and the sum of squares is smaller by as much.
    pairs = n - np.arange(1, most + 1)
    squares = np.square(alike) * n**2 / pairs
    return all(
        float(squares[:lags].sum()) < float(scipy.special.chdtri(lags, BY_CHANCE))
        for lags in (LAGS, most)
    )
