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

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from hyst.control.disturbance_observer import pole_parameters
from hyst.control.disturbance_observer.discrete.noise_gain import SampledNoiseGain
from hyst.control.disturbance_observer.discrete.polynomials import injection, mapped_polynomial
from hyst.control.disturbance_observer.discrete.problem import (
    SampledObserverProblem,
    sampled_model,
)
from hyst.control.disturbance_observer.discrete.w_plane import (
    continuous_in_w_plane,
    factored,
    from_w_plane,
    poles_in_w_plane,
    to_w_plane,
)
from hyst.control.disturbance_observer.internal_model import InternalModel
from hyst.control.disturbance_observer.peaks import AROUND
from hyst.control.disturbance_observer.stacked_gain import (
    Frequencies,
    Solved,
    StackedGain,
    feedback_matrix,
)
from hyst.control.linear_system import LinearSystem
from hyst.control.sampled.folding import folded_uncertainty, weight_response
from hyst.control.zeros_and_poles import Points, ZerosAndPoles, zeros_and_poles

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_PER_DECADE = 24
_SLOWER = 100.0  # than all poles and zeros of the problem
_FREE_SHARE = 0.5  # of the limit of poles: that of free eigenvalues
_LOWEST, _HIGHEST = 1e-9, 1e3  # of W on the grid
_DENSE, _CLOSE = 100, np.linspace(-4.0, 4.0, 33)  # of what is interpolated


@dataclass(frozen=True)
class SampledFrequencies(Frequencies):
    """Frequencies ``w``, here W of the w-plane; ``Wu2`` is ``a^2 + Wn^2``, of K S.

    ``plain`` is K S of the controller alone, ``over`` the ``numerator`` over Pd. ``S0``, ``Wp2``,
    ``powers``, ``model`` and ``numerator`` are as there, and no ``noise`` stands apart.
    """

    plain: ComplexArray = field(kw_only=True)
    over: ComplexArray = field(kw_only=True)


class SampledStackedGain(StackedGain):
    """Square of the stacked gain, and its gradient, for parameters of the poles of Q.

    Parameters are those of ``StackedGain``, of polynomials in the w-plane: all of them are stable
    after the map. No pole of Q is faster than half of Nyquist, |s| = 1, but those that stay at
    z = 0: of the poles that belong to the delay all but so many.

    Parameters
    ----------
    problem
        Sampled plant and controller, weights and internal model.
    free
        Number of stable eigenvalues that the internal model has besides its own.
    freed
        Of the delay's poles so many are searched like the others.
    fastest_pole
        A lower limit of the poles of Q, rad/s.
    """

    problem: SampledObserverProblem

    def __init__(
        self,
        problem: SampledObserverProblem,
        free: int = 0,
        freed: int = 0,
        fastest_pole: float | None = None,
    ) -> None:
        self.problem, self.free, self.freed = problem, free, freed
        self.fastest_pole = fastest_pole
        self.sampled = factored(problem.plant)
        delays = int((self.sampled.poles == -1.0).sum())
        self.at_zero = delays - min(freed, delays)
        self.total = problem.order + free
        self.order = self.total - self.at_zero
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
        self.Wn = None if problem.Wn is None else _features_of(problem.Wn, problem.dt)
        found = self._features()
        # Those that no pole of Q may reach show peaks, but are no places to start from.
        self.sharp, self.features = found, found[np.abs(found) <= 1.0]
        self.scale = float(np.exp(np.mean(np.log(np.abs(self.features)))))
        self.model = np.real(np.poly(self.model_poles / self.scale))
        # z b of the plant; its size is kept in l, so a factor common to all is harmless.
        self.numerator_zeros = np.concatenate([self.sampled.zeros, [-1.0 + 0.0j]])
        self.numerator = np.real(np.atleast_1d(np.poly(self.numerator_zeros / self.scale)))
        self.delay = np.real(np.atleast_1d(np.poly(np.full(self.at_zero, -1.0 / self.scale))))
        self._fixed = None if free else np.linalg.inv(self._sylvester(self.model))
        self._latest = None
        self._weights = self._interpolated()
        self.grid = self.at(self._grid())
        self.fastest = float(np.log(_limit(fastest_pole, problem.dt) / self.scale))
        self.lowest, self.highest = self._box()

    @cached_property
    def noise(self) -> SampledNoiseGain:  # type: ignore[override]
        """The square of |Q / Pd|, what the observer makes of the sensor's noise in the drive."""
        return SampledNoiseGain(self)

    def enlarged(self) -> SampledStackedGain:
        """Give the same with one free eigenvalue more."""
        return SampledStackedGain(self.problem, self.free + 1, self.freed, self.fastest_pole)

    def rates(self) -> tuple[float, float]:
        """Give the ends of the band in which free eigenvalues may start, in the w-plane."""
        most = _FREE_SHARE * self.scale * float(np.exp(self.fastest))
        return min(self.scale / 3.0, 0.1 * most), most

    def _sensitivity(self) -> ZerosAndPoles:
        """1 / (1 + C Pd): 1 at z = infinity, that is s = 1, for Pd is strictly proper."""
        opened = np.concatenate([self.sampled.poles, self.controller.poles])
        size = np.prod(1.0 - self.closed) / np.prod(1.0 - opened)
        return ZerosAndPoles(opened, self.closed, float(np.real(size)))

    def _features(self) -> ComplexArray:
        parts = [self.sampled, self.Wu, self.Wp, self.S0]
        parts += [] if self.Wn is None else [self.Wn]
        found = np.concatenate([np.concatenate([p.zeros, p.poles]) for p in parts])
        found = np.concatenate([found, self.model_poles])
        size = np.abs(found)
        return np.asarray(found[(size > _LOWEST) & (size < _HIGHEST)])

    def _box(self) -> tuple[Array, Array]:
        slow = float(np.log(np.abs(self.features).min() / self.scale / _SLOWER))
        of_poles = pole_parameters.bounds(self.order, slow, self.fastest + float(np.log(2.0)))
        of_model = pole_parameters.bounds(self.free, slow, self.fastest + np.log(_FREE_SHARE))
        return (
            np.concatenate([of_poles[0], of_model[0]]),
            np.concatenate([of_poles[1], of_model[1]]),
        )

    def inside(self, parameters: Array) -> Array:
        """Take the parameters into their bounds, and poles to where none is too fast."""
        held = super().inside(parameters)
        held[self.order :] = pole_parameters.slowed(
            held[self.order :], self.fastest + float(np.log(_FREE_SHARE))
        )
        return held

    def _grid(self) -> Array:
        size = np.abs(self.features)
        low, high = np.log10(size.min() / 100.0), np.log10(_HIGHEST)
        even = np.logspace(low, high, int(_PER_DECADE * (high - low)) + 1)
        sharp = np.abs(self.sharp.imag)[:, None] + np.abs(self.sharp.real)[:, None] * AROUND
        sharp = sharp[(sharp > 10.0**low) & (sharp < 10.0**high)]
        return np.unique(np.concatenate([even, sharp, size]))

    def _interpolated(self) -> CubicSpline:
        """Interpolate the weights, logarithms over log W; only the certificate has them exact."""
        problem, size = self.problem, np.abs(self.features)
        low, high = np.log10(size.min() / 1e3), np.log10(10.0 * _HIGHEST)
        even = np.logspace(low, high, int(_DENSE * (high - low)) + 1)
        around = np.abs(self.sharp.imag)[:, None] + np.abs(self.sharp.real)[:, None] * _CLOSE
        around = around[(around > 10.0**low) & (around < 10.0**high)]
        w = np.unique(np.concatenate([even, around]))
        w = w[np.concatenate([[True], np.diff(w) > 1e-5 * w[1:]])]
        of_time = 2.0 * np.arctan(w) / problem.dt
        a = folded_uncertainty(problem.sampled, problem.Wu, of_time)
        Wp = np.abs(weight_response(problem.Wp, of_time))
        noise = 0.0 if problem.Wn is None else np.abs(weight_response(problem.Wn, of_time)) ** 2
        squares = np.stack([a**2 + noise, Wp**2], axis=1)
        return CubicSpline(np.log(w), np.log(np.maximum(squares, 1e-280)))

    def at(self, w: Array) -> SampledFrequencies:
        """Collect what does not depend on the gain at the frequencies w of the w-plane."""
        s = 1j * w
        unit = s / self.scale
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
            self.powers(unit),
            np.asarray(np.prod(unit[:, None] - self.model_poles / self.scale, axis=1)),
            np.asarray(np.prod(unit[:, None] - self.numerator_zeros / self.scale, axis=1)),
            plain=np.asarray(plain),
            over=np.asarray(over / self.scale**self.numerator_zeros.size),
        )

    def powers(self, unit: Points) -> ComplexArray:
        """Powers of s/scale, the highest first, (frequencies, total order + 1)."""
        return np.asarray((unit[:, None] ** np.arange(self.total, -1, -1)).astype(complex))

    def _sylvester(self, model: Array) -> Array:
        """Matrix that takes (k, l) to the coefficients of m k + z l b, highest power first."""
        n, n_p = self.total, self.problem.plant.order
        matrix = np.zeros((n + 1, n + 1))
        for i in range(n_p + 1):
            matrix[i : i + model.size, i] = model
        for i in range(n - n_p):
            start = n + 1 - self.numerator.size - (n - n_p - 1 - i)
            matrix[start : start + self.numerator.size, n_p + 1 + i] = self.numerator
        return matrix

    def _solve(self, parameters: Array) -> Solved:
        n, m, n_p = self.total, self.order, self.problem.plant.order
        x, of_poles = pole_parameters.polynomial(parameters[:m])
        r, of_model = pole_parameters.polynomial(parameters[m:])
        x = np.convolve(x, self.delay)
        inverse = self._fixed
        if inverse is None:
            inverse = np.linalg.inv(self._sylvester(np.convolve(self.model, r)))
        solution = inverse @ x
        k = solution[: n_p + 1]
        moved, x_slopes = np.zeros((parameters.size, n + 1)), np.zeros((parameters.size, n + 1))
        for i, slope in enumerate(of_poles):
            moved[i] = x_slopes[i] = np.convolve(slope, self.delay)
        for i, slope in enumerate(of_model):
            moved[m + i] = -np.convolve(np.convolve(self.model, slope), k)
        return Solved(x, r, k, solution[n_p + 1 :], x_slopes, (inverse @ moved.T)[n_p + 1 :].T)

    def values(self, parameters: Array, at: Frequencies) -> Array:
        """Square of the stacked gain at each frequency, for parameters of the poles of Q."""
        assert isinstance(at, SampledFrequencies)
        solved = self.solved(parameters)
        E, below = self._one_minus_q(solved, at)
        N = self.drive(solved, at, below)
        return np.asarray(at.Wu2 * np.abs(N) ** 2 + at.Wp2 * np.abs(E) ** 2)

    def values_and_slopes(self, parameters: Array, at: Frequencies) -> tuple[Array, Array]:
        """Square of the stacked gain at each frequency, and its derivatives by the parameters."""
        assert isinstance(at, SampledFrequencies)
        solved = self.solved(parameters)
        E, below = self._one_minus_q(solved, at)
        N = self.drive(solved, at, below)
        # dQ = (dl z b - Q dx) / x, and K S follows Q / Pd.
        of_N, of_E = at.Wu2 * np.conj(N), at.Wp2 * np.conj(E)
        outer_l = of_N * at.S0 * at.over - of_E * at.numerator
        outer_x = of_N * (N - at.plain) - of_E * (1.0 - E)
        value = at.Wu2 * np.abs(N) ** 2 + at.Wp2 * np.abs(E) ** 2
        return np.asarray(value), self.derivatives(solved, at, outer_l / below, outer_x / below)

    def drive(self, solved: Solved, at: SampledFrequencies, below: ComplexArray) -> ComplexArray:
        """Give K S, from noise of y to v, of what is solved, at frequencies where x is below."""
        above = at.powers[:, -solved.l.size :] @ solved.l
        return np.asarray(at.plain + at.S0 * above * at.over / below)

    def derivatives(
        self, solved: Solved, at: SampledFrequencies, of_l: ComplexArray, of_x: ComplexArray
    ) -> Array:
        """Twice the real part of ``of_l dl - of_x dx``, dl and dx of what is solved, at ``at``."""
        # Next to a pole of Q on the circle slopes overflow; a descent turns back there anyway.
        with np.errstate(over="ignore", invalid="ignore"):
            by_l = of_l[:, None] * (at.powers[:, -solved.l.size :] @ solved.l_slopes.T)
            by_x = of_x[:, None] * (at.powers @ solved.x_slopes.T)
            return np.asarray(2.0 * np.real(by_l - by_x))

    def poles(self, parameters: Array) -> ComplexArray:
        """Give the poles of Q that are searched, in the w-plane."""
        x = pole_parameters.polynomial(parameters[: self.order])[0]
        return np.asarray(np.roots(x) * self.scale, dtype=np.complex128)

    def parameters_of(self, poles: ComplexArray, free: ComplexArray | None = None) -> Array:
        """Give the parameters of stable poles and of free eigenvalues of the w-plane.

        Eigenvalues that are too fast are slowed, with the poles that cancel them.
        """
        if free is None:
            return super().parameters_of(poles)
        most = _FREE_SHARE * self.scale * float(np.exp(self.fastest))
        slowed = [np.asarray(each, dtype=complex).copy() for each in (poles, free)]
        for value in slowed[1][np.abs(slowed[1]) > most]:
            for each in slowed:
                each[each == value] = -most
        return super().parameters_of(*slowed)

    def internal_model(self, parameters: Array) -> InternalModel:
        """Give the internal model in continuous time with the eigenvalues that were free."""
        model, dt = self.problem.internal_model, self.problem.dt
        values = np.exp(parameters[self.order :])
        pairs = 2 * (self.free // 2)
        for a, b in zip(values[0:pairs:2], values[1:pairs:2], strict=True):
            roots = np.asarray(np.roots([1.0, a, b]), dtype=np.complex128)
            rates = np.log(from_w_plane(self.scale * roots)) / dt
            size, decay = float(np.sqrt(np.prod(rates).real)), float(rates.sum().real)
            A_d = np.array([[0.0, size], [-size, decay]])
            model = model + InternalModel(A_d, np.array([[1.0, 0.0]]))
        for c in values[pairs:]:
            rate = float(np.log(from_w_plane(np.array([-self.scale * c + 0.0j]))).real[0]) / dt
            model = model + InternalModel(np.array([[rate]]), np.array([[1.0]]))
        return model

    def gain_of(self, parameters: Array) -> Array:
        """Give the gain L that places the poles of Q as the parameters say.

        It is for the problem with the internal model of the same parameters.
        """
        return self.gain_in(self.problem.plant, parameters)

    def gain_in(self, system: LinearSystem, parameters: Array) -> Array:
        """Give the gain of the parameters for the plant in the coordinates of the system."""
        n_p, plant, solved = self.problem.plant.order, self.sampled, self.solved(parameters)
        model = sampled_model(self.internal_model(parameters), self.problem.dt)
        # z = 1 + sigma t.
        sigma, n_d = 2.0 * self.scale, model.order
        at_infinity = float(np.polyval(solved.x, 1.0 / self.scale))
        units = float(np.real(np.prod(1.0 - plant.poles))) / plant.gain
        size = 2.0**n_d * units / self.scale ** (plant.zeros.size + 1) / at_infinity
        low = mapped_polynomial(solved.l, self.scale) * size * sigma ** (1 - n_d)
        A_d = (model.A_d - np.eye(n_d)) / sigma
        M_d = injection(A_d, model.C_d, np.concatenate([[0.0], low]))
        now = float((model.C_d @ M_d)[0])
        A = (system.A - np.eye(n_p)) / sigma
        k = mapped_polynomial(solved.k, self.scale)
        k = k / k[0] + now * self._numerator_in_t(sigma)
        L_p = sigma * injection(A, system.C, k - np.real(np.poly(A)))
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


def _limit(fastest_pole: float | None, dt: float) -> float:
    """Limit of |s| for poles of Q: 1, half of Nyquist, or less."""
    if fastest_pole is None or 0.5 * fastest_pole * dt >= 0.25 * np.pi:
        return 1.0
    return float(np.tan(0.5 * fastest_pole * dt))


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
