"""Frequency responses of a loop with a Q-filter, from zeros and poles, and peaks of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.control.q_filters.family import QFilter
from hyst.control.q_filters.problem import QFilterProblem

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_PER_DECADE = 24
_AROUND = np.array([-3.0, -1.5, -0.7, -0.3, 0.0, 0.3, 0.7, 1.5, 3.0])
_BEYOND = 100.0  # slower and faster than all features
_TOPS = 8


@dataclass(frozen=True)
class QResponses:
    """Absolute values over frequency, each (K,).

    Parameters
    ----------
    Wu_T, Wp_E
        |Wu T| and |Wp (1 - Q)|.
    Q_over_plant
        |Q/Pn|, from sensor noise to the estimate.
    T_over_plant
        |T/Pn|, from sensor noise to v.
    """

    Wu_T: Array
    Wp_E: Array
    Q_over_plant: Array
    T_over_plant: Array

    @property
    def stacked(self) -> Array:
        """Gain of [Wu T; Wp (1 - Q)]."""
        return np.asarray(np.hypot(self.Wu_T, self.Wp_E))

    @property
    def robust_performance(self) -> Array:
        """|Wp (1 - Q)| + |Wu T|."""
        return self.Wu_T + self.Wp_E


@dataclass(frozen=True)
class FixedResponses:
    """What does not depend on Q, each (K,).

    Parameters
    ----------
    s
        Frequencies, 1j w.
    S0, plant
        Values of the sensitivity of the controller alone and of the plant.
    Wu, Wp
        Absolute values of the weights.
    """

    s: ComplexArray
    S0: ComplexArray
    plant: ComplexArray
    Wu: Array
    Wp: Array

    def with_filter(self, Q: ComplexArray) -> QResponses:
        """Give what a filter makes of it.

        Parameters
        ----------
        Q
            Its values, (..., K).
        """
        E = 1.0 - Q
        T = 1.0 - self.S0 * E
        with np.errstate(divide="ignore", invalid="ignore"):
            noise, drive = np.abs(Q / self.plant), np.abs(T / self.plant)
        return QResponses(
            self.Wu * np.abs(T),
            self.Wp * np.abs(E),
            # Where the plant is 0 so is Q, and the quotient is that of its neighbours.
            np.where(np.isfinite(noise), noise, 0.0),
            np.where(np.isfinite(drive), drive, 0.0),
        )


def fixed_responses(problem: QFilterProblem, w: Array) -> FixedResponses:
    """Collect what does not depend on the filter.

    Parameters
    ----------
    problem
        Plant, controller and weights.
    w
        Frequencies, rad/s.
    """
    s = np.asarray(1j * w, dtype=np.complex128)
    return FixedResponses(
        s,
        problem.sensitivity.response(s),
        problem.plant_factors.response(s),
        np.abs(problem.Wu_factors.response(s)),
        np.abs(problem.Wp_factors.response(s)),
    )


def responses_of(problem: QFilterProblem, Q: QFilter | None, w: Array) -> QResponses:
    """Give the absolute values of the loop.

    Parameters
    ----------
    problem
        Plant, controller and weights.
    Q
        The filter; None for no observer.
    w
        Frequencies, rad/s.
    """
    fixed = fixed_responses(problem, w)
    return fixed.with_filter(np.zeros(w.size, complex) if Q is None else Q.response(fixed.s))


def grid_of(problem: QFilterProblem, Q: QFilter | None = None) -> Array:
    """Give frequencies, rad/s: over all decades of interest, dense around each pole and zero.

    Parameters
    ----------
    problem
        Plant, controller and weights.
    Q
        A filter whose poles and zeros are of interest as well.
    """
    roots = problem.features
    if Q is not None:
        own = np.concatenate([Q.factors.poles, Q.factors.zeros])
        roots = np.concatenate([roots, own[np.abs(own) > 0.0]])
    size = np.abs(roots)
    low, high = np.log10(size.min() / _BEYOND), np.log10(size.max() * _BEYOND)
    even = np.logspace(low, high, int(_PER_DECADE * (high - low)) + 2)
    near = (np.abs(roots.imag)[:, None] + np.abs(roots.real)[:, None] * _AROUND).ravel()
    return np.unique(np.concatenate([even, near[near > 10.0**low], size]))


def refined_tops(
    function: Callable[[Array], Array], w: Array, share: float = 0.0, rounds: int = 5
) -> tuple[Array, Array]:
    """Give the local maxima of a function on the grid w, each closed in on, highest first.

    Parameters
    ----------
    function
        Takes and gives (K,).
    w
        Grid, rad/s, ascending.
    share
        Maxima below this share of the highest are left out.
    rounds
        Each makes the bracket around a maximum six times smaller.
    """
    values = function(w)
    padded = np.concatenate([[-np.inf], values, [-np.inf]])
    tops = np.flatnonzero((values >= padded[:-2]) & (values >= padded[2:]))
    tops = tops[values[tops] >= share * values.max()]
    tops = tops[np.argsort(-values[tops], kind="stable")][:_TOPS]
    low, high = w[np.maximum(tops - 1, 0)], w[np.minimum(tops + 1, w.size - 1)]
    best, where, columns = values[tops], w[tops], np.arange(tops.size)
    steps = np.linspace(0.0, 1.0, 13)[:, None]
    for _ in range(rounds):
        inside = low + (high - low) * steps
        here = function(inside.ravel()).reshape(inside.shape)
        top = here.argmax(axis=0)
        found = here[top, columns]
        where = np.where(found > best, inside[top, columns], where)
        best = np.maximum(found, best)
        low = inside[np.maximum(top - 1, 0), columns]
        high = inside[np.minimum(top + 1, 12), columns]
    order = np.argsort(-best, kind="stable")
    return where[order], best[order]


def rejection_bandwidth(Q: QFilter, level: float = np.sqrt(0.5)) -> float:
    """Give the lowest frequency at which |1 - Q| reaches the level, rad/s; inf if it never does.

    A root of ``|D - N|^2 = level^2 |D|^2``, a polynomial of the squared frequency.
    """
    poles = Q.factors.poles
    scale = float(np.exp(np.mean(np.log(np.abs(poles)))))
    below = np.real(np.poly(poles / scale))
    gain = Q.factors.gain * scale ** (-Q.relative_degree)
    above = gain * np.real(np.atleast_1d(np.poly(Q.factors.zeros / scale)))
    left = below - np.concatenate([np.zeros(below.size - above.size), above])
    roots = np.roots(_square(left) - level**2 * _square(below))
    found = roots.real[(np.abs(roots.imag) < 1e-6 * np.abs(roots)) & (roots.real > 0.0)]
    return float(np.sqrt(found.min()) * scale) if found.size else np.inf


def _square(polynomial: Array) -> Array:
    """|p(jw)|^2 as a polynomial of w^2, highest power first."""
    n = polynomial.size - 1
    signs = (-1.0) ** np.arange(n, -1, -1)
    square = np.polymul(polynomial, polynomial * signs)[::2]
    # Powers of s^2 = -w^2.
    return np.asarray(square * (-1.0) ** np.arange(n, -1, -1))
