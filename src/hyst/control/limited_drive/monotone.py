"""Whether a model answers every drive within limits with an output of its own."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.control.drive_limits import Limits
from hyst.errors import InputError, NotInvertibleError
from hyst.operators import Operator

Array = NDArray[np.float64]

_DRIVES = 257
# Of the largest output: what rounding may take from a curve that rises.
_ROUNDING = 1e-9


def require_monotone(forward: Operator, limits: Limits) -> None:
    """Refuse limits within which a branch turns back.

    The drives of one sample are swept from end to end, each time with the memory of another
    history: at rest, at either end, there and back again, and in the middle from either side.

    Parameters
    ----------
    forward
        From the drive to the output.
    limits
        As checked.

    Raises
    ------
    NotInvertibleError
        If the output turns back within the limits; the drives are named.
    InputError
        If a drive within the limits has no output.
    """
    low, high = limits
    middle = low + 0.5 * (high - low)
    u = np.linspace(low, high, _DRIVES)
    before: tuple[list[float], ...] = (
        [],
        [low],
        [high],
        [low, high],
        [high, low],
        [low, high, middle],
        [high, low, middle],
    )
    curves = np.array([_branch(forward, u, history, limits) for history in before])
    rises = np.sign(curves[:, -1] - curves[:, 0])
    lost = _ROUNDING * np.abs(curves).max()
    back = np.diff(curves, axis=1) * rises[:, None] < -lost
    if back.any() or (rises != rises[0]).any():
        row, place = np.argwhere(back)[0] if back.any() else (int(np.argmax(rises != rises[0])), 0)
        told = " to ".join(f"{each:.6g}" for each in before[row]) or "rest"
        raise NotInvertibleError(
            f"within the limits {low:.6g} to {high:.6g} the output turns back between the drives "
            f"{u[place]:.6g} and {u[place + 1]:.6g} (after {told}), so that no one drive belongs "
            "to it; give limits on one side of there"
        )


def _branch(forward: Operator, u: Array, history: list[float], limits: Limits) -> Array:
    try:
        state = forward.run(history)[1] if history else forward.initial_state()
        memory = np.tile(state, (u.size, 1))
        return np.asarray(forward.run(u[:, None], memory)[0][:, 0])
    except InputError as refused:
        raise InputError(
            f"the model does not answer all drives within {limits[0]:.6g} to {limits[1]:.6g} "
            f"({refused}); give limits within which it does"
        ) from refused
