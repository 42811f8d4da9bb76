"""Where an estimation may start, and from where it may go on."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_positive, given_or
from hyst.errors import InputError, NotInvertibleError
from hyst.online.joint.parts import Parts

Array = NDArray[np.float64]

LEAST_MAP_SLOPE, MOST_MAP_SLOPE = 1e-6, 1e6


def complete_scales(settings: dict[str, Any], theta: Array, plays: int) -> None:
    """Fill in the noise and the bounds that were left out, and check those that were not.

    Parameters
    ----------
    settings
        Of the joint estimator, changed in place.
    theta
        The parameters to start from, shape (m,).
    plays
        n.

    Raises
    ------
    InputError
        If a number is out of range, or all weights are 0 and a bound was left out.
    """
    p, r = theta[: plays + 1], theta[plays + 1 : 2 * plays + 1]
    total = float(np.abs(p).sum())
    loop = float(np.abs(p[1:]) @ r)
    left_out = [each for each in ("least_slope", "most_slope") if settings[each] is None]
    if total == 0.0 and left_out:
        raise InputError(
            "every weight of the model is 0, which gives no scale; start from weights of "
            "the right size, such as those of identify_weights_from_slopes"
        )
    radius = float(r[-1]) if plays else 1.0
    for name, value, what in (
        ("noise", loop or total, "a standard deviation"),
        ("least_slope", 1e-6 * total, "a slope"),
        ("most_slope", 1e3 * total, "a slope"),
        ("most_radius", 1e3 * radius or 1.0, "a radius"),
    ):
        settings[name] = as_positive(given_or(settings[name], value), name, what)


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
    name = falling_map(parts, start)
    if name:
        raise InputError(
            f"the {name} map falls; the estimator keeps maps rising, so turn its weights round and "
            "give the sign to a gain"
        )
    return start


def falling_map(parts: Parts, theta: Array) -> str:
    """Name the map that has a slope outside its bounds.

    Parameters
    ----------
    parts
        The model.
    theta
        The parameters, shape (m,).

    Returns
    -------
    str
        ``front`` or ``back``; empty if neither has.
    """
    first = 2 * parts.pi.p.size + 2
    for name, each in (("front", parts.front), ("back", parts.back)):
        if each is None:
            continue
        weights = theta[first : first + each.weights.size]
        first += weights.size
        rising = weights[0] + np.cumsum(np.where(each.thresholds > 0.0, weights, 0.0))
        falling = weights[0] + np.cumsum(np.where(each.thresholds < 0.0, weights, 0.0))
        slopes = np.concatenate([rising, falling])
        rounding = 1e-12 * float(np.abs(weights).sum())
        if slopes.min() < LEAST_MAP_SLOPE - rounding or slopes.max() > MOST_MAP_SLOPE + rounding:
            return name
    return ""
