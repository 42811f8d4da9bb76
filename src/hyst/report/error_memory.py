"""How long an error remembers itself."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def autocorrelation(error: Array, lags: int) -> Array:
    """Correlation of a signal with itself, for lags 0 to ``lags``.

    Parameters
    ----------
    error
        Shape (N,).
    lags
        Below N.

    Returns
    -------
    numpy.ndarray
        Shape (lags + 1,), 1 at lag 0; zeros if the signal does not move.

    Examples
    --------
    >>> autocorrelation(np.array([1.0, -1.0, 1.0, -1.0]), 2)
    array([ 1.  , -0.75,  0.5 ])
    """
    centred = error - error.mean()
    length = 1 << (error.size + lags).bit_length()
    power = np.abs(np.fft.rfft(centred, length)) ** 2
    correlation: Array = np.fft.irfft(power, length)[: lags + 1]
    energy = float(np.dot(centred, centred))
    return correlation / energy if energy > 0.0 else np.zeros(lags + 1)
