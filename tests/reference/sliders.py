"""Springs with a slider each, in parallel: Jenkins elements one by one, from their law alone."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def jenkins(stiffness: Array, ways: Array, u: Array) -> Array:
    """Each spring follows the input, and never stretches further than its way: the slider slips."""
    stretch, before, forces = np.zeros(ways.size), 0.0, []
    for value in u.tolist():
        stretch = np.clip(stretch + (value - before), -ways, ways)
        before = value
        forces.append(float(stiffness @ stretch))
    return np.array(forces)


def spread_by_a_power(
    count: int, force: float, stiffness: float, chi: float, beta: float
) -> tuple[Array, Array]:
    """Stiffness and way to slip of ``count`` elements that stand for Segalman's distribution.

    Its density of stiffness over ways, ``R phi^chi`` up to phi_max and the rest at phi_max, cut
    into parts of equal stiffness, each of them at the way at which its force is right: the mean.
    """
    limit = force * (1.0 + beta) / (stiffness * (beta + (chi + 1.0) / (chi + 2.0)))
    spread = stiffness / (1.0 + beta)
    share = np.linspace(0.0, 1.0, count + 1)
    edges = limit * share ** (1.0 / (chi + 1.0))
    # The integral of phi^(chi + 1) over that of phi^chi between two edges.
    moment = np.diff(edges ** (chi + 2.0)) / (chi + 2.0)
    mass = np.diff(edges ** (chi + 1.0)) / (chi + 1.0)
    ways = np.append(moment / mass, limit)
    return np.append(np.full(count, spread / count), beta * spread), ways


def spread_exponentially(count: int, force: float, way: float) -> tuple[Array, Array]:
    """Stiffness and way of elements whose stiffness falls off as exp(-phi / way); macro-slip at
    ``force``: parts of equal stiffness at their mean ways."""
    tail = 1.0 - np.arange(count + 1) / count  # exp(-phi / way) at the edges
    with np.errstate(divide="ignore", invalid="ignore"):
        # phi (1 + ..): the integral of phi exp(-phi / way) / way is -(phi + way) exp(-phi / way).
        phi = -way * np.log(tail)
        below = np.where(tail > 0.0, (phi + way) * tail, 0.0)
    ways = -np.diff(below) / -np.diff(tail)
    return np.full(count, force / way / count), ways
