"""The gain to be minimized, as a function of frequency and of the poles of Q.

With a the denominator and b the numerator of the plant and m the polynomial of the internal model,
every gain L gives ``1 - Q = m k / x`` and ``Q = l b / x``, where x is the polynomial of the
observer's poles and k (monic, degree of a) and l (degree below m) solve ``m k + l b = x``. Because
``T = 1 - S0 (1 - Q)`` with ``S0 = 1 / (1 + Pn C)``, the square of the stacked gain is
``|Wu (1 - S0 E)|^2 + |Wp E|^2`` with ``E = 1 - Q``, and ``|Wn K S|^2`` more where noise has a
weight, with ``K S = S0 (C + V)`` and ``V = Q / Pn = l a / x``. Polynomials are in units of
``scale``. Stable eigenvalues of the internal model may be left free: then m has a factor r whose
parameters follow those of x.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hyst.control.disturbance_observer import pole_parameters
from hyst.control.disturbance_observer.internal_model import InternalModel
from hyst.control.disturbance_observer.noise_gain import NoiseGain
from hyst.control.disturbance_observer.peaks import AROUND, find_peaks
from hyst.control.disturbance_observer.problem import ObserverProblem
from hyst.control.linear_system import LinearSystem
from hyst.control.zeros_and_poles import Points, ZerosAndPoles, zeros_and_poles

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_PER_DECADE = 24
_SLOWER, _FASTER = 100.0, 10.0  # than all poles and zeros of the problem


@dataclass(frozen=True)
class NoiseRow:
    """What the row of noise needs at each frequency.

    ``weight`` is |Wn S0|^2, ``controller`` C, ``denominator`` that of the plant over its gain.
    """

    weight: Array
    controller: ComplexArray
    denominator: Points


@dataclass(frozen=True)
class Frequencies:
    """Frequencies ``w`` with all that does not depend on the gain.

    ``Wu2`` and ``Wp2`` are squares of the weights, ``S0`` is the sensitivity; ``powers`` of s, the
    ``model`` polynomial and the ``numerator`` of the plant are in units of the scale; ``noise`` is
    None where noise has no weight.
    """

    w: Array
    Wu2: Array
    S0: ComplexArray
    Wp2: Array
    powers: ComplexArray
    model: Points
    numerator: Points
    noise: NoiseRow | None = None


@dataclass(frozen=True)
class Solved:
    """Coefficients of x, r, k and l, with x_slopes and l_slopes, derivatives by the parameters."""

    x: Array
    r: Array
    k: Array
    l: Array  # noqa: E741 (the letter of the equations)
    x_slopes: Array
    l_slopes: Array


class StackedGain:
    """Square of the stacked gain, and its gradient, for parameters of the poles of Q.

    Parameters are those of ``pole_parameters`` for x, then those of r: every point is stabilizing.

    Parameters
    ----------
    problem
        Plant, controller, weights and internal model.
    free
        Number of stable eigenvalues that the internal model has besides its own.
    fastest_pole
        No pole of Q may be faster, rad/s; None leaves them a decade above all of the problem.
    """

    def __init__(
        self, problem: ObserverProblem, free: int = 0, fastest_pole: float | None = None
    ) -> None:
        self.problem, self.free, self.fastest_pole = problem, free, fastest_pole
        self.order = problem.order + free
        self.plant = zeros_and_poles(problem.plant)
        self.Wu, self.Wp = zeros_and_poles(problem.Wu), zeros_and_poles(problem.Wp)
        self.Wn = None if problem.Wn is None else zeros_and_poles(problem.Wn)
        self.S0 = _sensitivity(problem)
        self.model_poles = np.linalg.eigvals(problem.internal_model.A_d).astype(complex)
        self.features = self._features()
        self.scale = float(np.exp(np.mean(np.log(np.abs(self.features)))))
        self.model = np.real(np.poly(self.model_poles / self.scale))
        # As a polynomial in s/scale; its size is kept in l, so a factor common to all is harmless.
        self.numerator = np.real(np.atleast_1d(np.poly(self.plant.zeros / self.scale)))
        # b of the plant is its monic numerator times this.
        self.size = self.plant.gain * self.scale ** (self.plant.zeros.size - self.plant.poles.size)
        self._fixed = None if free else np.linalg.inv(self._sylvester(self.model))
        self._latest: tuple[Array, Solved] | None = None
        self.grid = self.at(self._grid())
        self.fastest = np.inf if fastest_pole is None else np.log(fastest_pole / self.scale)
        self.lowest, self.highest = self._box()

    @cached_property
    def noise(self) -> NoiseGain:
        """The square of |Q / Pn|, what the observer makes of the sensor's noise in the drive."""
        return NoiseGain(self)

    def _features(self) -> ComplexArray:
        parts = [self.plant, self.Wu, self.Wp, self.S0]
        parts += [] if self.Wn is None else [self.Wn]
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
        slow = min(slow, self.fastest - np.log(_SLOWER))
        of_poles = pole_parameters.bounds(self.order, slow, min(fast, self.fastest + np.log(2.0)))
        of_model = pole_parameters.bounds(self.free, slow, fast)
        return (
            np.concatenate([of_poles[0], of_model[0]]),
            np.concatenate([of_poles[1], of_model[1]]),
        )

    def enlarged(self) -> StackedGain:
        """Give the same with one free eigenvalue more."""
        return StackedGain(self.problem, self.free + 1, self.fastest_pole)

    def rates(self) -> tuple[float, float]:
        """Give the ends of the band in which free eigenvalues may start, 1/s."""
        size = np.abs(self.features)
        return float(size.min()) / 3.0, 3.0 * float(size.max())

    def inside(self, parameters: Array) -> Array:
        """Take the parameters into their bounds, and poles to where none is too fast."""
        held = np.clip(parameters, self.lowest, self.highest)
        if np.isfinite(self.fastest):
            held[: self.order] = pole_parameters.slowed(held[: self.order], self.fastest)
        return held

    def _grid(self) -> Array:
        size = np.abs(self.features)
        low, high = np.log10(size.min() / 100.0), np.log10(size.max() * 100.0)
        even = np.logspace(low, high, int(_PER_DECADE * (high - low)) + 1)
        sharp = np.abs(self.features.imag)[:, None] + np.abs(self.features.real)[:, None] * AROUND
        return np.unique(np.concatenate([even, sharp[sharp > 10.0**low], size]))

    def at(self, w: Array) -> Frequencies:
        """Collect what does not depend on the gain at the frequencies w, rad/s."""
        s = 1j * w
        unit = s / self.scale
        S0 = self.S0.response(s)
        noise = None
        if self.Wn is not None:
            noise = NoiseRow(
                np.abs(self.Wn.response(s) * S0) ** 2,
                self.problem.controller.response(s)[:, 0, 0],
                np.prod(unit[:, None] - self.plant.poles / self.scale, axis=1) / self.size,
            )
        return Frequencies(
            w,
            np.abs(self.Wu.response(s)) ** 2,
            S0,
            np.abs(self.Wp.response(s)) ** 2,
            self.powers(unit),
            np.prod(unit[:, None] - self.model_poles / self.scale, axis=1),
            np.asarray(np.prod(unit[:, None] - self.plant.zeros / self.scale, axis=1)),
            noise,
        )

    def powers(self, unit: Points) -> ComplexArray:
        """Powers of s/scale, the highest first, (frequencies, order + 1)."""
        return np.asarray((unit[:, None] ** np.arange(self.order, -1, -1)).astype(complex))

    def _sylvester(self, model: Array) -> Array:
        """Matrix that takes (k, l) to the coefficients of m k + l b, highest power first."""
        n, n_p = self.order, self.problem.plant.order
        matrix = np.zeros((n + 1, n + 1))
        for i in range(n_p + 1):
            matrix[i : i + model.size, i] = model
        for i in range(n - n_p):
            start = n + 1 - self.numerator.size - (n - n_p - 1 - i)
            matrix[start : start + self.numerator.size, n_p + 1 + i] = self.numerator
        return matrix

    def solved(self, parameters: Array) -> Solved:
        """Give all polynomials, and their derivatives, at the parameters."""
        if self._latest is None or not np.array_equal(parameters, self._latest[0]):
            self._latest = (parameters.copy(), self._solve(parameters))
        return self._latest[1]

    def _solve(self, parameters: Array) -> Solved:
        n, n_p = self.order, self.problem.plant.order
        x, of_poles = pole_parameters.polynomial(parameters[:n])
        r, of_model = pole_parameters.polynomial(parameters[n:])
        inverse = self._fixed
        if inverse is None:
            inverse = np.linalg.inv(self._sylvester(np.convolve(self.model, r)))
        solution = inverse @ x
        k = solution[: n_p + 1]
        moved = np.zeros((parameters.size, n + 1))
        moved[:n] = of_poles
        for i, slope in enumerate(of_model):
            moved[n + i] = -np.convolve(np.convolve(self.model, slope), k)
        x_slopes = np.vstack([of_poles, np.zeros((self.free, n + 1))])
        return Solved(x, r, k, solution[n_p + 1 :], x_slopes, (inverse @ moved.T)[n_p + 1 :].T)

    def values(self, parameters: Array, at: Frequencies) -> Array:
        """Square of the stacked gain at each frequency, for parameters of the poles of Q."""
        solved = self.solved(parameters)
        E, below = self._one_minus_q(solved, at)
        value = at.Wu2 * np.abs(1.0 - at.S0 * E) ** 2 + at.Wp2 * np.abs(E) ** 2
        if at.noise is not None:
            V = at.powers[:, -solved.l.size :] @ solved.l * at.noise.denominator / below
            value = value + at.noise.weight * np.abs(at.noise.controller + V) ** 2
        return np.asarray(value)

    def values_and_slopes(self, parameters: Array, at: Frequencies) -> tuple[Array, Array]:
        """Square of the stacked gain at each frequency, and its derivatives by the parameters."""
        solved = self.solved(parameters)
        E, below = self._one_minus_q(solved, at)
        T = 1.0 - at.S0 * E
        outer = at.Wp2 * np.conj(E) - at.Wu2 * np.conj(T) * at.S0
        of_l = at.powers[:, -solved.l.size :] @ solved.l_slopes.T
        of_x = at.powers @ solved.x_slopes.T
        Q_slopes = of_l * at.numerator[:, None] - of_x * (1.0 - E)[:, None]
        value = at.Wu2 * np.abs(T) ** 2 + at.Wp2 * np.abs(E) ** 2
        # Next to a pole of Q on the axis slopes overflow; a descent turns back there anyway.
        with np.errstate(over="ignore", invalid="ignore"):
            derivatives = -2.0 * np.real((outer / below)[:, None] * Q_slopes)
            if at.noise is not None:
                V = at.powers[:, -solved.l.size :] @ solved.l * at.noise.denominator / below
                total = at.noise.controller + V
                value = value + at.noise.weight * np.abs(total) ** 2
                V_slopes = of_l * at.noise.denominator[:, None] - of_x * V[:, None]
                noisy = at.noise.weight * np.conj(total) / below
                derivatives = derivatives + 2.0 * np.real(noisy[:, None] * V_slopes)
        return np.asarray(value), np.asarray(derivatives)

    def _one_minus_q(self, solved: Solved, at: Frequencies) -> tuple[ComplexArray, ComplexArray]:
        model = at.model
        if self.free:
            model = model * (at.powers[:, -solved.r.size :] @ solved.r)
        below = self.below(solved, at.powers)
        return model * (at.powers[:, -solved.k.size :] @ solved.k) / below, below

    def below(self, solved: Solved, powers: ComplexArray) -> ComplexArray:
        """Values of the solved x by powers of s, kept from 0 next to a pole on the axis."""
        x = powers @ solved.x
        return np.where(np.abs(x) > 1e-60, x, 1e-60)

    def poles(self, parameters: Array) -> ComplexArray:
        """Give the poles of Q, 1/s."""
        return np.asarray(np.roots(self.solved(parameters).x) * self.scale, dtype=complex)

    def eigenvalues(self, parameters: Array) -> ComplexArray:
        """Give the free eigenvalues of the internal model, 1/s."""
        return np.asarray(np.roots(self.solved(parameters).r) * self.scale, dtype=complex)

    def peaks(self, parameters: Array, share: float = 0.9, rounds: int = 4) -> Array:
        """Frequencies of the local maxima that reach a share of the largest, highest first.

        Each is closed in on in so many rounds; parameters as for ``values``.
        """
        return find_peaks(self, parameters, self.poles(parameters), share, rounds)

    def parameters_of(self, poles: ComplexArray, free: ComplexArray | None = None) -> Array:
        """Give the parameters of stable poles and of free eigenvalues, 1/s."""
        of_x = pole_parameters.parameters_of(np.asarray(poles, dtype=complex) / self.scale)
        if free is None:
            return of_x
        of_r = pole_parameters.parameters_of(np.asarray(free, dtype=complex) / self.scale)
        return np.concatenate([of_x, of_r])

    def internal_model(self, parameters: Array) -> InternalModel:
        """Give the internal model with the eigenvalues that were free."""
        model = self.problem.internal_model
        values = np.exp(parameters[self.order :])
        pairs = 2 * (self.free // 2)
        for a, b in zip(values[0:pairs:2], values[1:pairs:2], strict=True):
            size = np.sqrt(b)
            A_d = self.scale * np.array([[0.0, size], [-size, -a]])
            model = model + InternalModel(A_d, np.array([[1.0, 0.0]]))
        for c in values[pairs:]:
            model = model + InternalModel(np.array([[-self.scale * c]]), np.array([[1.0]]))
        return model

    def gain_of(self, parameters: Array) -> Array:
        """Give the gain L that places the poles of Q as the parameters say.

        It is for the problem with the internal model of the same parameters.
        """
        model, solved = self.internal_model(parameters), self.solved(parameters)
        A, C = self.problem.plant.A / self.scale, self.problem.plant.C
        L_1 = self.scale * _injection(A, C, solved.k - np.real(np.poly(A)))
        L_2 = self.scale * _injection(
            model.A_d / self.scale, model.C_d, np.concatenate([[0.0], solved.l / self.size])
        )
        return np.concatenate([L_1, L_2])


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
