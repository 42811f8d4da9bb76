"""Preisach models as others would write them: relay by relay, and hysteron by hysteron."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def relays_of_cells(weights: Array, edges: Array, side: int) -> tuple[Array, Array, Array]:
    """Give alpha, beta and mass of side x side relays in the middle of parts of every cell.

    On the diagonal only the triangle has relays; those on its edge have half the mass.
    """
    middle = (np.arange(side) + 0.5) / side
    found: list[tuple[Array, Array, Array]] = []
    for i in range(weights.shape[0]):
        for j in range(i + 1):
            alpha = np.repeat(edges[i] + middle * (edges[i + 1] - edges[i]), side)
            beta = np.tile(edges[j] + middle * (edges[j + 1] - edges[j]), side)
            share = np.ones(side * side)
            if i == j:
                share = 1.0 + np.sign(np.repeat(middle, side) - np.tile(middle, side))
            found.append((alpha, beta, weights[i, j] * share / side**2))
    alpha, beta, mass = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return alpha, beta, mass


def relay_grid(
    u: Array, weights: Array, edges: Array, p0: float, side: int, u0: float = 0.0
) -> Array:
    """Give the output of a plain grid of relays that starts demagnetised and is brought to u0."""
    alpha, beta, mass = relays_of_cells(weights, edges, side)
    state = -np.sign(alpha + beta)
    y = np.empty(u.size)
    for k, value in enumerate(np.append(u0, u)):
        state = np.where(value >= alpha, 1.0, np.where(value <= beta, -1.0, state))
        if k:
            y[k - 1] = p0 * value + mass @ state
    return y


def ridge(distance: Array, width: Array) -> Array:
    """Give -1 before 0, 1 beyond the width, and the straight line in between."""
    return np.asarray(np.clip(2.0 * distance / width - 1.0, -1.0, 1.0))


def kp_hysterons(u: Array, weights: Array, edges: Array, p0: float) -> Array:
    """Give the sum of Krasnoselskii-Pokrovskii hysterons, brought to rest with the relays.

    Rising, a hysteron is at least on its upper ridge; falling, at most on its lower one.
    """
    i, j = np.tril_indices(weights.shape[0])
    widths = np.diff(edges)
    # Where alpha + beta = 0 on the ridge: relays before it are up.
    start = np.clip(-(edges[i] + edges[j]) / (widths[i] + widths[j]), 0.0, 1.0)
    k = 2.0 * start - 1.0
    y = np.empty(u.size)
    for n, value in enumerate(u):
        k = np.maximum(k, ridge(value - edges[i], widths[i]))
        k = np.minimum(k, ridge(value - edges[j], widths[j]))
        y[n] = p0 * value + weights[i, j] @ k
    return y
