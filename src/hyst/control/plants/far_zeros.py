"""Zeros beyond what samples can show, as the dead time that they are."""

from __future__ import annotations

import numpy as np

from hyst.models import ContinuousDynamics
from hyst.models.realizations import companion


def without_far_zeros(plant: ContinuousDynamics, farthest: float) -> ContinuousDynamics:
    """Take zeros out of a continuous plant that lie far beyond the frequencies of interest.

    ``1 - s/a = exp(-s/a) (1 + O(s/a)^2)``: seen from far below, a zero is a dead time, negative of
    one in the left half plane.

    Parameters
    ----------
    plant
        With its zeros.
    farthest
        Modulus, rad/s, beyond which zeros become dead time.

    Returns
    -------
    ContinuousDynamics
        The same plant if it has none, or too little dead time for those of the left half plane.
    """
    zeros = plant.zeros()
    far = np.abs(zeros) > farthest
    delay = plant.delay + float(np.sum(1.0 / zeros[far]).real)
    if not far.any() or delay < 0.0:
        return plant
    gain = plant.num[0] * np.prod(-zeros[far]).real
    num = gain * np.atleast_1d(np.poly(zeros[~far])).real
    A, B, C, D = companion(num, plant.den)
    return ContinuousDynamics(A, B, C, D, delay, num, plant.den)
