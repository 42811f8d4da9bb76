"""Design of the Q-filter of a sampled plant: what runs is what is searched."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, final

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from hyst.checks.numbers import as_positive, whole_number
from hyst.control.discretization import Method
from hyst.control.linear_system import LinearSystem
from hyst.control.q_filters.family import LARGEST_ORDER, QFilter
from hyst.control.q_filters.sampled_problem import (
    SampledQFilterProblem,
    sampled_q_filter_problem,
)
from hyst.control.q_filters.search import TimeConstantSearch, cost_with_noise
from hyst.control.sampled.certificate import SampledCertificate, sampled_certificate
from hyst.control.sampled.folding import folded_uncertainty, weight_response
from hyst.control.tracking_controller import TrackingController
from hyst.control.zeros_and_poles import zeros_and_poles
from hyst.errors import InputError

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_FASTEST = 0.2  # of a sample: faster lags are none
_BEYOND = 30.0  # slower than all that is seen of the loop


@final
@dataclass(frozen=True, eq=False)
class SampledQFilterObserver:
    """The classical disturbance observer of a sampled plant, ``d_hat = Q (y / Pd - v)``.

    Parameters
    ----------
    problem
        Sampled plant, controller and weights it was designed for.
    filter
        Q(z).
    certificate
        Of the block with this observer, with hold, delay and all that folds down.
    steps
        What the search did.
    """

    problem: SampledQFilterProblem
    filter: QFilter
    certificate: SampledCertificate
    steps: tuple[str, ...] = ()

    @property
    def gamma(self) -> float:
        """Norm of [Wu T; Wp (1 - Q)] of the sampled loop, with aliases."""
        return self.certificate.stacked_norm

    @property
    def feasible(self) -> bool:
        """Whether gamma < 1 and the loop is stable."""
        return self.gamma < 1.0 and self.certificate.nominal_stable

    @property
    def message(self) -> str:
        """One sentence: what is proven, or what stands in the way."""
        c = self.certificate
        if not self.feasible:
            return f"no {self.name} reaches gamma < 1 at dt = {c.dt:.4g} s; best {self.gamma:.4g}"
        return (
            f"gamma = {self.gamma:.4g} < 1 at dt = {c.dt:.4g} s: the sampled loop is stable for "
            f"every plant within Wu, {c.robust_stability_margin:.3g} times over"
        )

    @property
    def name(self) -> str:
        """What it is called in a table."""
        lags = int((self.filter.factors.poles != 0.0).sum())
        return "sampled 1/(tau s + 1)" + (f"^{lags}" if lags > 1 else "")

    @property
    def tau(self) -> float | None:
        """Time constant, s."""
        return self.filter.tau

    @cached_property
    def observer(self) -> LinearSystem:
        """Inputs v and y, output the estimate of d, sampled."""
        return self.problem.observer(self.filter)

    @property
    def Q(self) -> Any:
        """Q(z) as a ``control.StateSpace``."""
        return self.filter.as_control()

    @property
    def block(self) -> TrackingController:
        """Controller and observer as a target runs them, without an inverse."""
        problem = self.problem
        return TrackingController.from_continuous(
            problem.controller, problem.plant.dt, observer=self.observer, method=problem.method
        )

    def to_dict(self) -> dict[str, Any]:
        """Give filter, certificate and search as plain numbers, lists and texts."""
        factors = self.filter.factors
        return {
            "name": self.name,
            "tau": self.tau,
            "gamma": self.gamma if np.isfinite(self.gamma) else "inf",
            "feasible": self.feasible,
            "message": self.message,
            "zeros": [[z.real, z.imag] for z in factors.zeros.tolist()],
            "poles": [[p.real, p.imag] for p in factors.poles.tolist()],
            "filter_gain": factors.gain,
            "steps": list(self.steps),
            "certificate": self.certificate.to_dict(),
        }

    def summary(self) -> str:
        """Say in words what was found."""
        c = self.certificate
        lines = [
            self.message,
            f"Q(z)           {self.name}, tau = {self.tau:.6g} s, of the plant's relative degree "
            f"{self.problem.relative_degree}",
            f"Wu T           {c.uncertainty_norm:.4f} at {c.uncertainty_frequency:.4g} rad/s",
            f"Wp (1 - Q)     {c.performance_norm:.4f} at {c.performance_frequency:.4g} rad/s",
            f"robust         {c.robust_performance:.4f} at {c.robust_performance_frequency:.4g} "
            "rad/s",
            f"noise to v     {c.noise_gain:.4g} in the loop at {c.noise_frequency:.4g} rad/s",
        ]
        kept = self.problem.kept_zeros
        if kept.size:
            zeros = ", ".join(f"{z:.4g}" for z in kept if z.imag >= 0.0)
            lines.append(
                f"kept zeros     {zeros}: Q has these zeros of the plant, whose inverse would be "
                "unstable or ring"
            )
        return "\n".join([*lines, *self.steps])


def design_sampled_q_filter(
    plant: Any,
    controller: Any,
    Wu: Any,
    Wp: Any,
    dt: float | None = None,
    *,
    order: int | None = None,
    delay: float = 0.0,
    method: Method = "tustin",
    most_noise: float | None = None,
) -> SampledQFilterObserver:
    r"""Find the Q-filter of a sampled plant that rejects most within a given uncertainty.

    ``Q = [(1 - p) / (z - p)]^n b(z) / b(1) z^k``, ``p = e^{-dt/tau}``: n lags, the zeros b of the
    plant that must not be inverted, and the plant's own delay. tau is the one of least stacked
    norm of the sampled loop, with hold, delay and the aliases of what Wu allows.

    Parameters
    ----------
    plant
        Nominal plant, continuous or sampled: as ``sampled_plant`` takes it; stable.
    controller
        C, in u = C (y_ref - y), continuous or sampled; stabilizes the sampled plant.
    Wu, Wp
        As in ``sampled_certificate``.
    dt
        Sample time, s; that of a sampled plant if left out.
    order
        Number of lags, n, 1 to 12; one above the relative degree of the continuous plant, or of
        what its sampling zeros tell, if left out.
    delay
        Of computation, s, as in ``sampled_plant``.
    method
        How a continuous controller is sampled.
    most_noise
        Bound on the largest |Q/Pd|; none if left out.

    Returns
    -------
    SampledQFilterObserver
        Also when gamma is above 1: ``feasible`` and ``message`` say so.
        ``TrackingController.from_continuous(controller, dt, observer=design)`` takes it as it is.

    Raises
    ------
    InputError
        If a system cannot be used, the sampled controller does not stabilize the plant, the order
        is out of range, or no filter keeps noise below its bound.

    Examples
    --------
    >>> Wu, Wp = ([1.0, 1.0], [1.0, 30.0]), ([0.3, 0.6], [1.0, 0.01])
    >>> plant, controller = ([10.0], [1.0, 10.0]), ([1.0], [1.0, 0.0])
    >>> found = design_sampled_q_filter(plant, controller, Wu, Wp, 0.01, delay=0.01)
    >>> found.name, found.filter.relative_degree, found.feasible
    ('sampled 1/(tau s + 1)^2', 2, True)
    """
    problem = sampled_q_filter_problem(plant, controller, Wu, Wp, dt, delay, method)
    lags = _lags(problem) if order is None else whole_number(order, "order", 1, LARGEST_ORDER)
    bound = None if most_noise is None else as_positive(most_noise, "most_noise", "a gain of Q/Pd")
    with threadpool_limits(1, user_api="blas"):
        curve = _Curve(problem, lags, bound)
        slowest = _BEYOND / float(curve.w[0])
        search = TimeConstantSearch(curve.costs, curve.cost, _FASTEST * problem.plant.dt, slowest)
        tau, cost = search.run()
        if bound is not None and cost > 1e6 * (1.0 - 1e-9):
            raise InputError(
                f"no filter of {lags} lags keeps |Q/Pd| below {bound:.4g}; at 0 it is 1/|Pd(1)| = "
                f"{curve.least_noise:.4g}, so allow more noise"
            )
        Q = problem.filter_of(lags, tau)
        block = TrackingController.from_continuous(
            problem.controller,
            problem.plant.dt,
            observer=problem.observer(Q),
            method=problem.method,
        )
        certificate = sampled_certificate(block, problem.plant, problem.Wu, problem.Wp)
    step = f"search         {search.evaluations} time constants, tau = {tau:.6g} s"
    return SampledQFilterObserver(problem, Q, certificate, (step,))


def _lags(problem: SampledQFilterProblem) -> int:
    """One above the relative degree in continuous time; sampling adds one zero less than that."""
    continuous = problem.plant.continuous
    if continuous is not None:
        factors = zeros_and_poles(continuous)
        return max(int(factors.poles.size - factors.zeros.size), 1) + 1
    return min(int(problem.kept_zeros.size) + 2, LARGEST_ORDER)


class _Curve:
    """The stacked gain over frequency, for many time constants at once."""

    def __init__(self, problem: SampledQFilterProblem, lags: int, most_noise: float | None) -> None:
        self.problem, self.lags, self.most_noise = problem, lags, most_noise
        loop = problem.alone
        self.w = loop.grid(problem.Wu, problem.Wp)
        values = loop.at(self.w)
        self.z = np.exp(1j * self.w * problem.plant.dt)
        self.Pd, self.S0, self.alone = values.Pd, values.S, values.N
        self.a = folded_uncertainty(problem.plant, problem.Wu, self.w)
        self.Wp = np.abs(weight_response(problem.Wp, self.w))
        at_one = problem.factors.response(np.ones(1, dtype=np.complex128))[0]
        self.least_noise = 1.0 / float(abs(at_one))

    def costs(self, taus: Array) -> Array:
        return np.array([self.cost(float(tau)) for tau in taus])

    def cost(self, tau: float) -> float:
        Q = self.problem.filter_of(self.lags, tau).response(self.z)
        through = Q / self.Pd
        uncertain = self.a * np.abs(self.alone + through * self.S0)
        norm = float(np.hypot(uncertain, self.Wp * np.abs(1.0 - Q)).max())
        # At frequency 0, which is not on the grid, it is least_noise for every tau.
        noise = max(float(np.abs(through).max()), self.least_noise)
        return cost_with_noise(norm, noise, self.most_noise)
