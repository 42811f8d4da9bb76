"""A model's output as late as it is measured."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_vector
from hyst.identification.record_use.part_of_a_sample import by_whole_samples, later
from hyst.operators import Operator

Array = NDArray[np.float64]


def late_output(model: Operator, u: ArrayLike, delay: float) -> Array:
    """Give a model's output as it comes ``delay`` samples later, held where there is none.

    Parameters
    ----------
    model
        Any operator.
    u
        Shape (N,), input units.
    delay
        Samples; whole ones shift the output, the part beyond them shifts the input, so that the
        corners of loops stay corners. Negative where the output is ahead of the input.

    Returns
    -------
    numpy.ndarray
        Shape (N,). What no sample of the input tells repeats the first or the last output.

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
    keeps_corners = bool(model.traits().rate_independent)
    moved = later(finite_vector(u, "u"), delay - whole, keeps_corners)
    return by_whole_samples(model(moved), whole)
