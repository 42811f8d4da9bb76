"""Combinations of a model's constants that leave its output alone whatever the drive.

A map behind plays and the plays' weights share a factor; a play of radius 0 is the input itself. No
drive can tell such constants apart, so none is to blame for it. They are found with a rich drive of
three times the amplitude beside the one in question.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.errors import HystError
from hyst.identification.forecast.free_numbers import FreeNumbers
from hyst.signals import multisine

Array = NDArray[np.float64]

_LARGER = (3.0, 1.0)  # times the amplitude; the first that the model stands
_SAMPLES = 4000
_ROUNDING = 1e-9


def shared_directions(free: FreeNumbers, u: Array, jacobian: Array) -> Array:
    """Give directions of the free numbers that no drive shows.

    Parameters
    ----------
    free
        The model's numbers.
    u
        Shape (N,), the drive.
    jacobian
        Shape (N, m), for it.

    Returns
    -------
    numpy.ndarray
        Shape (m, k), orthonormal, of numbers scaled by what they do to the output; constants that
        nothing moves are none of them, for a larger drive may move those.
    """
    columns = np.concatenate([jacobian, _for_a_rich_drive(free, u)])
    scale = np.linalg.norm(columns, axis=0)
    moving = np.flatnonzero(scale > 0.0)
    held = free.held[:, moving] / scale[moving]
    within = scipy.linalg.null_space(held) if held.size else np.eye(moving.size)
    _, values, directions = np.linalg.svd(
        columns[:, moving] / scale[moving] @ within, full_matrices=False
    )
    unseen = np.zeros((scale.size, directions.shape[0]))
    unseen[moving] = within @ directions.T
    unseen = unseen[:, values <= _ROUNDING * values.max(initial=0.0)]
    # What does not move here is told to be open, and whatever it is the rest stays shared.
    unseen[~jacobian.any(axis=0)] = 0.0
    basis, sizes, _ = np.linalg.svd(unseen, full_matrices=False)
    return np.asarray(basis[:, sizes > _ROUNDING])


def places_to_hold(shared: Array) -> NDArray[np.intp]:
    """Give one number for each shared direction which, held, leaves nothing of it.

    Parameters
    ----------
    shared
        Shape (m, k), as ``shared_directions`` gives them.
    """
    if shared.shape[1] == 0:
        return np.empty(0, dtype=np.intp)
    order = scipy.linalg.qr(shared.T, mode="r", pivoting=True)[1]
    return np.sort(order[: shared.shape[1]]).astype(np.intp)


def _for_a_rich_drive(free: FreeNumbers, u: Array) -> Array:
    middle, largest = float(u.mean()), float(np.abs(u - u.mean()).max())
    for factor in _LARGER:
        rich = multisine(
            1.0, _SAMPLES, amplitude=factor * largest, offset=middle, uniform=True, seed=1
        )
        try:
            slopes = free.model.jacobian(rich.u) @ free.directions
        except HystError:  # beyond what the model's constants stand
            continue
        if np.isfinite(slopes).all():
            return np.asarray(slopes)
    return np.zeros((0, free.directions.shape[1]))
