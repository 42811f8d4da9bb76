"""Single samples far from their neighbours in what a fit leaves."""

from __future__ import annotations

import numpy as np
import scipy.ndimage
from numpy.typing import NDArray

from hyst.identification.judgement.remainder import Remainder

Array = NDArray[np.float64]

FAR = 8.0
"""Standard deviations of the differences from neighbours, by their median."""

NEAREST = 2e-3
"""Of the output's range: nearer samples are no outliers, however quiet the record."""

MOST = 0.01
"""Of all samples: more are no outliers but something else."""


def outliers_of(remainder: Remainder) -> NDArray[np.bool_]:
    """Tell which samples are outliers, shape (samples,).

    Parameters
    ----------
    remainder
        What a fit leaves.
    """
    far = np.concatenate([_apart(each.error) for each in remainder.parts])
    noise = 1.4826 * float(np.median(far))
    outside = far > max(FAR * noise, NEAREST * remainder.output_range)
    return outside if outside.mean() <= MOST else np.zeros(far.size, dtype=bool)


def _apart(error: Array) -> Array:
    """Give how far every sample is from the median of five around it."""
    if error.size < 5:
        return np.zeros(error.size)
    return np.asarray(np.abs(error - scipy.ndimage.median_filter(error, 5, mode="nearest")))
