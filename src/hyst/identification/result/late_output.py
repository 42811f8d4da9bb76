"""The output of a model as it is measured: later by the delay."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_vector
from hyst.identification.record_use.part_of_a_sample import later
from hyst.operators import Operator

Array = NDArray[np.float64]


def late_output(model: Operator, u: ArrayLike, delay: float) -> Array:
    """Give a model's output as it comes ``delay`` samples later.

    Parameters
    ----------
    model
        Any operator.
    u
        Shape (N,), finite, input units.
    delay
        Samples; whole ones shift the output, the part beyond them shifts the input, so that the
        corners of loops stay corners. Negative where the output is ahead of the input.

    Returns
    -------
    numpy.ndarray
        Shape (N,). The first samples repeat the first output; where the output is ahead, the last
        ones repeat the last.

    Raises
    ------
    InputError
        If the input is no finite vector, or the model refuses it.

    Examples
    --------
    >>> from hyst.operators import Affine
    >>> late_output(Affine(2.0), [0.0, 1.0, 2.0, 3.0], 1)
    array([0., 0., 2., 4.])
    """
    whole = math.floor(delay)
    y = model(later(finite_vector(u, "u"), delay - whole))
    if whole == 0:
        return y
    return np.asarray(y[np.clip(np.arange(y.size) - whole, 0, y.size - 1)])
