"""The tightest rational function over samples: ``|W(jw)|^2 = n(w^2) / d(w^2)``.

For a factor t, ``r_i^2 d(x_i) <= n(x_i) <= t^2 r_i^2 d(x_i)`` is linear in the coefficients, so the
least t is found by bisection of linear programs. Both polynomials are written over a common
denominator with its roots spread over the samples, so that no coefficient is much larger than
another, whatever the range of frequencies.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.optimize
from numpy.typing import NDArray

Array = NDArray[np.float64]

_STEPS = 14  # of the bisection
_ENOUGH = 1e-3  # in the logarithm of t
_STRICT = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}
_BEYOND = np.geomspace(1.0, 1e8, 33)  # of x, on either side of the samples
_FAR = 1e3
_POLISHING = 5  # steps of Newton's method
_HIGHEST = 1e4  # at infinity, in squares of the largest sample


@dataclass(frozen=True, eq=False)
class Target:
    """What is to be covered.

    Parameters
    ----------
    x
        Shape (p,), ``w^2``, or ``tan(w dt/2)^2`` of what is sampled; infinity at half the rate.
    radius
        Shape (p,), above 0.
    tight
        Shape (p,), what the cover is to be tight on, not below the radius; infinity where it is
        only to be a cover.
    """

    x: Array
    radius: Array
    tight: Array


@dataclass(frozen=True, eq=False)
class Cover:
    """``n / d = (a_0 + sum a_j p_j/(x + p_j)) / (b_0 + sum b_j p_j/(x + p_j))``.

    Parameters
    ----------
    corners
        Shape (n,), p.
    above, below
        Shape (n + 1,), a and b.
    excess
        Largest ratio of the cover to what it is to be tight on.
    """

    corners: Array
    above: Array
    below: Array
    excess: float

    @property
    def order(self) -> int:
        """Degree of n and d in x."""
        return int(self.corners.size)

    def roots(self, coefficients: Array) -> NDArray[np.complex128]:
        """Give the zeros in x of ``c_0 + sum c_j p_j/(x + p_j)``."""
        if self.order == 0:
            return np.zeros(0, dtype=complex)
        # Graded from large to small, for corners may lie twenty decades apart.
        p, c = self.corners[::-1], coefficients[:0:-1]
        root = np.sqrt(p / p[0])
        matrix = -np.diag(p / p[0]) - np.outer(root, c * root) / coefficients[0]
        found = p[0] * np.linalg.eigvals(matrix).astype(np.complex128)
        return np.array([_polished(each, coefficients[0], c * p, p) for each in found])


def tightest(target: Target, order: int, ceiling: float = np.inf) -> Cover | None:
    """Find the tightest cover of an order.

    Parameters
    ----------
    target
        What is to be covered.
    order
        Of the cover, >= 0.
    ceiling
        Largest excess that is of interest.

    Returns
    -------
    Cover or None
        None if the excess is above the ceiling.
    """
    problem = _Problem.of(target, order)
    spread = float(target.radius.max() / target.tight.min())
    high = min(ceiling, max(spread, 1.0) * (1.0 + 1e-6))
    best = problem.cover(high)
    if best is None:
        return None
    low, top = 0.0, float(np.log(high))
    for _ in range(_STEPS):
        if top - low < _ENOUGH:
            break
        middle = 0.5 * (low + top)
        found = problem.cover(float(np.exp(middle)))
        if found is None:
            low = middle
        else:
            best, top = found, middle
    return best


@dataclass(frozen=True, eq=False)
class _Problem:
    """Rows of the linear programs."""

    target: Target
    corners: Array
    rows: Array  # the basis at the samples
    far: Array  # and beyond them, on both sides
    held: Array  # what the cover must be there

    @classmethod
    def of(cls, target: Target, order: int) -> _Problem:
        x, r = target.x, target.radius
        inner = x[(x > 0.0) & np.isfinite(x)]
        low, high = (inner.min(), inner.max()) if inner.size else (1.0, 1.0)
        # At half a sample rate x is infinity: what rises towards it has corners far out.
        outermost = high if np.isfinite(x).all() else _FAR * high
        corners = np.geomspace(low, outermost, 2 * order + 1)[1::2]
        # What was not measured is not known: beyond the samples a cover does not fall.
        below, above = low / _BEYOND, high * _BEYOND
        far = np.concatenate([[0.0], below, above, [np.inf]])
        first, last = r[int(np.argmin(x))], r[int(np.argmax(x))]
        held = np.where(np.arange(far.size) <= below.size, first, last)
        return cls(target, corners, _basis(x, corners), _basis(far, corners), held)

    def cover(self, factor: float) -> Cover | None:
        """Give a cover of at most this excess; None if there is none."""
        r2, judged = np.square(self.target.radius)[:, None], np.isfinite(self.target.tight)
        limit2 = np.square(factor * self.target.tight[judged])[:, None]
        size = float(np.exp(np.mean(np.log(r2))))
        rows, far, held = self.rows, self.far, np.square(self.held)[:, None]
        n, inside = rows.shape[1], rows[judged]
        zero = np.zeros_like
        # Each row is <= -margin: cover, tight, a cover beyond, finite there, and d above 0.
        blocks = [
            np.hstack([-rows * (size / r2), rows]),
            np.hstack([inside * (size / limit2), -inside]),
            np.hstack([-far * (size / held), far]),
            np.hstack([far * (size / (_HIGHEST * r2.max())), -far]),
            np.hstack([zero(rows), -rows]),
            np.hstack([zero(far), -far]),
        ]
        matrix = np.vstack(blocks)
        scales = np.abs(matrix).max(axis=1, keepdims=True)
        matrix = np.hstack([matrix / scales, np.ones((len(matrix), 1))])
        cost = np.zeros(2 * n + 1)
        cost[-1] = -1.0
        normal = np.concatenate([np.zeros(n), rows.mean(axis=0), [0.0]])[None]
        solved = scipy.optimize.linprog(
            cost,
            matrix,
            np.zeros(len(matrix)),
            normal,
            np.ones(1),
            [(None, None)] * (2 * n) + [(None, 1.0)],
            "highs",
            options=_STRICT,
        )
        if solved.status != 0 or solved.x[-1] <= 0.0:
            return None
        above, below = size * solved.x[:n], solved.x[n : 2 * n]
        return self._checked(Cover(self.corners, above, below, factor))

    def _checked(self, found: Cover) -> Cover | None:
        """Give a cover with its true excess; None if rounding made it none."""
        n, d = self.rows @ found.above, self.rows @ found.below
        ends = (found.above[0], found.below[0], found.above.sum(), found.below.sum())
        if min(n.min(), d.min(), *ends) <= 0.0:
            return None
        gain = np.sqrt(n / d)
        short = max(float((self.target.radius / gain).max()), 1.0)
        return Cover(
            found.corners, found.above, found.below, short * float((gain / self.target.tight).max())
        )


def _polished(x: complex, constant: float, residues: Array, corners: Array) -> complex:
    """Improve a zero of ``constant + sum residues / (x + corners)`` by Newton's method."""
    for _ in range(_POLISHING):
        with np.errstate(all="ignore"):
            terms = residues / (x + corners)
            step = -(constant + np.sum(terms)) / np.sum(terms / (x + corners))
        if not abs(step) < 0.1 * abs(x):  # not of NaN
            break
        x = complex(x - step)
    return x


def _basis(x: Array, corners: Array) -> Array:
    with np.errstate(invalid="ignore"):
        parts = corners / (x[:, None] + corners)
    return np.hstack([np.ones((x.size, 1)), parts])
