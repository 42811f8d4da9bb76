"""The gain to be minimized, as a function of frequency and of the poles of Q.

With a the denominator and b the numerator of the plant and m the polynomial of the internal model,
every gain L gives ``1 - Q = m k / x`` and ``Q = l b / x``, where x is the polynomial of the
observer's poles and k (monic, degree of a) and l (degree below m) solve ``m k + l b = x``. Because
``T = 1 - S0 (1 - Q)`` with ``S0 = 1 / (1 + Pn C)``, the square of the stacked gain is
``|Wu (1 - S0 E)|^2 + |Wp E|^2`` with ``E = 1 - Q``. Polynomials are in units of ``scale``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.control.disturbance_observer.problem import ObserverProblem
from hyst.control.linear_system import LinearSystem
from hyst.control.zeros_and_poles import Points, ZerosAndPoles, zeros_and_poles

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_PER_DECADE = 24
_SLOWER, _FASTER = 100.0, 10.0  # than all poles and zeros of the problem
_AROUND = np.array([-3.0, -1.5, -0.7, -0.3, 0.0, 0.3, 0.7, 1.5, 3.0])


@dataclass(frozen=True)
class Frequencies:
    """Frequencies ``w`` with all that does not depend on the gain.

    ``Wu2`` and ``Wp2`` are squares of the weights, ``S0`` is the sensitivity; ``powers`` of s, the
    ``model`` polynomial and the ``numerator`` of the plant are in units of the scale.
    """

    w: Array
    Wu2: Array
    S0: ComplexArray
    Wp2: Array
    powers: ComplexArray
    model: Points
    numerator: Points


class StackedGain:
    """Square of the stacked gain, and its gradient, for parameters of the poles of Q.

    Parameters are logarithms: a, b of each factor ``s^2 + e^a s + e^b``, then c of ``s + e^c`` if
    the order is odd. All stable polynomials have this form, so that every point is stabilizing.
    """

    def __init__(self, problem: ObserverProblem) -> None:
        self.problem = problem
        self.order = problem.order
        self.plant = zeros_and_poles(problem.plant)
        self.Wu, self.Wp = zeros_and_poles(problem.Wu), zeros_and_poles(problem.Wp)
        self.S0 = _sensitivity(problem)
        self.model_poles = np.linalg.eigvals(problem.internal_model.A_d).astype(complex)
        self.features = self._features()
        self.scale = float(np.exp(np.mean(np.log(np.abs(self.features)))))
        self.model = np.real(np.poly(self.model_poles / self.scale))
        # As a polynomial in s/scale; its size is kept in l, so a factor common to all is harmless.
        self.numerator = np.real(np.atleast_1d(np.poly(self.plant.zeros / self.scale)))
        self._solution = np.linalg.inv(self._sylvester())
        self._latest = (np.zeros(0), np.zeros(0), np.zeros((0, 0)))
        self.grid = self.at(self._grid())
        self.lowest, self.highest = self._box()

    def _features(self) -> ComplexArray:
        parts = (self.plant, self.Wu, self.Wp, self.S0)
        found = np.concatenate([np.concatenate([p.zeros, p.poles]) for p in parts])
        found = np.concatenate([found, self.model_poles])
        found = found[np.abs(found) > 1e-9 * np.abs(found).max()]
        return np.asarray(found)

    def _box(self) -> tuple[Array, Array]:
        """Bounds of the parameters: poles a little beyond all features of plant and weights.

        Some weights are met best by infinitely fast poles: nobody can sample those, and the
        doubles of L cannot hold them beside slow ones.
        """
        size = np.log(np.abs(self.features) / self.scale)
        slow, fast = size.min() - np.log(_SLOWER), size.max() + np.log(_FASTER)
        pairs = 2 * (self.order // 2)
        lowest, highest = np.full(self.order, slow), np.full(self.order, fast)
        lowest[1:pairs:2] *= 2.0
        highest[1:pairs:2] *= 2.0
        return lowest, highest

    def _grid(self) -> Array:
        size = np.abs(self.features)
        low, high = np.log10(size.min() / 100.0), np.log10(size.max() * 100.0)
        even = np.logspace(low, high, int(_PER_DECADE * (high - low)) + 1)
        sharp = np.abs(self.features.imag)[:, None] + np.abs(self.features.real)[:, None] * _AROUND
        return np.unique(np.concatenate([even, sharp[sharp > 10.0**low], size]))

    def at(self, w: Array) -> Frequencies:
        """Collect what does not depend on the gain at the frequencies w, rad/s."""
        s = 1j * w
        unit = s / self.scale
        powers: ComplexArray = (unit[:, None] ** np.arange(self.order, -1, -1)).astype(complex)
        return Frequencies(
            w,
            np.abs(self.Wu.response(s)) ** 2,
            self.S0.response(s),
            np.abs(self.Wp.response(s)) ** 2,
            powers,
            np.prod(unit[:, None] - self.model_poles / self.scale, axis=1),
            np.asarray(np.prod(unit[:, None] - self.plant.zeros / self.scale, axis=1)),
        )

    def _sylvester(self) -> Array:
        """Matrix that takes (k, l) to the coefficients of m k + l b, highest power first."""
        n, n_p = self.order, self.problem.plant.order
        matrix = np.zeros((n + 1, n + 1))
        for i in range(n_p + 1):
            matrix[i : i + self.model.size, i] = self.model
        for i in range(n - n_p):
            start = n + 1 - self.numerator.size - (n - n_p - 1 - i)
            matrix[start : start + self.numerator.size, n_p + 1 + i] = self.numerator
        return matrix

    def polynomial(self, parameters: Array) -> tuple[Array, Array]:
        """Give the coefficients of x, and their derivatives (parameters, n + 1)."""
        if not np.array_equal(parameters, self._latest[0]):
            self._latest = (parameters.copy(), *self._expanded(parameters))
        return self._latest[1:]

    def _expanded(self, parameters: Array) -> tuple[Array, Array]:
        n = self.order
        a, b, c = _split(np.exp(parameters), n)
        factors = [np.array([1.0, p, q]) for p, q in zip(a, b, strict=True)]
        factors += [np.array([1.0, p]) for p in c]
        x = np.array([1.0])
        for each in factors:
            x = np.convolve(x, each)
        slopes = np.zeros((n, n + 1))
        for i, factor in enumerate(factors):
            rest = np.array([1.0])
            for j, other in enumerate(factors):
                if j != i:
                    rest = np.convolve(rest, other)
            if factor.size == 3:
                slopes[2 * i, n - rest.size : n] = factor[1] * rest
                slopes[2 * i + 1, n + 1 - rest.size :] = factor[2] * rest
            else:
                slopes[2 * len(a), n + 1 - rest.size :] = factor[1] * rest
        return x, slopes

    def values(self, parameters: Array, at: Frequencies) -> Array:
        """Square of the stacked gain at each frequency, for parameters of the poles of Q."""
        E, _ = self._one_minus_q(self.polynomial(parameters)[0], at)
        value = at.Wu2 * np.abs(1.0 - at.S0 * E) ** 2 + at.Wp2 * np.abs(E) ** 2
        return np.asarray(value)

    def values_and_slopes(self, parameters: Array, at: Frequencies) -> tuple[Array, Array]:
        """Square of the stacked gain at each frequency, and its derivatives by the parameters."""
        x, slopes = self.polynomial(parameters)
        E, below = self._one_minus_q(x, at)
        T = 1.0 - at.S0 * E
        outer = at.Wp2 * np.conj(E) - at.Wu2 * np.conj(T) * at.S0
        l_slopes = (self._solution @ slopes.T)[self.problem.plant.order + 1 :]
        n_l = l_slopes.shape[0]
        Q_slopes = (at.powers[:, -n_l:] @ l_slopes) * at.numerator[:, None]
        Q_slopes -= (at.powers @ slopes.T) * (1.0 - E)[:, None]
        # Next to a pole of Q on the axis slopes overflow; a descent turns back there anyway.
        with np.errstate(over="ignore", invalid="ignore"):
            derivatives = -2.0 * np.real((outer / below)[:, None] * Q_slopes)
        value = at.Wu2 * np.abs(T) ** 2 + at.Wp2 * np.abs(E) ** 2
        return np.asarray(value), np.asarray(derivatives)

    def _one_minus_q(self, x: Array, at: Frequencies) -> tuple[ComplexArray, ComplexArray]:
        k = (self._solution @ x)[: self.problem.plant.order + 1]
        below = at.powers @ x
        # A pole of Q all but on the axis may meet a frequency of the grid.
        below = np.where(np.abs(below) > 1e-60, below, 1e-60)
        return at.model * (at.powers[:, -k.size :] @ k) / below, below

    def peaks(self, parameters: Array, share: float = 0.9, rounds: int = 4) -> Array:
        """Frequencies of the local maxima that reach a share of the largest, highest first.

        Each is closed in on in so many rounds; parameters as for ``values``.
        """
        roots = np.roots(self.polynomial(parameters)[0]) * self.scale
        sharp = (np.abs(roots.imag)[:, None] + np.abs(roots.real)[:, None] * _AROUND).ravel()
        inside = (sharp > self.grid.w[0]) & (sharp < self.grid.w[-1])
        more = self.at(np.unique(np.concatenate([sharp[inside], np.abs(roots)])))
        w = np.concatenate([self.grid.w, more.w])
        f = np.concatenate([self.values(parameters, self.grid), self.values(parameters, more)])
        w, first = np.unique(w, return_index=True)
        f = f[first]
        above = np.concatenate([[-np.inf], f, [-np.inf]])
        top = (f >= above[:-2]) & (f >= above[2:]) & (f >= share**2 * f.max())
        index = np.flatnonzero(top)
        low, high = w[np.maximum(index - 1, 0)], w[np.minimum(index + 1, w.size - 1)]
        return self._refined(parameters, low, w[index], high, rounds)

    def _refined(
        self, parameters: Array, low: Array, best: Array, high: Array, rounds: int
    ) -> Array:
        """Close in on each maximum between its neighbours by parabolas, all at once."""
        value = np.full(best.size, -np.inf)
        for _ in range(rounds):
            w = np.concatenate([low, best, high])
            at_low, at_best, at_high = self.values(parameters, self.at(w)).reshape(3, -1)
            left, right = low - best, high - best
            with np.errstate(divide="ignore", invalid="ignore"):
                a, b = (at_low - at_best) / left, (at_high - at_best) / right
                top = best + 0.5 * (left * b - right * a) / (b - a)
            top = np.where(np.isfinite(top), np.clip(top, low, high), best)
            # The first parabola may miss a sharp peak: the sample before it then stays the best.
            here = self.values(parameters, self.at(top))
            better = here >= at_best
            best, value = np.where(better, top, best), np.where(better, here, at_best)
            width = 0.15 * np.minimum(best - low, high - best)
            width = np.maximum(width, 1e-6 * best)
            low, high = best - width, best + width
        return best[np.argsort(-value)]

    def parameters_of(self, poles: ComplexArray) -> Array:
        """Give the parameters of stable poles, rad/s."""
        unit = np.asarray(poles, dtype=complex) / self.scale
        pairs = [(-2.0 * p.real, abs(p) ** 2) for p in unit if p.imag > 0.0]
        real = np.sort(-unit[unit.imag == 0.0].real)
        for i in range(0, real.size - 1, 2):
            pairs.append((real[i] + real[i + 1], real[i] * real[i + 1]))
        values = [each for pair in pairs for each in pair]
        if real.size % 2:
            values.append(real[-1])
        return np.log(np.maximum(values, 1e-12))

    def gain_of(self, parameters: Array) -> Array:
        """Give the gain L that places the poles of Q as the parameters say."""
        n_p, model = self.problem.plant.order, self.problem.internal_model
        solution = self._solution @ self.polynomial(parameters)[0]
        k, numerator = solution[: n_p + 1], solution[n_p + 1 :]
        A, C = self.problem.plant.A / self.scale, self.problem.plant.C
        L_1 = self.scale * _injection(A, C, k - np.real(np.poly(A)))
        # b of the plant is its monic numerator times its gain, here in units of scale.
        size = self.plant.gain * self.scale ** (self.plant.zeros.size - self.plant.poles.size)
        L_2 = self.scale * _injection(
            model.A_d / self.scale, model.C_d, np.concatenate([[0.0], numerator / size])
        )
        return np.concatenate([L_1, L_2])


def _split(values: Array, n: int) -> tuple[Array, Array, Array]:
    pairs = 2 * (n // 2)
    return values[0:pairs:2], values[1:pairs:2], values[pairs:]


def _injection(A: Array, C: Array, coefficients: Array) -> Array:
    """Solve ``C adj(sI - A) L = coefficients`` (degree below n, after a leading 0) for L."""
    n = A.shape[0]
    characteristic = np.real(np.poly(A))
    row, rows = C[0], [C[0]]
    for k in range(1, n):
        row = row @ A + characteristic[k] * C[0]
        rows.append(row)
    matrix = np.array(rows)
    size = np.abs(matrix).max(axis=0)
    return np.asarray(np.linalg.solve(matrix / size, coefficients[1:]) / size)


def _sensitivity(problem: ObserverProblem) -> ZerosAndPoles:
    plant, controller = problem.plant, problem.controller
    closed = feedback_matrix(plant, controller)
    open_poles = np.concatenate([plant.poles(), controller.poles()])
    return ZerosAndPoles(open_poles, np.linalg.eigvals(closed).astype(complex), 1.0)


def feedback_matrix(plant: LinearSystem, controller: LinearSystem) -> Array:
    """Matrix of the loop of plant and controller alone, the first factor of eq. 33."""
    y = np.hstack([plant.C, plant.D @ controller.C]) / (1.0 + plant.D[0, 0] * controller.D[0, 0])
    u = np.hstack([np.zeros((1, plant.order)), controller.C]) - controller.D @ y
    A = np.zeros((plant.order + controller.order, plant.order + controller.order))
    A[: plant.order, : plant.order] = plant.A
    A[plant.order :, plant.order :] = controller.A
    return np.asarray(A + np.vstack([plant.B @ u, -controller.B @ y]))
