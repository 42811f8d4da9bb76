"""Where the free Q-filter starts: textbook filters, and the best of one order less."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.control.q_filters.certificate import certify_filter
from hyst.control.q_filters.family import QFilter
from hyst.control.q_filters.free_filter import FreeFilter, descend_free
from hyst.control.q_filters.problem import QFilterProblem

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_SPEEDS = (0.6, 1.5, 4.0)  # of the textbook filter
_HOPS = 3
_ATTEMPTS = 4


@dataclass
class FreeSearch:
    """Find the best free filter: order by order, so that one more is never worse.

    Parameters
    ----------
    problem
        Plant, controller and weights.
    relative_degree
        rho of the filters.
    tau
        Time constant of a textbook filter that is worth starting from, s.
    most_noise
        Bound on |Q/Pn|.
    robust
        Minimize |Wp (1 - Q)| + |Wu T| instead of the stacked norm.
    """

    problem: QFilterProblem
    relative_degree: int
    tau: float
    most_noise: float
    robust: bool = False
    descents: int = 0

    def run(self, m: int) -> QFilter:
        """Give the best filter of order m."""
        least = self.relative_degree + int(self.problem.kept_zeros.size)
        found = self._best(least, None)
        for order in range(least + 1, m + 1):
            found = self._best(order, found)
        return found

    def _best(self, m: int, smaller: QFilter | None) -> QFilter:
        size = np.abs(self.problem.features)
        scale = float(2.0 ** round(float(np.mean(np.log2(size)))))
        kept = self.problem.kept_zeros
        degree = m - self.relative_degree - kept.size
        free = FreeFilter(self.problem, m, degree, scale, self.robust)
        starts = self._starts(free)
        if smaller is not None:
            starts.insert(0, _extended(free, smaller))
        allowed = self.most_noise
        for attempt in range(_ATTEMPTS):
            x, _, descents = descend_free(free, starts, allowed, 0 if attempt else _HOPS)
            self.descents += descents
            Q = free.filter_of(x)
            noise = certify_filter(self.problem, Q).observer_noise_gain
            if noise <= self.most_noise * (1.0 + 1e-4):
                break
            # A peak between the frequencies that were looked at: a little less is allowed.
            allowed *= min(0.9999, self.most_noise / noise)
            starts = [x, *starts[:2]]
        return Q

    def _starts(self, free: FreeFilter) -> list[Array]:
        """Binomial and Butterworth poles of several speeds, with and without a numerator."""
        m = free.order
        circle = -np.exp(1j * np.pi * (np.arange(m) - 0.5 * (m - 1)) / m)
        circle = np.where(np.abs(circle.imag) < 1e-12, circle.real, circle)
        even = -np.ones(m, dtype=np.complex128)
        found = [free.parameters_of(even / self.tau, np.zeros(free.degree))]
        # Equal factors have equal gradients and would stay equal for ever.
        apart = even * (np.geomspace(0.8, 1.25, m) if m > 1 else 1.0)
        for speed in _SPEEDS:
            for poles in (apart, circle.astype(np.complex128)):
                for share in (0.2, 1.0) if free.degree else (0.0,):
                    shares = np.full(free.degree, share)
                    found.append(free.parameters_of(speed * poles / self.tau, shares))
        return found


def _extended(free: FreeFilter, smaller: QFilter) -> Array:
    """Give the same filter with one pole more, fast, and a zero that cancels it."""
    fast = -3.0 * float(np.abs(smaller.factors.poles).max())
    poles = np.append(smaller.factors.poles, fast)
    kept = free.problem.kept_zeros.size
    own = smaller.factors.zeros[: smaller.factors.zeros.size - kept]
    zeros = np.append(own, fast)
    below = np.real(np.poly(poles / free.scale))[::-1]
    above = below[0] * np.real(np.poly(free.scale / zeros))
    return free.parameters_of(poles, above[1:] / below[1 : above.size])
