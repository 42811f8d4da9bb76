"""What a sampled Q-filter is designed for: the plant as the block sees it, and what Q must keep."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.control.controller_parts import feedback_controller
from hyst.control.discretization import Method
from hyst.control.linear_system import LinearSystem
from hyst.control.q_filters.family import QFilter
from hyst.control.q_filters.realization import shared_realization
from hyst.control.sampled.block_loop import BlockLoop
from hyst.control.sampled.certificate import stable_weight
from hyst.control.sampled.plant import SampledPlant, sampled_plant
from hyst.control.tracking_controller import TrackingController
from hyst.control.zeros_and_poles import ZerosAndPoles, zeros_and_poles
from hyst.errors import InputError

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_CIRCLE = 1e-9  # nearer to the circle than this is on it


@dataclass(frozen=True)
class SampledQFilterProblem:
    """Sampled plant, controller and weights.

    ``sampled_q_filter_problem`` makes one from what a user has, and checks it.

    Parameters
    ----------
    plant
        As the block sees it, with hold and delay.
    controller
        C, continuous or sampled.
    Wu, Wp
        Weights, as in ``sampled_certificate``.
    method
        How a continuous controller is sampled.
    """

    plant: SampledPlant
    controller: LinearSystem
    Wu: LinearSystem
    Wp: LinearSystem
    method: Method

    @cached_property
    def factors(self) -> ZerosAndPoles:
        """Zeros, poles and gain of the sampled plant in the z plane."""
        return zeros_and_poles(self.plant.system)

    @property
    def relative_degree(self) -> int:
        """Samples from the drive to the first that it moves: delay, and one for the hold."""
        return int(self.factors.poles.size - self.factors.zeros.size)

    @cached_property
    def kept_zeros(self) -> ComplexArray:
        """Zeros that Q must have: those not inside the circle, and those on the left.

        The inverse of the former is unstable, that of the latter rings from sample to sample.
        """
        zeros = self.factors.zeros
        return np.asarray(zeros[(np.abs(zeros) >= 1.0 - _CIRCLE) | (zeros.real < 0.0)])

    @cached_property
    def inverted_zeros(self) -> ComplexArray:
        """The others, which become poles of Q/Pd."""
        zeros = self.factors.zeros
        return np.asarray(zeros[(np.abs(zeros) < 1.0 - _CIRCLE) & (zeros.real >= 0.0)])

    @cached_property
    def alone(self) -> BlockLoop:
        """The loop of the controller without observer."""
        block = TrackingController.from_continuous(
            self.controller, self.plant.dt, method=self.method
        )
        return BlockLoop(block, self.plant)

    def filter_of(self, lags: int, tau: float) -> QFilter:
        """Give the filter with so many lags of time constant tau, s.

        ``Q = [(1 - p) / (z - p)]^n b(z) / b(1) z^k``, p = exp(-dt/tau), b the zeros to keep, and
        k, which may be negative, so that no sample is lost: the relative degree is the plant's.
        """
        p = float(np.exp(-self.plant.dt / tau))
        kept, k = self.kept_zeros, lags - self.relative_degree - self.kept_zeros.size
        poles = np.concatenate([np.full(lags, p), np.zeros(max(-k, 0))]).astype(np.complex128)
        zeros = np.concatenate([kept, np.zeros(max(k, 0))])
        gain = (-np.expm1(-self.plant.dt / tau)) ** lags / float(np.prod(1.0 - kept).real)
        return QFilter(ZerosAndPoles(zeros, poles, gain), tau, self.plant.dt)

    def observer(self, Q: QFilter) -> LinearSystem:
        """Give ``d_hat = Q (y / Pd - v)``: inputs v and y, sampled."""
        plant = self.factors
        poles = np.concatenate([Q.factors.poles, self.inverted_zeros])
        own = Q.factors.zeros[self.kept_zeros.size :]
        from_v = -Q.factors.gain * _polynomial(
            np.concatenate([Q.factors.zeros, self.inverted_zeros])
        )
        from_y = Q.factors.gain / plant.gain * _polynomial(np.concatenate([own, plant.poles]))
        return shared_realization(poles, [from_v, from_y], dt=self.plant.dt)


def sampled_q_filter_problem(
    plant: Any,
    controller: Any,
    Wu: Any,
    Wp: Any,
    dt: float | None,
    delay: float = 0.0,
    method: Method = "tustin",
) -> SampledQFilterProblem:
    """Read and check what a sampled Q-filter is designed for.

    Parameters
    ----------
    plant, dt, delay
        As for ``sampled_plant``.
    controller, Wu, Wp, method
        As for ``design_q_filter``.

    Raises
    ------
    InputError
        If one cannot be read, a weight is unstable, the plant has a pole on the circle, gain 0 or a
        zero at 1, or the sampled controller does not stabilize it.
    """
    problem = SampledQFilterProblem(
        sampled_plant(plant, dt, delay),
        feedback_controller(controller),
        stable_weight(Wu, "Wu"),
        stable_weight(Wp, "Wp"),
        method,
    )
    poles = problem.plant.system.poles()
    if np.abs(poles).max(initial=0.0) >= 1.0 - _CIRCLE:
        worst = poles[np.argmax(np.abs(poles))]
        raise InputError(
            f"the plant is not stable, pole at z = {complex(worst):.4g}; stabilize it first"
        )
    if problem.factors.gain == 0.0:
        raise InputError(
            "the plant's gain is zero: its input does not reach its output; check B and C"
        )
    zeros = problem.factors.zeros
    if zeros.size and np.abs(zeros - 1.0).min() <= _CIRCLE:
        raise InputError(
            "the plant has a zero at z = 1, so it hides what is constant and Q(1) = 1 is out of "
            "reach; no Q-filter exists for it"
        )
    largest = float(np.abs(problem.alone.poles()).max(initial=0.0))
    if largest >= 1.0:
        raise InputError(
            f"the controller does not stabilize the plant at dt = {problem.plant.dt:.4g} s with "
            f"delay {problem.plant.delay:.4g} s, largest |z| {largest:.4g}; lower its gain or "
            "sample faster"
        )
    return problem


def _polynomial(roots: ComplexArray) -> Array:
    return np.real(np.atleast_1d(np.poly(roots)))
