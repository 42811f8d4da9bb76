"""Where a joint estimation may start."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError, NotInvertibleError
from hyst.online.parts import Parts

Array = NDArray[np.float64]


def checked_start(parts: Parts, theta: Array, settings: dict[str, Any]) -> Array:
    """Give the parameters to start from, with p0 raised to its bound where it is below.

    Parameters
    ----------
    parts
        The model.
    theta
        Its parameters, shape (m,).
    settings
        Of the estimator: the bounds, and what is held.

    Returns
    -------
    numpy.ndarray
        Shape (m,).

    Raises
    ------
    InputError
        If the bounds contradict each other or the start.
    NotInvertibleError
        If the start cannot be inverted.
    """
    least, most, radius = (settings[each] for each in ("least_slope", "most_slope", "most_radius"))
    n = parts.pi.p.size
    if not least < most:
        raise InputError(
            f"least_slope is {least:.6g} and most_slope {most:.6g}; give the smaller one first"
        )
    if n and radius < theta[2 * n]:
        raise InputError(
            f"most_radius is {radius:.6g}, but the model starts with r[{n}] = {theta[2 * n]:.6g}; "
            "raise the bound or start below it"
        )
    if "p0" in settings["held"] and theta[0] < least:
        raise InputError(
            f"p0 is held at {theta[0]:.6g}, below least_slope = {least:.6g}; such a model has no "
            "inverse, so let p0 be estimated or raise it"
        )
    start = theta.copy()
    start[0] = max(start[0], least)
    slopes = np.cumsum(start[: n + 1])
    # An estimate on its bounds may come back: its sums are exact to rounding only.
    rounding = 4.0 * (n + 1) * float(np.finfo(np.float64).eps * np.abs(start[: n + 1]).sum())
    if slopes.min() < least - rounding or slopes.max() > most + rounding:
        raise InputError(
            f"the cumulative weights go from {slopes.min():.6g} to {slopes.max():.6g}, outside "
            f"{least:.6g} to {most:.6g}; widen the bounds or start within them"
        )
    try:
        parts.assemble(start, parts.pi.z0).inverse()
    except NotInvertibleError as error:
        raise NotInvertibleError(f"the estimation cannot start: {error}") from None
    return start
