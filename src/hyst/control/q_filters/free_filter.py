"""The free Q-filter: all coefficients of given order and relative degree, noise gain bounded.

Least stacked norm with ``|Q/Pn| <= bound`` at all frequencies: a smooth descent on sums of powers
leads into a valley, and sequential quadratic programs on the peaks, which are collected as they
appear, to its bottom. The filter that comes out is judged by its exact norms, not by these.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.optimize
from numpy.typing import NDArray

from hyst.control.q_filters.family import QFilter
from hyst.control.q_filters.problem import QFilterProblem
from hyst.control.q_filters.responses import FixedResponses, fixed_responses, grid_of, refined_tops
from hyst.control.zeros_and_poles import ZerosAndPoles

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_SLOWER, _FASTER = 30.0, 10.0  # than all poles and zeros of the problem: bounds of the poles
_POWERS = (4.0, 12.0, 40.0)
_LIGHTEST, _HEAVIEST = 0.05, 20.0  # of 2 zeta: poles of a pair are not told apart further
_ROUNDS = 8
_FINISHED = 4
_HOPS, _HOP = 3, 0.5  # for each zero, and how far in logarithms
_SETTLED = 1e-6
_NEAR = np.array([0.03, 0.1, 0.3, 0.7, 0.9, 1.0, 1.1, 1.4, 3.0])  # of the modulus of a pole
_PENALTY = 3.0  # of the squared logarithm of what noise is above its bound
_LARGEST_SHARE = 30.0  # bound of the shares of the numerator


@dataclass(frozen=True)
class FreeFilter:
    """Filters ``Q = K (D_0 + g_1 D_1 x + .. + g_j D_j x^j) / (D_0 + .. + x^m)``, x = s/scale.

    K is the polynomial of the zeros to keep, K(0) = 1. Parameters are the logarithms of 2 zeta and
    omega of each factor ``x^2 + 2 zeta omega x + omega^2`` of the denominator, and c of ``x + e^c``
    if m is odd; then g_1 .. g_j: all 1 is S1 eq. 28, all 0 a numerator of 1. What is minimized is
    the stacked norm, or the largest |Wp (1 - Q)| + |Wu T| if it is to be robust.

    Parameters
    ----------
    problem
        Plant, controller and weights.
    order
        m.
    degree
        j, number of zeros besides those to keep.
    scale
        Unit of s, rad/s.
    robust
        What is minimized.
    """

    problem: QFilterProblem
    order: int
    degree: int
    scale: float
    robust: bool = False

    @property
    def size(self) -> int:
        """Number of parameters."""
        return self.order + self.degree

    def filter_of(self, x: Array) -> QFilter:
        """Give the filter of the parameters x."""
        below, _ = _expanded(x[: self.order])
        shares = np.concatenate([[1.0], x[self.order :]])
        above = np.trim_zeros(shares * below[: shares.size], "b")
        kept = self.problem.kept_zeros
        zeros = np.roots(above[::-1]).astype(complex) if above.size > 1 else np.zeros(0, complex)
        top = float(above[-1] * np.real(np.prod(-self.scale / kept)))
        zeros = np.concatenate([zeros * self.scale, kept])
        poles = _roots(x[: self.order]) * self.scale
        gain = top * self.scale ** (poles.size - zeros.size)
        return QFilter(ZerosAndPoles(zeros, poles, gain))

    def values_and_slopes(
        self, x: Array, fixed: FixedResponses
    ) -> tuple[ComplexArray, ComplexArray]:
        """Give Q at the frequencies, (K,), and its derivatives by the parameters, (K, size).

        Parameters
        ----------
        x
            Parameters, (size,).
        fixed
            Frequencies with what does not depend on Q.
        """
        below, slopes = _expanded(x[: self.order])
        powers = (fixed.s / self.scale)[:, None] ** np.arange(self.order + 1)
        shares = np.zeros(self.order + 1)
        shares[0], shares[1 : self.degree + 1] = 1.0, x[self.order :]
        kept = self.problem.kept_zeros
        K = np.prod(1.0 - fixed.s[:, None] / kept, axis=1)
        D = powers @ below
        Q = K * (powers @ (shares * below)) / D
        by_coefficient = powers * (K[:, None] * shares - Q[:, None]) / D[:, None]
        last = slice(1, self.degree + 1)
        by_share = K[:, None] * powers[:, last] * below[last] / D[:, None]
        return Q, np.hstack([by_coefficient @ slopes.T, by_share])

    def bounds(self) -> list[tuple[float, float]]:
        """Give bounds of the parameters: poles a little beyond all features of the problem."""
        size = np.log(np.abs(self.problem.features) / self.scale)
        low, high = size.min() - np.log(_SLOWER), size.max() + np.log(_FASTER)
        pairs = self.order // 2
        found = [(np.log(_LIGHTEST), np.log(_HEAVIEST)), (low, high)] * pairs
        found += [(low, high)] * (self.order % 2)
        return found + [(-_LARGEST_SHARE, _LARGEST_SHARE)] * self.degree

    def parameters_of(self, poles: ComplexArray, shares: Array) -> Array:
        """Give the parameters of stable poles, rad/s, and shares g."""
        unit = poles / self.scale
        pairs = [(-2.0 * p.real / abs(p), abs(p)) for p in unit if p.imag > 0.0]
        real = np.sort(-unit[unit.imag == 0.0].real)
        for i in range(0, real.size - 1, 2):
            omega = np.sqrt(real[i] * real[i + 1])
            pairs.append(((real[i] + real[i + 1]) / omega, omega))
        values = [each for pair in pairs for each in pair]
        if real.size % 2:
            values.append(real[-1])
        return np.concatenate([np.log(values), shares])


def descend_free(
    free: FreeFilter, starts: list[Array], most_noise: float, hops: int = _HOPS
) -> tuple[Array, float, int]:
    """Give the best parameters from the starts, their norm and the number of descents.

    Parameters
    ----------
    free
        The family.
    starts
        Parameters; those that amplify too much noise are led back within the bound.
    most_noise
        Bound on |Q/Pn|.
    hops
        For each zero of the filter, from the best so far.
    """
    w = grid_of(free.problem)
    coarse = fixed_responses(free.problem, w[::2])
    smooth = [_descend_smoothed(free, each, coarse, most_noise) for each in starts]
    smooth.append(starts[0])
    smooth.sort(key=lambda x: _judged(free, x, w, most_noise))
    ends = [_finished(free, x, w, most_noise) for x in smooth[:_FINISHED]]
    judged = [(_judged(free, x, w, most_noise), x) for x in ends]
    # Minima are many: hop from the best so far to its neighbourhood.
    rng = np.random.default_rng(0)
    low, high = np.array(free.bounds()).T
    for _ in range(hops * free.degree):
        best = min(judged, key=lambda each: each[0])[1]
        hop = np.clip(best + rng.normal(0.0, _HOP, free.size), low, high)
        x = _descend_smoothed(free, hop, coarse, most_noise, _POWERS[1:])
        x = _finished(free, x, w, most_noise)
        judged.append((_judged(free, x, w, most_noise), x))
    norm, best = min(judged, key=lambda each: each[0])
    return best, norm, len(starts) + len(judged)


def _heights(
    free: FreeFilter, x: Array, fixed: FixedResponses, most_noise: float
) -> tuple[Array, Array, Array, Array]:
    """Squares of the stacked gain and of |Q/Pn| over its bound, and their derivatives."""
    Q, slopes = free.values_and_slopes(x, fixed)
    E = 1.0 - Q
    T = 1.0 - fixed.S0 * E
    Wu2, Wp2 = fixed.Wu**2, fixed.Wp**2
    if free.robust:
        # (a + b)^2 has the slopes of a^2 (1 + b/a) + b^2 (1 + a/b) with both quotients held.
        a = np.maximum(fixed.Wu * np.abs(T), 1e-150)
        b = np.maximum(fixed.Wp * np.abs(E), 1e-150)
        stack, Wu2, Wp2 = (a + b) ** 2, Wu2 * (1.0 + b / a), Wp2 * (1.0 + a / b)
    else:
        stack = Wu2 * np.abs(T) ** 2 + Wp2 * np.abs(E) ** 2
    outer = Wu2 * np.conj(T) * fixed.S0 - Wp2 * np.conj(E)
    weight = 1.0 / np.maximum(np.abs(fixed.plant) * most_noise, 1e-150) ** 2
    noise = weight * np.abs(Q) ** 2
    return (
        stack,
        2.0 * np.real(outer[:, None] * slopes),
        noise,
        2.0 * weight[:, None] * np.real(np.conj(Q)[:, None] * slopes),
    )


def _descend_smoothed(
    free: FreeFilter,
    start: Array,
    fixed: FixedResponses,
    most_noise: float,
    powers: tuple[float, ...] = _POWERS,
) -> Array:
    low, high = np.array(free.bounds()).T
    x = np.clip(start, low, high)
    for power in powers:

        def cost(x: Array, power: float = power) -> tuple[float, Array]:
            stack, stack_slopes, noise, noise_slopes = _heights(free, x, fixed, most_noise)
            logs = np.log(np.maximum(stack, 1e-300))
            top = float(logs.max())
            shares = np.exp(power * (logs - top))
            slope = (shares / np.maximum(stack, 1e-300)) @ stack_slopes / shares.sum()
            beyond = np.maximum(np.log(np.maximum(noise, 1e-300)), 0.0)
            slope += 2.0 * _PENALTY * (beyond / np.maximum(noise, 1e-300)) @ noise_slopes
            value = top + float(np.log(shares.sum())) / power
            return value + _PENALTY * float(beyond @ beyond), slope

        with np.errstate(all="ignore"):
            found = scipy.optimize.minimize(
                cost, x, jac=True, method="L-BFGS-B", bounds=free.bounds(), options={"maxiter": 60}
            )
        if np.isfinite(found.x).all():
            x = found.x
    return np.asarray(x)


def _finished(free: FreeFilter, start: Array, w: Array, most_noise: float) -> Array:
    """Minimize t over (x, t) with all peaks met so far below t, those of noise below the bound."""
    best, value = start, _judged(free, start, w, most_noise)
    x, met_stack, met_noise = start, np.zeros(0), np.zeros(0)
    for _ in range(_ROUNDS):
        met_stack = np.union1d(met_stack, _tops(free, x, w, most_noise, of_noise=False))
        met_noise = np.union1d(met_noise, _tops(free, x, w, most_noise, of_noise=True))
        x = _program(free, x, met_stack, met_noise, most_noise)
        now = _judged(free, x, w, most_noise)
        gained = (value - now) / value
        if now < value:
            best, value = x, now
        if abs(gained) < _SETTLED:
            break
    return best


def _program(
    free: FreeFilter, start: Array, met_stack: Array, met_noise: Array, most_noise: float
) -> Array:
    at_stack = fixed_responses(free.problem, met_stack)
    at_noise = fixed_responses(free.problem, met_noise)

    def room(z: Array) -> Array:
        below_t = z[-1] - _heights(free, z[:-1], at_stack, most_noise)[0]
        return np.concatenate([below_t, 1.0 - _heights(free, z[:-1], at_noise, most_noise)[2]])

    def room_slopes(z: Array) -> Array:
        stack = -_heights(free, z[:-1], at_stack, most_noise)[1]
        noise = -_heights(free, z[:-1], at_noise, most_noise)[3]
        by_t = np.concatenate([np.ones(len(stack)), np.zeros(len(noise))])
        return np.hstack([np.vstack([stack, noise]), by_t[:, None]])

    low, high = np.array(free.bounds()).T
    start = np.clip(start, low, high)
    t = float(_heights(free, start, at_stack, most_noise)[0].max())
    # Peaks not met yet rise where the program does not look: steps are kept short.
    near = [(max(a, x - 0.7), min(b, x + 0.7)) for a, b, x in zip(low, high, start, strict=True)]
    unit = np.zeros(free.size + 1)
    unit[-1] = 1.0
    with np.errstate(all="ignore"):
        found = scipy.optimize.minimize(
            lambda z: float(z[-1]),
            np.concatenate([start, [t]]),
            jac=lambda z: unit,
            method="SLSQP",
            bounds=[*near, (0.0, None)],
            constraints={"type": "ineq", "fun": room, "jac": room_slopes},
            options={"maxiter": 40, "ftol": 1e-9},
        )
    return np.asarray(found.x[:-1] if np.isfinite(found.x).all() else start)


def _tops(free: FreeFilter, x: Array, w: Array, most_noise: float, of_noise: bool) -> Array:
    where, _ = refined_tops(_height_of(free, x, most_noise, of_noise), w, 0.7, 2)
    return where


def _judged(free: FreeFilter, x: Array, w: Array, most_noise: float) -> float:
    """Give the norm; what amplifies more noise than it may is worse than all that does not."""
    own = np.abs(_roots(x[: free.order])) * free.scale
    w = np.union1d(w, (own[:, None] * _NEAR).ravel())
    norm = refined_tops(_height_of(free, x, most_noise, False), w, 0.7, 3)[1][0]
    share = refined_tops(_height_of(free, x, most_noise, True), w, 0.7, 3)[1][0]
    return float(np.sqrt(norm)) + (0.0 if share < 1.0 + 1e-5 else 1e6 * float(share))


def _height_of(
    free: FreeFilter, x: Array, most_noise: float, of_noise: bool
) -> Callable[[Array], Array]:
    def height(w: Array) -> Array:
        fixed = fixed_responses(free.problem, w)
        seen = fixed.with_filter(free.values_and_slopes(x, fixed)[0])
        if of_noise:
            return (seen.Q_over_plant / most_noise) ** 2
        return (seen.robust_performance if free.robust else seen.stacked) ** 2

    return height


def _expanded(parameters: Array) -> tuple[Array, Array]:
    """Coefficients of the denominator, lowest power first, and their derivatives (m, m + 1)."""
    m = parameters.size
    values = np.exp(parameters)
    factors = [
        np.array([values[i + 1] ** 2, values[i] * values[i + 1], 1.0])
        for i in range(0, m - m % 2, 2)
    ]
    if m % 2:
        factors.append(np.array([values[-1], 1.0]))
    product = np.array([1.0])
    for each in factors:
        product = np.convolve(product, each)
    slopes = np.zeros((m, m + 1))
    for i, factor in enumerate(factors):
        rest = np.array([1.0])
        for j, other in enumerate(factors):
            if j != i:
                rest = np.convolve(rest, other)
        if factor.size == 3:
            slopes[2 * i, 1 : rest.size + 1] = factor[1] * rest
            slopes[2 * i + 1] = slopes[2 * i]
            slopes[2 * i + 1, : rest.size] += 2.0 * factor[0] * rest
        else:
            slopes[m - 1, : rest.size] = factor[0] * rest
    return product, slopes


def _roots(parameters: Array) -> ComplexArray:
    """Poles in units of the scale, from each factor by itself, so that pairs stay exact."""
    m, values = parameters.size, np.exp(parameters)
    found: list[complex] = []
    for i in range(0, m - m % 2, 2):
        a, b = values[i] * values[i + 1], values[i + 1] ** 2
        inside = 0.25 * a * a - b
        if inside >= 0.0:
            large = -(0.5 * a + np.sqrt(inside))
            found += [large, b / large]
        else:
            found += [complex(-0.5 * a, np.sqrt(-inside)), complex(-0.5 * a, -np.sqrt(-inside))]
    if m % 2:
        found.append(-values[-1])
    return np.array(found, dtype=complex)
