"""Stable eigenvalues in the internal model: an observer of higher order than the paper's.

They model no disturbance that lasts, so nothing is asked of Q there; each gives ``1 - Q`` a zero
that is free and Q one power of s more above. Where an eigenvalue and a pole of Q coincide they
cancel, so that every gain of lower order is one of the higher too, and the descent starts there.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.control.disturbance_observer.minimax import Descent
from hyst.control.disturbance_observer.stacked_gain import StackedGain
from hyst.control.disturbance_observer.within_limit import least_within

Array = NDArray[np.float64]

_STARTS = 8  # eigenvalues tried, over the band of the problem and a little beyond
_MORE = 1e-3  # of the noise gain, which has a least value that a limit must leave room for


def with_one_more(gain: StackedGain, found: Descent, noise: float) -> tuple[StackedGain, Descent]:
    """Add a stable eigenvalue, and give the gain of least norm at no more noise.

    Parameters
    ----------
    gain
        The stacked gain that was minimized.
    found
        Its minimum.
    noise
        Limit of sup |Q / Pn|, to 0.1 %.
    """
    larger = gain.enlarged()
    poles, free = gain.poles(found.parameters), gain.eigenvalues(found.parameters)
    ends: list[Descent] = []
    for rate in np.geomspace(*gain.rates(), _STARTS):
        start = larger.parameters_of(np.append(poles, -rate), np.append(free, -rate))
        # As it starts it is as good as it was.
        ends.append(Descent(start, found.norm, 0))
        ends.append(least_within(larger, larger.noise, (1.0 + _MORE) * noise, start))
    best = min(ends, key=lambda each: each.norm)
    evaluations = sum(each.evaluations for each in ends)
    return larger, Descent(best.parameters, best.norm, evaluations)
