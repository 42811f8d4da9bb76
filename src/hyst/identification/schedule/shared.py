"""Which free parameters move with a second signal, and what those that do not have in common.

Each value of the signal has its own estimate theta_v with covariance C_v. Parameters S that do not
move have one value mu, and the estimates miss it by

    sum_v (theta_vS - mu)' (C_v,SS)^-1 (theta_vS - mu),

which follows chi squared where they truly do not. S grows by the parameter that adds least, as long
as what it adds is no more than chance.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.special
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

CHANCE = 0.05
"""That any parameter of a model which does not move at all is taken to move."""

ROUNDING_OF_CORRELATION = 1e-9
"""Added to correlations of one, as of scales that are held, so that they have an inverse."""


@dataclass(frozen=True, eq=False)
class Estimate:
    """The free parameters at one value of the signal.

    Parameters
    ----------
    theta
        Shape (m,).
    covariance
        Shape (m, m); rows and columns of parameters on a bound are zero.
    inside
        Shape (m,), those that lie on no bound.
    """

    theta: Array
    covariance: Array
    inside: Mask

    def of(self, chosen: Mask) -> Array:
        """Give the covariance of some parameters, with an inverse."""
        part = self.covariance[np.ix_(chosen, chosen)]
        return part + ROUNDING_OF_CORRELATION * np.diag(np.diag(part))


@dataclass(frozen=True, eq=False)
class Sharing:
    """What is shared, and what follows for each value.

    Parameters
    ----------
    shared
        Shape (m,), the parameters that have one value.
    chance
        Shape (m,), how probable differences as large as these are where a parameter does not move,
        those before it shared; NaN where that cannot be asked.
    thetas, covariances
        Shapes (values, m) and (values, m, m), the estimates that agree in what is shared.
    gave_up
        Whether nothing is shared because constants then would stand in another order.
    """

    shared: Mask
    chance: Array
    thetas: Array
    covariances: Array
    gave_up: bool = False


def sharing_of(estimates: Sequence[Estimate], held: Mask | None = None) -> Sharing:
    """Find what does not move with the signal.

    Parameters
    ----------
    estimates
        At each value.
    held
        Shape (m,), what is shared without being asked; nothing if left out.

    Returns
    -------
    Sharing
    """
    thetas = np.array([each.theta for each in estimates])
    same = (thetas == thetas[0]).all(axis=0)
    free = np.logical_and.reduce([each.inside for each in estimates]) & ~same
    # A variance of zero says that nothing is known of it, or that all is.
    free &= np.all([np.diag(each.covariance) > 0.0 for each in estimates], axis=0)
    shared = np.zeros(free.size, dtype=np.bool_) if held is None else held & free
    chance = np.full(free.size, np.nan)
    missed = _missed(estimates, shared) if shared.any() else 0.0
    limit = CHANCE / max(int(free.sum()), 1)
    while (free & ~shared).any():
        trials = np.flatnonzero(free & ~shared)
        costs = [_missed(estimates, _with(shared, int(i))) for i in trials]
        best = int(np.argmin(costs))
        chance[trials] = scipy.special.chdtrc(
            len(estimates) - 1, np.maximum(np.array(costs) - missed, 0.0)
        )
        if chance[trials[best]] < limit:
            break
        shared[trials[best]] = True
        missed = costs[best]
    return _agreeing(estimates, shared, same, chance)


def nothing_shared(estimates: Sequence[Estimate], found: Sharing) -> Sharing:
    """Give the free estimates as they are.

    Parameters
    ----------
    estimates
        At each value.
    found
        What was found otherwise.
    """
    thetas = np.array([each.theta for each in estimates])
    covariances = np.array([each.covariance for each in estimates])
    same = (thetas == thetas[0]).all(axis=0)
    return Sharing(same, found.chance, thetas, covariances, gave_up=True)


def _with(shared: Mask, place: int) -> Mask:
    more = shared.copy()
    more[place] = True
    return more


def _common(estimates: Sequence[Estimate], shared: Mask) -> tuple[Array, Array]:
    """Give the common values of what is shared, and their covariance."""
    weights = [np.linalg.inv(each.of(shared)) for each in estimates]
    covariance = np.linalg.inv(sum(weights))
    moments = sum(w @ each.theta[shared] for w, each in zip(weights, estimates, strict=True))
    return covariance @ moments, covariance


def _missed(estimates: Sequence[Estimate], shared: Mask) -> float:
    mean, _ = _common(estimates, shared)
    total = 0.0
    for each in estimates:
        away = each.theta[shared] - mean
        total += float(away @ scipy.linalg.solve(each.of(shared), away, assume_a="pos"))
    return total


def _agreeing(estimates: Sequence[Estimate], shared: Mask, same: Mask, chance: Array) -> Sharing:
    thetas = np.array([each.theta for each in estimates])
    covariances = np.array([each.covariance for each in estimates])
    if shared.any():
        mean, spread = _common(estimates, shared)
        rest = ~shared
        for v, each in enumerate(estimates):
            follow = each.covariance[np.ix_(rest, shared)] @ np.linalg.inv(each.of(shared))
            thetas[v, rest] += follow @ (mean - each.theta[shared])
            thetas[v, shared] = mean
            own = covariances[v]
            own[np.ix_(rest, rest)] += follow @ (spread - each.of(shared)) @ follow.T
            own[np.ix_(rest, shared)] = follow @ spread
            own[np.ix_(shared, rest)] = (follow @ spread).T
            own[np.ix_(shared, shared)] = spread
    return Sharing(shared | same, chance, thetas, covariances)
