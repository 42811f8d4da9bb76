"""Switching materials: smooth densities of relays, followed column by column on a fine plane.

A column holds the relays of one beta, all up to one alpha; nothing is shared with the package.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Density = Callable[[Array, Array], Array]

BETAS, ALPHAS = 3000, 400


def gaussian(coercive: float, width: float, bias: float, middle: float = 0.0) -> Density:
    """Give a density that is Gaussian in coercive field and bias."""

    def density(alpha: Array, beta: Array) -> Array:
        h, b = (alpha - beta) / 2.0 - coercive, (alpha + beta) / 2.0 - middle
        return np.exp(-0.5 * ((h / width) ** 2 + (b / bias) ** 2))

    return density


def log_normal(coercive: float, width: float, bias: float) -> Density:
    """Give a density that is log-normal in coercive field and Gaussian in bias."""

    def density(alpha: Array, beta: Array) -> Array:
        h = np.maximum((alpha - beta) / 2.0, 1e-9)
        bell = ((alpha + beta) / 2.0 / bias) ** 2
        return np.exp(-0.5 * (np.log(h / coercive) / width) ** 2 - 0.5 * bell) / h

    return density


def switched(density: Density, u: Array) -> Array:
    """Give the share of relays that are up, all down at first, thresholds within -1.5 and 1.5."""
    edges = np.linspace(-1.5, 1.5, BETAS + 1)
    beta, alpha = (edges[1:] + edges[:-1]) / 2.0, np.linspace(-1.5, 1.5, ALPHAS)
    mass = np.where(alpha >= beta[:, None], density(alpha[None, :], beta[:, None]), 0.0)
    up_to = np.zeros_like(mass)
    up_to[:, 1:] = np.cumsum((mass[:, 1:] + mass[:, :-1]) / 2.0, axis=1)
    up_to /= up_to[:, -1].sum()
    front, columns, step = beta.copy(), np.arange(BETAS), alpha[1] - alpha[0]
    y = np.empty(u.size)
    for k, each in enumerate(u):
        front = np.where(beta <= each, np.maximum(front, each), beta)
        place = np.clip((front - alpha[0]) / step, 0.0, ALPHAS - 1.001)
        whole = place.astype(np.intp)
        low, high = up_to[columns, whole], up_to[columns, whole + 1]
        y[k] = float(np.sum(low + (place - whole) * (high - low)))
    return y


def strokes(turns: Sequence[float], samples: int = 100) -> Array:
    """Give straight strokes from turn to turn, so many samples for each unit."""
    parts = [np.array([turns[0]])]
    for a, b in itertools.pairwise(turns):
        parts.append(np.linspace(a, b, max(round(samples * abs(b - a)), 2) + 1)[1:])
    return np.concatenate(parts)


def reversal_turns(reversals: Sequence[float]) -> list[float]:
    """Give the turns of first-order reversal curves from the top, 1."""
    return [each for beta in reversals for each in (float(beta), 1.0)]
