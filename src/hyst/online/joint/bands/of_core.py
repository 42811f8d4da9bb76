"""Least squares over what an engine has folded, and its state taken to them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.online.joint.bands.found import Found, found_in
from hyst.online.joint.bands.intervals import covariance_of_minimum
from hyst.online.joint.bands.samples import folded_samples
from hyst.online.joint.joint_core import least_noise
from hyst.online.joint.parts import Parts
from hyst.online.joint.prior import factors

Array = NDArray[np.float64]

_NOISE = 2


def found_of(
    core: _engine.JointEstimation, parts: Parts, theta: Array, settings: dict[str, Any]
) -> Found | None:
    """Fit a model to what an engine has folded, from an estimate and other starts.

    Parameters
    ----------
    core
        The engine.
    parts
        The model.
    theta
        Shape (m,), the estimate.
    settings
        Of the estimator: bounds and noise.

    Returns
    -------
    Found or None
        None where too little is folded.
    """
    samples = folded_samples(core.folded(2))
    pages = tuple(folded_samples(core.folded(page)) for page in (0, 1))
    bounds = (settings["least_slope"], settings["most_slope"], settings["most_radius"])
    limit = np.array(core.constants()["limit"])
    return found_in(parts, samples, pages, theta, limit, bounds, least_noise(settings))


def take_over(core: _engine.JointEstimation, state: Array, found: Found, start: Array) -> bool:
    """Take the estimate to the minimum nearest to the start, if the chi-square falls by 1.

    Parameters
    ----------
    core, state
        The engine and its state, which is changed.
    found
        What least squares over all samples have found.
    start
        Shape (m,), the parameters at the start.

    Returns
    -------
    bool
        Whether the estimate was replaced.
    """
    at = core.places()
    best = found.nearest_to(start)
    error, _ = found.problem.residual(state[at["theta"] : at["d"]])
    if not float(error @ error) > best.chi_square + 1.0:
        return False
    state[at["theta"] : at["d"]] = best.theta
    covariance = covariance_of_minimum(found.problem, best, spreads=1.0)
    state[at["d"] : at["u"]], state[at["u"] : at["z"]] = factors(covariance)
    state[_NOISE] = found.problem.noise
    core.replaced(state)
    return True


def clear_scratch(state: Array, at: Mapping[str, int]) -> None:
    """Clear NaN that a refused sample leaves in scratch areas, which are written before read.

    Parameters
    ----------
    state
        Of the engine; changed.
    at
        Places in it.
    """
    for first, last in (
        (at["psi"], at["scalars"]),
        (at["rival"] + at["psi"], at["cells"]),
        (at["points"], at["length"]),
    ):
        scratch = state[first:last]
        scratch[~np.isfinite(scratch)] = 0.0
