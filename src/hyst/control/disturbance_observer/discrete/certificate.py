"""What a gain of a sampled observer achieves, computed from the block that it makes."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.control.disturbance_observer.certificate import plain
from hyst.control.disturbance_observer.discrete.problem import SampledObserverProblem
from hyst.control.disturbance_observer.stacked_gain import feedback_matrix
from hyst.control.largest_value import largest
from hyst.control.linear_system import LinearSystem
from hyst.control.loop_poles import closed_loop_poles
from hyst.control.sampled.block_loop import BlockLoop
from hyst.control.sampled.certificate import SampledCertificate, sampled_certificate
from hyst.control.sampled.folding import folded_uncertainty, weight_response
from hyst.control.sampled.plant import SampledPlant
from hyst.control.tracking_controller import TrackingController
from hyst.control.zeros_and_poles import ZerosAndPoles, zeros_and_poles

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class SampledObserverCertificate:
    """What the gain L of a sampled observer achieves: the members of ``Certificate``, at samples.

    Frequencies in rad/s, at most pi/dt; poles are those of z. ``Wu T`` is ``a |K S|`` with all that
    folds down from above half the sample rate.

    Parameters
    ----------
    loop
        Norms of the block that the gain makes.
    limited_by
        ``"Wu T"``, ``"Wp (1 - Q)"`` or ``"Wn K S"``: the largest at the peak of what was minimized.
    Q_numerator, Q_denominator
        Polynomials in z, highest power first.
    Q_at_zero
        Q at z = 1, frequency 0.
    Q_relative_degree, plant_relative_degree
        Samples until Q, and until the plant, answers.
    observer_poles
        Poles of the observer and of Q.
    nominal_poles
        Poles of the whole loop around the nominal plant.
    perturbed_poles
        Poles of the whole loop around the given perturbed plant; None if none was given.
    perturbed_poles_without_observer
        The same of plant and controller alone.
    observer_noise_gain, observer_noise_gain_frequency
        sup |Q/Pd|, what the observer alone makes of the sensor's noise.
    controller_noise_gain
        sup |C S0|, of the loop without the observer.
    noise_norm, noise_frequency
        Norm of Wn K S; None where noise was given no weight.
    minimized_norm, minimized_frequency
        That of all rows; without Wn the stacked norm.
    """

    loop: SampledCertificate
    limited_by: str
    Q_numerator: Array
    Q_denominator: Array
    Q_at_zero: float
    Q_relative_degree: int
    plant_relative_degree: int
    observer_poles: ComplexArray
    nominal_poles: ComplexArray
    perturbed_poles: ComplexArray | None
    perturbed_poles_without_observer: ComplexArray | None
    observer_noise_gain: float
    observer_noise_gain_frequency: float
    controller_noise_gain: float
    noise_norm: float | None
    noise_frequency: float | None
    minimized_norm: float
    minimized_frequency: float

    @property
    def stacked_norm(self) -> float:
        """Largest root of the sum of the squares of both rows."""
        return self.loop.stacked_norm

    @property
    def stacked_frequency(self) -> float:
        """Where it is reached."""
        return self.loop.stacked_frequency

    @property
    def uncertainty_norm(self) -> float:
        """Largest Wu T: below 1 the sampled loop is stable for every plant within Wu."""
        return self.loop.uncertainty_norm

    @property
    def uncertainty_frequency(self) -> float:
        """Where it is reached."""
        return self.loop.uncertainty_frequency

    @property
    def performance_norm(self) -> float:
        """Largest Wp (1 - Q)."""
        return self.loop.performance_norm

    @property
    def performance_frequency(self) -> float:
        """Where it is reached."""
        return self.loop.performance_frequency

    @property
    def robust_stability_margin(self) -> float:
        """Factor by which Wu may grow before stability is no longer sure."""
        return self.loop.robust_stability_margin

    @property
    def noise_gain(self) -> float:
        """Largest gain from noise of the sensor to v."""
        return self.loop.noise_gain

    @property
    def noise_gain_frequency(self) -> float:
        """Where it is reached."""
        return self.loop.noise_frequency

    @property
    def fastest_pole(self) -> float:
        """Speed of the fastest pole of the block, rad/s; pi/dt is half the sample rate."""
        return self.loop.fastest_pole

    @property
    def nominal_stable(self) -> bool:
        """Whether the loop around the nominal plant is stable."""
        return bool(np.abs(self.nominal_poles).max() < 1.0)

    @property
    def perturbed_stable(self) -> bool | None:
        """Whether the loop around the perturbed plant is stable; None if none was given."""
        if self.perturbed_poles is None:
            return None
        return bool(np.abs(self.perturbed_poles).max() < 1.0)

    @property
    def robustly_stable(self) -> bool:
        """Whether the loop is stable for every plant within Wu."""
        return self.nominal_stable and self.uncertainty_norm < 1.0

    @property
    def proper(self) -> bool:
        """Whether Q / Pd can be realized."""
        return self.Q_relative_degree >= self.plant_relative_degree

    @property
    def unity_at_zero(self) -> bool:
        """Whether Q is 1 at frequency 0, to 1e-6."""
        return abs(self.Q_at_zero - 1.0) < 1e-6

    def to_dict(self) -> dict[str, Any]:
        """Give plain numbers and lists; poles as pairs of real and imaginary part, inf as text."""
        own = [name for name in self.__dataclass_fields__ if name != "loop"]
        own += ["nominal_stable", "perturbed_stable", "robustly_stable", "proper", "unity_at_zero"]
        given = self.loop.to_dict()
        given["robust_stability_margin"] = plain(self.robust_stability_margin)
        return given | {name: plain(getattr(self, name)) for name in own}

    def to_json(self) -> str:
        """Give the dictionary as JSON, each number with all its digits."""
        return json.dumps(self.to_dict(), indent=2, allow_nan=False)


def certify_sampled(
    problem: SampledObserverProblem, gain: Array, perturbed: SampledPlant | None = None
) -> SampledObserverCertificate:
    """Compute what the gain achieves: of the block with this gain in the loop of the problem.

    Parameters
    ----------
    problem
        Sampled plant and controller, weights and internal model.
    gain
        L, (order,).
    perturbed
        A plant to close the same loop around.
    """
    block = TrackingController.from_continuous(
        problem.controller, problem.dt, observer=problem.observer(gain)
    )
    loop = sampled_certificate(block, problem.sampled, problem.Wu, problem.Wp)
    Q, plant = _factored_q(problem, gain), zeros_and_poles(problem.plant)
    rows = _Rows(problem, gain)
    w = BlockLoop(block, problem.sampled).grid(problem.Wu, problem.Wp)
    through, at_through = largest(rows.through_observer, w)
    noise: tuple[float | None, float | None] = (None, None)
    whole = loop.stacked_norm, loop.stacked_frequency
    if problem.Wn is not None:
        noise, whole = largest(rows.noise, w), largest(rows.whole, w)
        if not loop.nominal_stable:
            noise = whole = np.inf, 0.0
    alone = None
    if perturbed is not None:
        alone = feedback_matrix(perturbed.system, problem.controller)
    return SampledObserverCertificate(
        loop=loop,
        limited_by=rows.largest_part(whole[1]),
        Q_numerator=np.real(Q.gain * np.atleast_1d(np.poly(Q.zeros))),
        Q_denominator=np.real(np.poly(Q.poles)),
        Q_at_zero=float(problem.q_filter(gain).response(np.ones(1, complex))[0, 0, 0].real),
        Q_relative_degree=Q.poles.size - Q.zeros.size,
        plant_relative_degree=plant.poles.size - plant.zeros.size,
        observer_poles=Q.poles,
        nominal_poles=loop.poles,
        perturbed_poles=None if perturbed is None else closed_loop_poles(perturbed.system, block),
        perturbed_poles_without_observer=None if alone is None else _poles(alone),
        observer_noise_gain=through,
        observer_noise_gain_frequency=at_through,
        controller_noise_gain=largest(rows.without_observer, w)[0],
        noise_norm=noise[0],
        noise_frequency=noise[1],
        minimized_norm=whole[0],
        minimized_frequency=whole[1],
    )


def _poles(matrix: Array) -> ComplexArray:
    return np.asarray(np.linalg.eigvals(matrix), dtype=np.complex128)


def _factored_q(problem: SampledObserverProblem, gain: Array) -> ZerosAndPoles:
    """Factor Q(z): its zeros are those of the plant, of z C_d (z - A_d)^-1 A_d^-1 L_d, and 0."""
    model, plant = problem.sampled_model, zeros_and_poles(problem.plant)
    L_d = np.asarray(gain, dtype=np.float64)[problem.plant.order :, None]
    M_d = np.asarray(np.linalg.solve(model.A_d, L_d), dtype=np.float64)
    branch = zeros_and_poles(LinearSystem(model.A_d, M_d, model.C_d, np.zeros((1, 1))))
    zeros = np.concatenate([plant.zeros, branch.zeros, np.zeros(1, complex)])
    return ZerosAndPoles(zeros, problem.q_filter(gain).poles(), plant.gain * branch.gain)


class _Rows:
    """Rows of what was minimized, from the responses of plant, controller and Q."""

    def __init__(self, problem: SampledObserverProblem, gain: Array) -> None:
        self.problem = problem
        self.systems = problem.plant, problem.controller, problem.q_filter(gain)

    def _values(self, w: Array) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        z = np.exp(1j * w * self.problem.dt)
        Pd, C, Q = (each.response(z)[:, 0, 0] for each in self.systems)
        return Pd, C, Q

    def through_observer(self, w: Array) -> Array:
        Pd, _, Q = self._values(w)
        return np.asarray(np.abs(Q / Pd))

    def without_observer(self, w: Array) -> Array:
        Pd, C, _ = self._values(w)
        return np.abs(C / (1.0 + C * Pd))

    def noise(self, w: Array) -> Array:
        return np.asarray(self._all(w)[2])

    def whole(self, w: Array) -> Array:
        return np.asarray(np.sqrt((self._all(w) ** 2).sum(axis=0)))

    def largest_part(self, frequency: float) -> str:
        nyquist = np.pi / self.problem.dt
        w = np.array([frequency if 0.0 < frequency <= nyquist else 1e-6 * nyquist])
        return ("Wu T", "Wp (1 - Q)", "Wn K S")[int(np.argmax(self._all(w)[:, 0]))]

    def _all(self, w: Array) -> Array:
        p, (Pd, C, Q) = self.problem, self._values(w)
        drive = np.abs((C + Q / Pd) / (1.0 + C * Pd))
        Wn = 0.0 if p.Wn is None else np.abs(weight_response(p.Wn, w))
        return np.array(
            [
                folded_uncertainty(p.sampled, p.Wu, w) * drive,
                np.abs(weight_response(p.Wp, w) * (1.0 - Q)),
                Wn * drive,
            ]
        )
