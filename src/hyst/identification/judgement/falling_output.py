"""How much of its way the output runs against its own main direction: butterflies and squares."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.judgement.remainder import Part, Remainder

Array = NDArray[np.float64]

BINS = 20
"""Into which the input's range is divided: a mean over each hides the noise."""

BY_THE_BRANCH = 0.5
"""Share of the output's variance that the mean loop must explain, or there is no loop to judge."""


def falling_share(remainder: Remainder) -> float:
    """Give the share of the output's way, up and down, that runs against the main direction.

    Parameters
    ----------
    remainder
        What a fit leaves.

    Returns
    -------
    float
        0 where the output only rises with the input, or only falls, or does neither by a loop; 0.5
        where it does both alike.
    """
    branches = [_branch(part, remainder, way) for part in remainder.parts for way in (1.0, -1.0)]
    explained = sum(each[1] for each in branches)
    y = remainder.y - remainder.y.mean()
    if explained < BY_THE_BRANCH * float(y @ y):
        return 0.0
    steps = np.concatenate([each[0] for each in branches])
    up, down = float(steps[steps > 0.0].sum()), float(-steps[steps < 0.0].sum())
    return min(up, down) / (up + down) if up + down > 0.0 else 0.0


def follows_the_speed(remainder: Remainder) -> bool:
    """Tell whether the output goes with the change of the input more than with the input.

    Parameters
    ----------
    remainder
        What a fit leaves.
    """
    y = remainder.y - remainder.y.mean()
    speed = np.concatenate([_speed(each) for each in remainder.parts])
    u, speed = remainder.u - remainder.u.mean(), speed - speed.mean()
    by_input, by_speed = (
        float(each @ y) ** 2 / max(float(each @ each), np.finfo(float).tiny) for each in (u, speed)
    )
    return by_speed > max(BY_THE_BRANCH * float(y @ y), by_input)


def _speed(part: Part) -> Array:
    return np.asarray(np.gradient(part.u) / part.dt) if part.u.size > 2 else 0.0 * part.u


def _branch(part: Part, remainder: Remainder, way: float) -> tuple[Array, float]:
    """Give the steps of the mean output along one direction of the input, and what it explains."""
    if part.u.size < 3:
        return np.empty(0), 0.0
    here = np.sign(np.gradient(part.u)) == way
    low = float(remainder.u.min())
    place = ((part.u[here] - low) / remainder.input_range * BINS).astype(np.intp)
    place = np.minimum(place, BINS - 1)
    count = np.bincount(place, minlength=BINS)
    seen = count > 0
    mean = np.bincount(place, part.y[here], minlength=BINS)[seen] / count[seen]
    explained = float(np.sum(count[seen] * (mean - remainder.y.mean()) ** 2))
    return np.diff(mean), explained
