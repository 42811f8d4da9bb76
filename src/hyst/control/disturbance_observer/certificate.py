"""What a gain achieves, computed from the gain alone: nothing here is taken from a solver."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.control.disturbance_observer.noise_loop import (
    all_rows,
    noise_through_observer,
    noise_to_drive,
    noise_without_observer,
)
from hyst.control.disturbance_observer.problem import ObserverProblem
from hyst.control.disturbance_observer.stacked_gain import feedback_matrix
from hyst.control.infinity_norm import hinf_norm
from hyst.control.linear_system import LinearSystem
from hyst.control.zeros_and_poles import ZerosAndPoles, zeros_and_poles

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class Certificate:
    """What a gain L achieves, each number by a computation of its own.

    Frequencies in rad/s, poles in 1/s.

    Parameters
    ----------
    stacked_norm, stacked_frequency
        H-infinity norm of [Wu T; Wp (1 - Q)], eq. 36, and where it is reached.
    uncertainty_norm, uncertainty_frequency
        Those of Wu T, eq. 26: below 1 the loop stays stable for every plant within Wu.
    performance_norm, performance_frequency
        Those of Wp (1 - Q), eq. 27.
    limited_by
        ``"Wu T"``, ``"Wp (1 - Q)"`` or ``"Wn K S"``: the largest at the peak of what was minimized.
    robust_stability_margin
        Factor by which Wu may grow before stability is no longer sure, 1 / uncertainty_norm.
    Q_numerator, Q_denominator
        Polynomials in s, highest power first.
    Q_at_zero
        Q(0); 1 as (Q2) wants.
    Q_relative_degree, plant_relative_degree
        The first at least the second, as (Q1) wants.
    observer_poles
        Poles of the observer and of Q.
    nominal_poles
        Poles of the whole loop around the nominal plant.
    perturbed_poles
        Poles of the whole loop around the given perturbed plant; None if none was given.
    perturbed_poles_without_observer
        The same of plant and controller alone: an unstable one is the controller's doing.
    noise_gain, noise_gain_frequency
        sup |K S|, the largest gain from sensor noise to the drive, with K the controller and the
        observer together: noise of standard deviation 1 makes at most that in v.
    observer_noise_gain, observer_noise_gain_frequency
        sup |Q/Pn|, what the observer alone makes of it.
    controller_noise_gain
        sup |C S0|, of the loop without the observer.
    noise_norm, noise_frequency
        H-infinity norm of Wn K S; None where noise was given no weight.
    minimized_norm, minimized_frequency
        That of all rows, [Wu T; Wp (1 - Q); Wn K S]; without Wn the stacked norm.
    """

    stacked_norm: float
    stacked_frequency: float
    uncertainty_norm: float
    uncertainty_frequency: float
    performance_norm: float
    performance_frequency: float
    limited_by: str
    robust_stability_margin: float
    Q_numerator: Array
    Q_denominator: Array
    Q_at_zero: float
    Q_relative_degree: int
    plant_relative_degree: int
    observer_poles: ComplexArray
    nominal_poles: ComplexArray
    perturbed_poles: ComplexArray | None
    perturbed_poles_without_observer: ComplexArray | None
    noise_gain: float
    noise_gain_frequency: float
    observer_noise_gain: float
    observer_noise_gain_frequency: float
    controller_noise_gain: float
    noise_norm: float | None
    noise_frequency: float | None
    minimized_norm: float
    minimized_frequency: float

    @property
    def nominal_stable(self) -> bool:
        """Whether the loop around the nominal plant is stable."""
        return bool(self.nominal_poles.real.max() < 0.0)

    @property
    def perturbed_stable(self) -> bool | None:
        """Whether the loop around the perturbed plant is stable; None if none was given."""
        if self.perturbed_poles is None:
            return None
        return bool(self.perturbed_poles.real.max() < 0.0)

    @property
    def fastest_pole(self) -> float:
        """Size of the fastest pole of the observer, rad/s; a block samples above twice that."""
        return float(np.abs(self.observer_poles).max())

    @property
    def robustly_stable(self) -> bool:
        """(Q3): whether the loop is stable for every plant within Wu, eq. 26."""
        return self.nominal_stable and self.uncertainty_norm < 1.0

    @property
    def proper(self) -> bool:
        """(Q1): whether Q/Pn can be realized."""
        return self.Q_relative_degree >= self.plant_relative_degree

    @property
    def unity_at_zero(self) -> bool:
        """(Q2): whether Q(0) = 1, to 1e-6."""
        return abs(self.Q_at_zero - 1.0) < 1e-6

    def to_dict(self) -> dict[str, Any]:
        """Give plain numbers and lists; poles as pairs of real and imaginary part, inf as text."""
        given: dict[str, Any] = {
            name: plain(getattr(self, name)) for name in self.__dataclass_fields__
        }
        for name in (
            "fastest_pole",
            "nominal_stable",
            "perturbed_stable",
            "robustly_stable",
            "proper",
            "unity_at_zero",
        ):
            given[name] = getattr(self, name)
        return given

    def to_json(self) -> str:
        """Give the dictionary as JSON, each number with all its digits."""
        return json.dumps(self.to_dict(), indent=2, allow_nan=False)


def certify(
    problem: ObserverProblem, gain: Array, perturbed_plant: LinearSystem | None = None
) -> Certificate:
    """Compute what the gain achieves in the loop of the problem.

    Parameters
    ----------
    problem
        Plant, controller, weights and internal model.
    gain
        L, (order,).
    perturbed_plant
        A plant to close the same loop around.
    """
    closed = weighted_loop(problem, gain)
    stacked, at = _checked_norm(closed)
    uncertain, at_uncertain = _checked_norm(_output(closed, 0))
    performance, at_performance = _checked_norm(_output(closed, 1))
    plant = zeros_and_poles(problem.plant)
    Q = _factored_q(problem, gain, plant)
    noise, at_noise = _checked_norm(noise_to_drive(problem, gain))
    through, at_through = _checked_norm(noise_through_observer(problem, gain))
    rows, row, at_row, whole, at_whole = None, None, None, stacked, at
    if problem.Wn is not None:
        rows = all_rows(problem, gain)
        row, at_row = _checked_norm(_output(rows, 2))
        whole, at_whole = _checked_norm(rows)
    return Certificate(
        stacked_norm=stacked,
        stacked_frequency=at,
        uncertainty_norm=uncertain,
        uncertainty_frequency=at_uncertain,
        performance_norm=performance,
        performance_frequency=at_performance,
        limited_by=_largest_part(closed if rows is None else rows, at_whole),
        robust_stability_margin=1.0 / uncertain if uncertain > 0.0 else np.inf,
        Q_numerator=np.real(Q.gain * np.atleast_1d(np.poly(Q.zeros))),
        Q_denominator=np.real(np.poly(Q.poles)),
        Q_at_zero=float(problem.q_filter(gain).response(np.zeros(1, complex))[0, 0, 0].real),
        Q_relative_degree=Q.poles.size - Q.zeros.size,
        plant_relative_degree=plant.poles.size - plant.zeros.size,
        observer_poles=Q.poles,
        nominal_poles=loop(problem, gain, problem.plant).poles(),
        perturbed_poles=(
            None if perturbed_plant is None else loop(problem, gain, perturbed_plant).poles()
        ),
        perturbed_poles_without_observer=(
            None
            if perturbed_plant is None
            else np.linalg.eigvals(feedback_matrix(perturbed_plant, problem.controller)).astype(
                complex
            )
        ),
        noise_gain=noise,
        noise_gain_frequency=at_noise,
        observer_noise_gain=through,
        observer_noise_gain_frequency=at_through,
        controller_noise_gain=_checked_norm(noise_without_observer(problem))[0],
        noise_norm=row,
        noise_frequency=at_row,
        minimized_norm=whole,
        minimized_frequency=at_whole,
    )


def _factored_q(problem: ObserverProblem, gain: Array, plant: ZerosAndPoles) -> ZerosAndPoles:
    """Factor Q: its zeros are those of the plant and of C_d (s - A_d)^-1 L_2."""
    model = problem.internal_model
    L_2 = np.asarray(gain)[problem.plant.order :, None]
    branch = zeros_and_poles(LinearSystem(model.A_d, L_2, model.C_d, np.zeros((1, 1))))
    return ZerosAndPoles(
        np.concatenate([plant.zeros, branch.zeros]),
        problem.q_filter(gain).poles(),
        plant.gain * branch.gain,
    )


def loop(problem: ObserverProblem, gain: Array, plant: LinearSystem) -> LinearSystem:
    """Close the loop of Fig. 3: from d, outputs v, the estimate of d and y.

    States are those of plant, controller and observer; the reference and the noise are 0. The
    controller and the observer, with this gain, are those of the problem, the plant is any.
    """
    controller, observer = problem.controller, problem.observer(gain)
    n, n_c, n_o = plant.order, controller.order, observer.order
    # v = u - d_hat with u = C_c x_c - D_c y; the plant's own feedthrough makes y depend on v.
    share = 1.0 / (1.0 + plant.D[0, 0] * controller.D[0, 0])
    y_x = share * np.hstack([plant.C, plant.D @ controller.C, -plant.D @ observer.C])
    y_d = share * plant.D
    v_x = np.hstack([np.zeros((1, n)), controller.C, -observer.C]) - controller.D @ y_x
    v_d = -controller.D @ y_d
    A = np.zeros((n + n_c + n_o, n + n_c + n_o))
    A[:n, :n], A[n : n + n_c, n : n + n_c] = plant.A, controller.A
    A[n + n_c :, n + n_c :] = observer.A
    into_v = np.vstack([plant.B, np.zeros((n_c, 1)), observer.B[:, :1]])
    into_y = np.vstack([np.zeros((n, 1)), -controller.B, observer.B[:, 1:]])
    into_d = np.vstack([plant.B, np.zeros((n_c + n_o, 1))])
    estimate = np.hstack([np.zeros((1, n + n_c)), observer.C])
    return LinearSystem(
        A + into_v @ v_x + into_y @ y_x,
        into_d + into_v @ v_d + into_y @ y_d,
        np.vstack([v_x, estimate, y_x]),
        np.vstack([v_d, np.zeros((1, 1)), y_d]),
    )


def weighted_loop(problem: ObserverProblem, gain: Array) -> LinearSystem:
    """Give [Wu T; Wp (1 - Q)] as a system with input d, first output signed as v.

    The loop is that of the problem, with this gain.
    """
    inner, Wu, Wp = loop(problem, gain, problem.plant), problem.Wu, problem.Wp
    v, v_d = inner.C[:1], inner.D[:1]
    error, error_d = -inner.C[1:2], np.ones((1, 1))
    n, n_u, n_w = inner.order, Wu.order, Wp.order
    A = np.zeros((n + n_u + n_w, n + n_u + n_w))
    A[:n, :n], A[n : n + n_u, n : n + n_u], A[n + n_u :, n + n_u :] = inner.A, Wu.A, Wp.A
    A[n : n + n_u, :n], A[n + n_u :, :n] = Wu.B @ v, Wp.B @ error
    B = np.vstack([inner.B, Wu.B @ v_d, Wp.B @ error_d])
    C = np.zeros((2, n + n_u + n_w))
    C[0, :n], C[0, n : n + n_u] = (Wu.D @ v)[0], Wu.C[0]
    C[1, :n], C[1, n + n_u :] = (Wp.D @ error)[0], Wp.C[0]
    return LinearSystem(A, B, C, np.vstack([Wu.D @ v_d, Wp.D @ error_d]))


def _checked_norm(system: LinearSystem) -> tuple[float, float]:
    """Give the norm by the Hamiltonian, unless a grid of frequencies shows a higher peak.

    That happens where poles are so far apart that eigenvalues lose their digits.
    """
    norm, frequency = hinf_norm(system)
    if not np.isfinite(norm):
        return norm, frequency
    poles = system.poles()
    size = np.abs(poles)[np.abs(poles) > 0.0]
    around = np.abs(poles.imag)[:, None] + np.abs(poles.real)[:, None] * np.linspace(-3, 3, 25)
    w = np.concatenate(
        [np.geomspace(0.01 * size.min(), 100.0 * size.max(), 400), np.abs(around).ravel()]
    )
    for _ in range(4):
        gains = np.linalg.norm(system.response(1j * w), axis=(1, 2))
        top = int(np.argmax(gains))
        if gains[top] <= norm * (1.0 + 1e-9):
            break
        norm, frequency = float(gains[top]), float(w[top])
        near = np.sort(np.abs(w - frequency))
        width = float(near[near > 0.0][:1].max(initial=0.0)) or 1e-6 * frequency
        w = frequency + width * np.linspace(-1.0, 1.0, 41)
    return norm, frequency


def _output(system: LinearSystem, i: int) -> LinearSystem:
    return LinearSystem(system.A, system.B, system.C[i : i + 1], system.D[i : i + 1])


def _largest_part(closed: LinearSystem, frequency: float) -> str:
    value = closed.D if np.isinf(frequency) else closed.response(np.array([1j * frequency]))[0]
    return ("Wu T", "Wp (1 - Q)", "Wn K S")[int(np.argmax(np.abs(value[:, 0])))]


def plain(value: Any) -> Any:
    """Give numbers and lists of them that JSON can hold."""
    if isinstance(value, np.ndarray) and np.iscomplexobj(value):
        return [[float(each.real), float(each.imag)] for each in value]
    if isinstance(value, np.ndarray):
        return [plain(float(each)) for each in value]
    if isinstance(value, float) and np.isinf(value):
        return "inf"
    return value
