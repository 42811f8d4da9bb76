"""The best time constant: a grid over all decades, then golden sections on the exact value."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_PER_DECADE = 12
_VALLEYS = 3
_FINE = 41
_GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)
_WIDTH = 1e-4  # of tau, relative
_TIED = 2e-4  # norms that near are equal, and the slower filter is taken


@dataclass
class TimeConstantSearch:
    """Minimize a function of the time constant that may have several valleys, kinks and flats.

    Parameters
    ----------
    on_grid
        Costs of many time constants at once, near enough to tell valleys apart.
    exact
        Cost of one.
    fastest, slowest
        Between which tau is looked for, s.
    """

    on_grid: Callable[[Array], Array]
    exact: Callable[[float], float]
    fastest: float
    slowest: float
    evaluations: int = 0

    def run(self) -> tuple[float, float]:
        """Give the best tau and its cost: within a tie the slowest, which amplifies noise least."""
        decades = float(np.log10(self.slowest / self.fastest))
        taus = np.geomspace(self.fastest, self.slowest, int(_PER_DECADE * decades) + 2)
        costs = self.on_grid(taus)
        padded = np.concatenate([[np.inf], costs, [np.inf]])
        valleys = np.flatnonzero((costs <= padded[:-2]) & (costs <= padded[2:]))
        valleys = valleys[np.argsort(costs[valleys], kind="stable")][:_VALLEYS]
        found = []
        for i in valleys.tolist():
            low, high = float(taus[max(i - 1, 0)]), float(taus[min(i + 1, taus.size - 1)])
            found.append(self._golden(*self._closer(low, high)))
        return self._slower(*min(found, key=lambda each: each[1]))

    def _cost(self, tau: float) -> tuple[float, float]:
        self.evaluations += 1
        return tau, self.exact(tau)

    def _closer(self, low: float, high: float) -> tuple[float, float]:
        """Narrow a bracket by what a finer grid shows; two cells are left on either side."""
        taus = np.geomspace(low, high, _FINE)
        best = int(self.on_grid(taus).argmin())
        return float(taus[max(best - 2, 0)]), float(taus[min(best + 2, _FINE - 1)])

    def _golden(self, low: float, high: float) -> tuple[float, float]:
        a, b = np.log(low), np.log(high)
        c, d = b - _GOLDEN * (b - a), a + _GOLDEN * (b - a)
        at_c, at_d = self._cost(float(np.exp(c))), self._cost(float(np.exp(d)))
        best = min(at_c, at_d, key=lambda each: each[1])
        while b - a > _WIDTH:
            if at_c[1] < at_d[1]:
                b, d, at_d = d, c, at_c
                c = b - _GOLDEN * (b - a)
                at_c = self._cost(float(np.exp(c)))
            else:
                a, c, at_c = c, d, at_d
                d = a + _GOLDEN * (b - a)
                at_d = self._cost(float(np.exp(d)))
            best = min(best, at_c, at_d, key=lambda each: each[1])
        return best

    def _slower(self, tau: float, cost: float) -> tuple[float, float]:
        """Where the cost is flat, go to larger tau as far as it stays within the tie."""
        allowed, step = cost * (1.0 + _TIED), 1.01
        while tau * step <= self.slowest:
            tried = self._cost(tau * step)
            if tried[1] > allowed:
                break
            (tau, cost), step = tried, step * step
        while step > 1.01:
            step = float(np.sqrt(step))
            tried = self._cost(tau * step)
            if tried[1] <= allowed:
                tau, cost = tried
        return tau, cost


def cost_with_noise(norm: float, noise: float, most_noise: float | None) -> float:
    """Give the norm; a filter beyond the bound is worse than any within it, and the more so.

    Parameters
    ----------
    norm
        What is to be small.
    noise, most_noise
        Gain of the noise and its bound; None if it may be any.
    """
    if most_noise is None or noise <= most_noise * (1.0 + 1e-9):
        return norm
    return 1e6 * noise / most_noise + norm
