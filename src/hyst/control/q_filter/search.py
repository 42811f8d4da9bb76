"""The best time constant: a grid over all decades, then golden sections on the exact norm."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.control.infinity_norm import hinf_norm
from hyst.control.q_filter.family import QFilter
from hyst.control.q_filter.loops import filtered_inverse, weighted_stack
from hyst.control.q_filter.problem import QFilterProblem
from hyst.control.q_filter.responses import FixedResponses, fixed_responses, grid_of

Array = NDArray[np.float64]

_PER_DECADE = 12
_BEYOND = 30.0  # faster and slower than all poles and zeros of the problem
_VALLEYS = 3
_FINE = 41
_GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)
_WIDTH = 1e-4  # of tau, relative
_TIED = 2e-4  # norms that near are equal, and the slower filter is taken


@dataclass(frozen=True)
class Tried:
    """A time constant with what it achieves; cost is the norm, larger if noise is amplified."""

    tau: float
    cost: float
    norm: float
    noise_gain: float


@dataclass
class TimeConstantSearch:
    """Minimize the stacked norm of a one-parameter family.

    Parameters
    ----------
    problem
        Plant, controller and weights.
    family
        From tau to the filter.
    most_noise
        Bound on the norm of Q/Pn; None if it may be any.
    """

    problem: QFilterProblem
    family: Callable[[float], QFilter]
    most_noise: float | None = None
    evaluations: int = 0

    def run(self) -> Tried:
        """Give the best: of those within the tie the slowest, which amplifies noise least."""
        taus = self._grid()
        costs = self._costs_on_grid(taus)
        padded = np.concatenate([[np.inf], costs, [np.inf]])
        valleys = np.flatnonzero((costs <= padded[:-2]) & (costs <= padded[2:]))
        valleys = valleys[np.argsort(costs[valleys], kind="stable")][:_VALLEYS]
        found = []
        for i in valleys.tolist():
            low, high = float(taus[max(i - 1, 0)]), float(taus[min(i + 1, taus.size - 1)])
            found.append(self._golden(*self._closer(low, high)))
        best = min(found, key=lambda each: each.cost)
        return self._slower(best)

    def exact(self, tau: float) -> Tried:
        """Compute the norms of the filter with this tau by the Hamiltonian."""
        self.evaluations += 1
        Q = self.family(tau)
        norm = hinf_norm(weighted_stack(self.problem, Q.system))[0]
        if self.most_noise is None:
            return Tried(tau, norm, norm, np.nan)
        noise = hinf_norm(filtered_inverse(self.problem, Q))[0]
        return Tried(tau, _with_noise(norm, noise / self.most_noise), norm, noise)

    def _grid(self) -> Array:
        size = np.abs(self.problem.features)
        low = float(np.log10(1.0 / (size.max() * _BEYOND)))
        high = float(np.log10(_BEYOND / size.min()))
        return np.logspace(low, high, int(_PER_DECADE * (high - low)) + 2)

    def _costs_on_grid(self, taus: Array) -> Array:
        w = grid_of(self.problem)
        fixed: FixedResponses = fixed_responses(self.problem, w)
        Q = np.array([self.family(float(tau)).response(fixed.s) for tau in taus])
        seen = fixed.with_filter(Q)
        norms = seen.stacked.max(axis=1)
        if self.most_noise is None:
            return np.asarray(norms)
        shares = seen.Q_over_plant.max(axis=1) / self.most_noise
        return np.array([_with_noise(a, b) for a, b in zip(norms, shares, strict=True)])

    def _golden(self, low: float, high: float) -> Tried:
        a, b = np.log(low), np.log(high)
        c, d = b - _GOLDEN * (b - a), a + _GOLDEN * (b - a)
        at_c, at_d = self.exact(float(np.exp(c))), self.exact(float(np.exp(d)))
        best = min(at_c, at_d, key=lambda each: each.cost)
        while b - a > _WIDTH:
            if at_c.cost < at_d.cost:
                b, d, at_d = d, c, at_c
                c = b - _GOLDEN * (b - a)
                at_c = self.exact(float(np.exp(c)))
            else:
                a, c, at_c = c, d, at_d
                d = a + _GOLDEN * (b - a)
                at_d = self.exact(float(np.exp(d)))
            best = min(best, at_c, at_d, key=lambda each: each.cost)
        return best

    def _closer(self, low: float, high: float) -> tuple[float, float]:
        """Narrow a bracket by what a finer grid shows; two cells are left on either side."""
        taus = np.geomspace(low, high, _FINE)
        best = int(self._costs_on_grid(taus).argmin())
        return float(taus[max(best - 2, 0)]), float(taus[min(best + 2, _FINE - 1)])

    def _slower(self, best: Tried) -> Tried:
        """Where the norm is flat, go to larger tau as far as it stays within the tie."""
        allowed = best.cost * (1.0 + _TIED)
        low, step, slowest = best, 1.01, _BEYOND / float(np.abs(self.problem.features).min())
        while low.tau * step <= slowest:
            tried = self.exact(low.tau * step)
            if tried.cost > allowed:
                break
            low, step = tried, step * step
        while step > 1.01:
            step = float(np.sqrt(step))
            tried = self.exact(low.tau * step)
            if tried.cost <= allowed:
                low = tried
        return low


def _with_noise(norm: float, share: float) -> float:
    """Give the norm; a filter beyond the bound is worse than any within it, and the more so."""
    return norm if share <= 1.0 + 1e-9 else 1e6 * share + norm
