"""Where an estimation may start, and from where it may go on."""

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


def check_saved(parts: Parts, theta: Array, settings: dict[str, Any]) -> None:
    """Refuse saved parameters that no joint estimator can have reached.

    Parameters
    ----------
    parts
        The model.
    theta
        The parameters, shape (m,).
    settings
        Of the estimator: the bounds.

    Raises
    ------
    InputError
        If radii are out of order or bounds, p0 or a sum of weights is not within the bounds of the
        slope, or a map cannot be inverted.
    """
    n = parts.pi.p.size
    check_saved_radii(theta[n + 1 : 2 * n + 1], settings["most_radius"])
    least, most = settings["least_slope"], settings["most_slope"]
    slopes, reach = np.cumsum(theta[: n + 1]), np.cumsum(np.abs(theta[: n + 1]))
    # Sums of an estimate on its bounds are exact to rounding only; p0 is exact.
    rounding = 4.0 * np.arange(n + 1) * np.finfo(np.float64).eps * reach
    bad = np.flatnonzero((slopes < least - rounding) | (slopes > most + rounding))
    if bad.size:
        k = int(bad[0])
        name = "p0" if k == 0 else f"the sum of weights up to p[{k}]"
        raise InputError(
            f"the saved estimate has {name} = {slopes[k]:.6g}, outside {least:.6g} to {most:.6g}, "
            "which no estimator reaches; save the estimator again"
        )
    try:
        parts.assemble(theta, parts.pi.z0).inverse()
    except (InputError, NotInvertibleError) as error:
        raise InputError(f"the saved estimate cannot be inverted: {error}") from None


def check_saved_radii(r: Array, most_radius: float) -> None:
    """Refuse saved radii that no estimator can have reached.

    Parameters
    ----------
    r
        Shape (n,), input units.
    most_radius
        Their bound, input units.

    Raises
    ------
    InputError
        If they do not ascend from 0 or more to ``most_radius`` or less.

    Examples
    --------
    >>> check_saved_radii(np.array([0.0, 1.0, 1.0]), 2.0)
    """
    steps = np.diff(np.concatenate([[0.0], r, [most_radius]]))
    if (steps < 0.0).any():
        k = int(np.argmax(steps < 0.0))
        below = "0" if k == 0 else f"r[{k}] = {r[k - 1]:.6g}"
        text = (
            f"r[{k + 1}] = {r[k]:.6g} below {below}"
            if k < r.size
            else f"{below} above most_radius = {most_radius:.6g}"
        )
        raise InputError(
            f"the saved estimate has {text}, which no estimator reaches; save the estimator again"
        )
