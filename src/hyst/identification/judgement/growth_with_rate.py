"""Whether the error of records grows with the rate at which they were run."""

from __future__ import annotations

import itertools
import math

import numpy as np
import scipy.special

from hyst.identification.judgement.drive_cycles import frequency_of
from hyst.identification.judgement.regression import correlation_time
from hyst.identification.judgement.remainder import Remainder

FASTER = 1.4
"""Times the frequency of the slowest record, from which rates are different ones."""

LARGER = 1.5
"""Times the error of the slowest record, from which it is told."""

UNLIKELY = 1e-5
"""Probability that equal errors differ so much."""


def growth_with_rate(remainder: Remainder) -> str:
    """Say how the error grows from the slowest to the fastest record; nothing if it does not.

    Parameters
    ----------
    remainder
        What a fit leaves.
    """
    parts = sorted(remainder.parts, key=frequency_of)
    slow, fast = frequency_of(parts[0]), frequency_of(parts[-1])
    if fast < FASTER * slow:
        return ""
    errors = [each.error - each.error.mean() for each in parts]
    rms = [float(np.sqrt(np.mean(each**2))) for each in errors]
    if any(two < one for one, two in itertools.pairwise(rms)):
        return ""
    if rms[-1] < LARGER * rms[0]:
        return ""
    free = [max(each.size / correlation_time(each), 2.0) for each in (errors[-1], errors[0])]
    ratio = (rms[-1] / rms[0]) ** 2 if rms[0] > 0.0 else math.inf
    if float(scipy.special.fdtrc(*free, ratio)) > UNLIKELY:
        return ""
    return (
        f"The error grows with the rate, from {remainder.plain(rms[0])} rms at {slow:.3g} Hz to "
        f"{remainder.plain(rms[-1])} at {fast:.3g} Hz: the loop depends on it."
    )
