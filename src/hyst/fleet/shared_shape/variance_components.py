"""How far devices scatter, along given directions, by restricted maximum likelihood.

    z_d ~ N(mean, sum_k v_k a_k a_k'),    v_k >= 0

A direction along which nothing scatters gets a v_k that goes to 0: then devices share what moves
along it. No v_k is set by hand.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from hyst.fleet.shared_shape.device_equations import Equations

Array = NDArray[np.float64]

SETTLED = 1e-2
"""Relative change of what a component moves, at which iteration ends."""

NOT_SEEN = 0.02
"""Output variance that a component moves in all devices together, over that of their estimates:
below it is 0."""

BY_CHANCE = 2.71
"""Twice the logarithm of the likelihood that a variance must be worth."""

MEAN_WITHIN = 0.3
"""Share of a constant within which the mean is looked for at once: what no device determines does
not run away."""


@dataclass(frozen=True, eq=False)
class Scatter:
    """Normal distribution of devices around their mean.

    Parameters
    ----------
    directions
        Shape (q, k).
    variances
        Shape (k,).
    mean
        Shape (q,), restricted estimate of the mean, from where the equations count.
    mean_covariance
        Shape (q, q), how sure it is.
    likelihood
        Logarithm of the restricted likelihood, but for a constant.
    """

    directions: Array
    variances: Array
    mean: Array
    mean_covariance: Array
    likelihood: float

    @property
    def covariance(self) -> Array:
        """Shape (q, q)."""
        return np.asarray((self.directions * self.variances) @ self.directions.T)


@dataclass(frozen=True, eq=False)
class _Devices:
    """What devices say, over their noise: normal matrices (d, q, q), right sides, weights."""

    normal: Array
    moment: Array
    squares: Array
    weights: Array

    @classmethod
    def of(cls, equations: Equations, variance: Array, weights: Array) -> Self:
        rows, along = equations.rows, equations.along
        normal = rows.transpose(0, 2, 1) @ rows / variance[:, None, None]
        moment = np.einsum("dij,di->dj", rows, along) / variance[:, None]
        return cls(normal, moment, np.einsum("di,di->d", along, along) / variance, weights)


@dataclass(frozen=True, eq=False)
class _Marginal:
    """Information on the mean once the devices' own z are integrated out.

    ``through`` (d, q, k) is the information of each device times the directions, ``left`` (d, k)
    what it pulls along them beside the mean.
    """

    through: Array
    left: Array
    mean: Array
    covariance: Array
    likelihood: float


def estimate_scatter(
    equations: Equations, variance: Array, weights: Array, scatter: Scatter, most: int
) -> Scatter:
    """Improve variances until they settle.

    Parameters
    ----------
    equations
        Of the devices.
    variance
        Shape (devices,), of their noise.
    weights
        Shape (devices,), how much each counts.
    scatter
        Where to start.
    most
        Steps at most.

    Notes
    -----
    Each variance times its quadratic form over its trace, the fixed point of the restricted
    likelihood: H. D. Patterson, R. Thompson, Biometrika 58 (1971), 545-554; D. A. Harville, J. Am.
    Stat. Assoc. 72 (1977), 320-338.
    """
    devices = _Devices.of(equations, variance, weights)
    variances = scatter.variances.copy()
    for _ in range(most):
        active = np.flatnonzero(variances > 0.0)
        if active.size == 0:
            break
        directions, own = scatter.directions[:, active], variances[active]
        ratios, moved = _ratios(_marginal(devices, directions, own), devices, directions, own)
        improved = np.where(moved * ratios < NOT_SEEN, 0.0, own * ratios)
        variances[active] = improved
        if (np.abs(improved - own) <= SETTLED * (improved + 0.01 * improved.max())).all():
            break
    return _told(devices, scatter, variances)


def shared_where_possible(
    equations: Equations, variance: Array, weights: Array, scatter: Scatter
) -> Scatter:
    """Let devices share what no scatter of theirs is shown in: variances that do not pay are 0.

    Parameters
    ----------
    equations, variance, weights
        As of ``estimate_scatter``.
    scatter
        As it gives it.

    Notes
    -----
    A variance that is 0 raises twice the logarithm of the likelihood by more than 2.71 in one of 20
    cases: S. G. Self, K.-Y. Liang, J. Am. Stat. Assoc. 82 (1987), 605-610.
    """
    devices = _Devices.of(equations, variance, weights)
    best = _told(devices, scatter, scatter.variances)
    size = best.variances * np.einsum(
        "ik,ij,jk->k", best.directions, devices.normal.sum(axis=0), best.directions
    )
    for at in np.argsort(size):
        if best.variances[at] == 0.0:
            continue
        without = best.variances.copy()
        without[at] = 0.0
        trial = _told(devices, scatter, without)
        if 2.0 * (best.likelihood - trial.likelihood) < BY_CHANCE:
            best = trial
    return best


def _told(devices: _Devices, scatter: Scatter, variances: Array) -> Scatter:
    active = np.flatnonzero(variances > 0.0)
    seen = _marginal(devices, scatter.directions[:, active], variances[active])
    return Scatter(scatter.directions, variances, seen.mean, seen.covariance, seen.likelihood)


def _marginal(devices: _Devices, directions: Array, variances: Array) -> _Marginal:
    across = devices.normal @ directions
    size = np.sqrt(variances)
    inner = np.eye(size.size) + size[:, None] * (directions.T @ across) * size
    pulls = devices.moment @ directions
    right = np.concatenate([across.transpose(0, 2, 1), pulls[:, :, None]], axis=2)
    solved = size[:, None] * np.linalg.solve(inner, size[:, None] * right)
    taken, drawn = solved[:, :, :-1], solved[:, :, -1]
    weights = devices.weights
    # H - H A (V^-1 + A'HA)^-1 A'H, summed and times the directions.
    total = np.einsum("d,dij->ij", weights, devices.normal)
    total -= np.einsum("dik,dkj->ij", weights[:, None, None] * across, taken, optimize=True)
    moment = weights @ devices.moment - np.einsum("d,dik,dk->i", weights, across, drawn)
    values, vectors = np.linalg.eigh(total)
    values = np.maximum(values, 0.0) + 1.0 / MEAN_WITHIN**2
    covariance = (vectors / values) @ vectors.T
    mean = covariance @ moment
    through = across - across @ (taken @ directions)
    left = pulls - np.einsum("dk,dkl->dl", drawn, directions.T @ across)
    left = left - np.einsum("dik,i->dk", through, mean)
    squares = devices.squares - np.einsum("dk,dk->d", pulls, drawn)
    logs = float(weights @ np.linalg.slogdet(inner)[1]) + float(np.log(values).sum())
    likelihood = -0.5 * (float(weights @ squares) - float(mean @ moment) + logs)
    return _Marginal(through, left, mean, covariance, likelihood)


def _ratios(
    seen: _Marginal, devices: _Devices, directions: Array, variances: Array
) -> tuple[Array, Array]:
    """Give quadratic form over trace for every direction, and what all devices see of it."""
    weights = devices.weights
    forms = weights @ seen.left**2
    traces = np.einsum("d,dik,ik->k", weights, seen.through, directions)
    spread = seen.covariance @ seen.through
    for_mean = np.einsum("d,dik,dik->k", weights**2, seen.through, spread)
    traces = np.maximum(traces - for_mean, 1e-300)
    return forms / traces, variances * traces
