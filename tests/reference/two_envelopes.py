"""Plays between two envelopes, from their equation and from nothing else, and asymmetric plants."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Envelope = Callable[[float], float]


def dead_zone(weights: Array, thresholds: Array) -> Envelope:
    """Give a sum of dead-zone functions as a function of one number."""

    def value(u: float) -> float:
        total = 0.0
        for w, rho in zip(weights, thresholds, strict=True):
            total += w * (max(u - rho, 0.0) if rho > 0.0 else min(u - rho, 0.0) if rho < 0 else u)
        return float(total)

    return value


def two_envelopes(p: Array, r: Array, up: Envelope, down: Envelope, p0: float, u: Array) -> Array:
    """z_i = max(up(u) - r_i, min(down(u) + r_i, z_i)); y = p0 (up + down) / 2 + sum p_i z_i."""
    z, y = np.zeros(len(r)), []
    for value in u.tolist():
        high, low = down(value) + np.asarray(r), up(value) - np.asarray(r)
        z = np.maximum(low, np.minimum(high, z))
        y.append(p0 * (up(value) + down(value)) / 2.0 + float(np.dot(p, z)))
    return np.array(y)


def saturating(u: Array) -> Array:
    """A loop between two hyperbolic tangents, as a shape-memory wire heated and cooled: asymmetric
    and saturated, and no piecewise linear envelope."""

    def up(value: float) -> float:
        return float(np.tanh(1.6 * value - 0.5) + np.tanh(0.5))

    def down(value: float) -> float:
        return float(np.tanh(1.1 * value + 0.2) - np.tanh(0.2))

    r = np.array([0.4, 0.5, 0.65])
    return two_envelopes(np.array([0.5, 0.3, 0.2]), r, up, down, 0.3, u)


def off_centre_relays(u: Array, levels: int = 60) -> Array:
    """A grid of relays whose density is off the centre and skewed, plus a line."""
    edges = np.linspace(-1.2, 1.2, levels)
    alpha, beta = np.meshgrid(edges, edges, indexing="ij")
    width, middle = alpha - beta, 0.5 * (alpha + beta)
    density = np.exp(-((middle - 0.35) ** 2) / 0.18 - (width - 0.5 - 0.4 * middle) ** 2 / 0.08)
    density *= width >= 0.0
    density /= density.sum()
    relay, y = -np.sign(middle), []
    for value in u.tolist():
        relay = np.where(value >= alpha, 1.0, np.where(value <= beta, -1.0, relay))
        y.append(0.3 * value + float((density * relay).sum()))
    return np.array(y)
