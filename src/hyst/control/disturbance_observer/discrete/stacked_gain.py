"""The gain to be minimized in discrete time, as a function of frequency and of the poles of Q.

With a the denominator and b the numerator of the sampled plant and m the polynomial of the sampled
internal model, the observer that is corrected by the sample at hand has ``1 - Q = m k / x`` and
``Q = z l b / x`` with ``m k + z l b = x``: k of the degree of a, l of degree below m. The square of
the stacked gain is ``(a(w)^2 + Wn^2) |K S|^2 + |Wp E|^2``, where ``E = 1 - Q``,
``K S = S0 (C + Q / Pd)``, ``S0 = 1 / (1 + C Pd)`` and a(w) is all that a plant within Wu can add
to Pd, aliases folded. All polynomials are in the w-plane, in units of ``scale``.

Nothing is inverted but the plant's denominator, so zeros outside the circle and delays are fine.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from hyst.control.disturbance_observer.discrete.polynomials import injection, mapped_polynomial
from hyst.control.disturbance_observer.discrete.problem import SampledObserverProblem
from hyst.control.disturbance_observer.discrete.w_plane import (
    continuous_in_w_plane,
    factored,
    poles_in_w_plane,
    to_w_plane,
)
from hyst.control.disturbance_observer.stacked_gain import (
    Frequencies,
    StackedGain,
    feedback_matrix,
)
from hyst.control.linear_system import LinearSystem
from hyst.control.sampled.folding import folded_uncertainty, weight_response
from hyst.control.zeros_and_poles import ZerosAndPoles, zeros_and_poles

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_PER_DECADE = 24
_SLOWER = 100.0  # than all poles and zeros of the problem
_LOWEST, _HIGHEST = 1e-9, 1e3  # of W on the grid
_AROUND = np.array([-3.0, -1.5, -0.7, -0.3, 0.0, 0.3, 0.7, 1.5, 3.0])
_DENSE, _CLOSE = 100, np.linspace(-4.0, 4.0, 33)  # of what is interpolated
# Poles of Q: |s| of a pair at most 1, which is half of Nyquist, and real poles above z = -1/3.
_FASTEST = 1.0


@dataclass(frozen=True)
class SampledFrequencies(Frequencies):
    """Frequencies ``w``, here W of the w-plane; ``Wu2`` is ``a^2 + Wn^2``, of K S.

    ``plain`` is K S of the controller alone, ``over`` the ``numerator`` over Pd.
    """

    plain: ComplexArray
    over: ComplexArray


class SampledStackedGain(StackedGain):
    """Square of the stacked gain, and its gradient, for parameters of the poles of Q.

    Parameters are those of ``StackedGain``, of polynomials in the w-plane: all of them are stable
    after the map. Poles of Q that belong to the delay stay at z = 0, where its states are exact.
    """

    problem: SampledObserverProblem

    def __init__(self, problem: SampledObserverProblem) -> None:
        self.problem = problem
        self.sampled = factored(problem.plant)
        self.delays = int((self.sampled.poles == -1.0).sum())
        self.order = problem.order - self.delays
        self.model_poles = poles_in_w_plane(problem.sampled_model.A_d)
        # Eigenvalues at 0 are what makes Q(1) = 1.
        self.model_poles[np.abs(self.model_poles) < 1e-12] = 0.0
        self.closed = poles_in_w_plane(feedback_matrix(problem.plant, problem.controller))
        self.controller = _around_one(problem.controller)
        self.S0 = self._sensitivity()
        # What starts are drawn from: those poles and zeros that Q may have.
        zeros = self.sampled.zeros[self.sampled.zeros.real < 0.0]
        self.plant = ZerosAndPoles(zeros, self.sampled.poles[self.sampled.poles != -1.0], 1.0)
        self.Wu, self.Wp = (_features_of(each, problem.dt) for each in (problem.Wu, problem.Wp))
        self.features = self._features()
        self.scale = float(np.exp(np.mean(np.log(np.abs(self.features)))))
        self.model = np.real(np.poly(self.model_poles / self.scale))
        # z b of the plant; its size is kept in l, so a factor common to all is harmless.
        self.numerator_zeros = np.concatenate([self.sampled.zeros, [-1.0 + 0.0j]])
        self.numerator = np.real(np.atleast_1d(np.poly(self.numerator_zeros / self.scale)))
        self.fixed = np.real(np.atleast_1d(np.poly(np.full(self.delays, -1.0 / self.scale))))
        self._solution = np.linalg.inv(self._sylvester())
        self._latest = (np.zeros(0), np.zeros(0), np.zeros((0, 0)))
        self._weights = self._interpolated()
        self.grid = self.at(self._grid())
        self.lowest, self.highest = self._box()

    def _sensitivity(self) -> ZerosAndPoles:
        """1 / (1 + C Pd): 1 at z = infinity, that is s = 1, for Pd is strictly proper."""
        opened = np.concatenate([self.sampled.poles, self.controller.poles])
        size = np.prod(1.0 - self.closed) / np.prod(1.0 - opened)
        return ZerosAndPoles(opened, self.closed, float(np.real(size)))

    def _features(self) -> ComplexArray:
        parts = (self.sampled, self.Wu, self.Wp, self.S0)
        found = np.concatenate([np.concatenate([p.zeros, p.poles]) for p in parts])
        found = np.concatenate([found, self.model_poles])
        size = np.abs(found)
        return np.asarray(found[(size > _LOWEST) & (size < _HIGHEST)])

    def _box(self) -> tuple[Array, Array]:
        slow = np.log(np.abs(self.features).min() / self.scale / _SLOWER)
        fast = np.log(_FASTEST / self.scale)
        pairs = 2 * (self.order // 2)
        lowest, highest = np.full(self.order, slow), np.full(self.order, fast)
        highest[:pairs:2] += np.log(2.0)
        lowest[1:pairs:2] *= 2.0
        highest[1:pairs:2] *= 2.0
        return lowest, highest

    def _grid(self) -> Array:
        size = np.abs(self.features)
        low, high = np.log10(size.min() / 100.0), np.log10(_HIGHEST)
        even = np.logspace(low, high, int(_PER_DECADE * (high - low)) + 1)
        sharp = np.abs(self.features.imag)[:, None] + np.abs(self.features.real)[:, None] * _AROUND
        sharp = sharp[(sharp > 10.0**low) & (sharp < 10.0**high)]
        return np.unique(np.concatenate([even, sharp, size]))

    def _interpolated(self) -> CubicSpline:
        """Logarithms of ``a^2 + Wn^2`` and ``|Wp|^2`` over log W; the certificate has them exact."""
        problem, size = self.problem, np.abs(self.features)
        low, high = np.log10(size.min() / 1e3), np.log10(10.0 * _HIGHEST)
        even = np.logspace(low, high, int(_DENSE * (high - low)) + 1)
        around = np.abs(self.features.imag)[:, None] + np.abs(self.features.real)[:, None] * _CLOSE
        around = around[(around > 10.0**low) & (around < 10.0**high)]
        w = np.unique(np.concatenate([even, around]))
        w = w[np.concatenate([[True], np.diff(w) > 1e-5 * w[1:]])]
        of_time = 2.0 * np.arctan(w) / problem.dt
        a = folded_uncertainty(problem.sampled, problem.Wu, of_time)
        Wp = np.abs(weight_response(problem.Wp, of_time))
        squares = np.stack([a**2 + problem.noise**2, Wp**2], axis=1)
        return CubicSpline(np.log(w), np.log(np.maximum(squares, 1e-280)))

    def at(self, w: Array) -> SampledFrequencies:
        """Collect what does not depend on the gain at the frequencies w of the w-plane."""
        s, problem = 1j * w, self.problem
        unit = s / self.scale
        powers = (unit[:, None] ** np.arange(problem.order, -1, -1)).astype(complex)
        weights = np.exp(self._weights(np.log(w)))
        plant, control, S0 = self.sampled, self.controller, self.S0
        # C and S0 as one: a pole of C on the circle is a zero of S0.
        above = np.prod(s[:, None] - np.concatenate([control.zeros, plant.poles]), axis=1)
        plain = control.gain * S0.gain * above / np.prod(s[:, None] - self.closed, axis=1)
        over = (1.0 + s) * np.prod(s[:, None] - plant.poles, axis=1) / plant.gain
        return SampledFrequencies(
            w,
            weights[:, 0],
            S0.response(s),
            weights[:, 1],
            powers,
            np.asarray(np.prod(unit[:, None] - self.model_poles / self.scale, axis=1)),
            np.asarray(np.prod(unit[:, None] - self.numerator_zeros / self.scale, axis=1)),
            np.asarray(plain),
            np.asarray(over / self.scale**self.numerator_zeros.size),
        )

    def _expanded(self, parameters: Array) -> tuple[Array, Array]:
        x, slopes = super()._expanded(parameters)
        if self.delays == 0:
            return x, slopes
        return np.convolve(x, self.fixed), np.array([np.convolve(e, self.fixed) for e in slopes])

    def _sylvester(self) -> Array:
        n, n_p = self.problem.order, self.problem.plant.order
        matrix = np.zeros((n + 1, n + 1))
        for i in range(n_p + 1):
            matrix[i : i + self.model.size, i] = self.model
        for i in range(n - n_p):
            start = n + 1 - self.numerator.size - (n - n_p - 1 - i)
            matrix[start : start + self.numerator.size, n_p + 1 + i] = self.numerator
        return matrix

    def values(self, parameters: Array, at: Frequencies) -> Array:
        """Square of the stacked gain at each frequency, for parameters of the poles of Q."""
        E, N, _ = self._parts(self.polynomial(parameters)[0], at)
        return np.asarray(at.Wu2 * np.abs(N) ** 2 + at.Wp2 * np.abs(E) ** 2)

    def values_and_slopes(self, parameters: Array, at: Frequencies) -> tuple[Array, Array]:
        """Square of the stacked gain at each frequency, and its derivatives by the parameters."""
        assert isinstance(at, SampledFrequencies)
        x, slopes = self.polynomial(parameters)
        E, N, below = self._parts(x, at)
        l_slopes = (self._solution @ slopes.T)[self.problem.plant.order + 1 :]
        # dQ = (dl b - Q dx) / x, and K S follows Q / Pd.
        of_l = at.powers[:, -l_slopes.shape[0] :] @ l_slopes
        of_x = at.powers @ slopes.T
        through_N = at.Wu2 * np.conj(N)
        outer_l = through_N * at.S0 * at.over - at.Wp2 * np.conj(E) * at.numerator
        outer_x = through_N * (N - at.plain) - at.Wp2 * np.conj(E) * (1.0 - E)
        with np.errstate(over="ignore", invalid="ignore"):
            derivatives = 2.0 * np.real(
                (outer_l / below)[:, None] * of_l - (outer_x / below)[:, None] * of_x
            )
        value = at.Wu2 * np.abs(N) ** 2 + at.Wp2 * np.abs(E) ** 2
        return np.asarray(value), np.asarray(derivatives)

    def _parts(self, x: Array, at: Frequencies) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        """Give E, K S and x at the frequencies."""
        assert isinstance(at, SampledFrequencies)
        solution = self._solution @ x
        k, low = solution[: self.problem.plant.order + 1], solution[self.problem.plant.order + 1 :]
        below = at.powers @ x
        below = np.where(np.abs(below) > 1e-60, below, 1e-60)
        E = at.model * (at.powers[:, -k.size :] @ k) / below
        N = at.plain + at.S0 * (at.powers[:, -low.size :] @ low) * at.over / below
        return E, N, below

    def gain_of(self, parameters: Array) -> Array:
        """Give the gain L that places the poles of Q as the parameters say."""
        n_p, model, plant = self.problem.plant.order, self.problem.sampled_model, self.sampled
        x = self.polynomial(parameters)[0]
        solution = self._solution @ x
        # z = 1 + sigma t.
        sigma, n_d = 2.0 * self.scale, model.order
        at_infinity = float(np.polyval(x, 1.0 / self.scale))
        units = float(np.real(np.prod(1.0 - plant.poles))) / plant.gain
        size = 2.0**n_d * units / self.scale ** (plant.zeros.size + 1) / at_infinity
        low = mapped_polynomial(solution[n_p + 1 :], self.scale) * size * sigma ** (1 - n_d)
        A_d = (model.A_d - np.eye(n_d)) / sigma
        M_d = injection(A_d, model.C_d, np.concatenate([[0.0], low]))
        now = float((model.C_d @ M_d)[0])
        A = (self.problem.plant.A - np.eye(n_p)) / sigma
        k = mapped_polynomial(solution[: n_p + 1], self.scale)
        k = k / k[0] + now * self._numerator_in_t(sigma)
        L_p = sigma * injection(A, self.problem.plant.C, k - np.real(np.poly(A)))
        return np.concatenate([L_p, model.A_d @ M_d])

    def _numerator_in_t(self, sigma: float) -> Array:
        """Give b of Pd = b / a with a monic in t."""
        plant, n = self.sampled, self.problem.plant.order
        product = np.ones(1, complex)
        for zero in plant.zeros:
            product = np.convolve(product, [sigma * (1.0 - zero), -2.0 * zero])
        for _ in range(n - plant.zeros.size):
            product = np.convolve(product, [sigma, 2.0])
        size = plant.gain / np.prod(1.0 - plant.poles) / sigma**n
        return np.real(product * size)


def _around_one(system: LinearSystem) -> ZerosAndPoles:
    """Factor the controller in the w-plane, its poles at z = 1 exactly at 0."""
    parts = factored(system)
    poles = np.where(np.abs(parts.poles) < 1e-12, 0.0, parts.poles)
    return ZerosAndPoles(parts.zeros, poles, parts.gain)


def _features_of(weight: LinearSystem, dt: float) -> ZerosAndPoles:
    """Where a weight changes, in the w-plane; its values are computed over true frequency."""
    if weight.dt > 0.0:
        parts = zeros_and_poles(weight)
        return ZerosAndPoles(to_w_plane(parts.zeros), to_w_plane(parts.poles), 1.0)
    parts = zeros_and_poles(weight)
    zeros, poles = (continuous_in_w_plane(each, dt) for each in (parts.zeros, parts.poles))
    return ZerosAndPoles(zeros, poles, 1.0)
