"""The joint estimator of the core, made from settings."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.online.joint.cells import Cells, cells_for
from hyst.online.joint.parts import Map, Parts
from hyst.online.joint.prior import start_covariance
from hyst.online.joint.start import LEAST_MAP_SLOPE, MOST_MAP_SLOPE

Array = NDArray[np.float64]

GROUPS = ("p0", "p", "r", "offset", "front", "back")
_LINEAR_TERMS = ("front[1]", "back[1]")
_NOISE_SAMPLES = 150.0
_LEAST_SHARE = 1e-14
# Over the largest radius of the start: what tells inputs apart, and what is too coarse to fold.
_FINEST, _COARSEST, _MOST_ROWS = 2.0**-30, 2.0**-5, 2048.0
_FOR_EVER = 1e300


def prior_of(parts: Parts, theta: Array, settings: dict[str, Any]) -> Array:
    """Give the covariance of a start.

    Parameters
    ----------
    parts
        The model.
    theta
        The parameters to start from, shape (m,).
    settings
        Of the estimator: spreads, noise, and what is held.

    Returns
    -------
    numpy.ndarray
        Shape (m, m), zero where held.
    """
    maps = () if settings["estimate_maps"] else ("front", "back")
    held = {*settings["held"], *maps, *_LINEAR_TERMS}
    is_free = [name not in held and name.partition("[")[0] not in held for name in parts.names()]
    spreads = settings["radius_spread"], settings["weight_spread"], settings["noise"]
    return start_covariance(theta, parts.pi.p.size, *spreads, np.array(is_free))


def search_cells(
    parts: Parts, theta: Array, limit: Array, settings: dict[str, Any]
) -> Cells | None:
    """Give the cells a search needs, or None where there is none.

    Parameters
    ----------
    parts, theta, settings
        As for ``prior_of``.
    limit
        Shape (m,), variances of the start.

    Returns
    -------
    Cells or None
    """
    n = parts.pi.p.size
    if not settings["search"] or (limit[: 2 * n + 1] == 0.0).any():
        return None
    return cells_for(theta, n, float(limit[2 * n + 1]), least_noise(settings))


def new_core(
    parts: Parts, limit: Array, cells: Cells | None, settings: dict[str, Any]
) -> _engine.JointEstimation:
    """Make the estimator of the core.

    Parameters
    ----------
    parts, settings
        As for ``prior_of``.
    limit
        Shape (m,), variances that are never exceeded.
    cells
        Of the search, if there is one.

    Returns
    -------
    JointEstimation
    """
    maps = _thresholds(parts.front), _thresholds(parts.back)
    core = _engine.JointEstimation(
        parts.pi.p.size, limit.tolist(), *maps, LEAST_MAP_SLOPE, MOST_MAP_SLOPE
    )
    core.set_bounds(settings["least_slope"], settings["most_slope"], settings["most_radius"])
    dt, memory = settings["dt"], settings["memory"]
    forgetting = 0.0 if memory is None else min(dt / memory, 0.5)
    patience = round(settings["patience"] / dt)
    core.set_memory(forgetting, _NOISE_SAMPLES, least_noise(settings), _LEAST_SHARE, patience)
    if cells is not None:
        cells.hand_to(core)
    n = parts.pi.p.size
    radius = max(float(parts.pi.r[-1]) if n else 1.0, 1e-300)
    page = _FOR_EVER if memory is None else memory / dt
    core.set_folding(_FINEST * radius, _COARSEST * radius, _MOST_ROWS, page)
    return core


def least_noise(settings: dict[str, Any]) -> float:
    """Give the least variance the noise is taken for."""
    return float((1e-10 * settings["noise"]) ** 2)


def _thresholds(each: Map | None) -> list[float]:
    return [] if each is None else each.thresholds.tolist()
