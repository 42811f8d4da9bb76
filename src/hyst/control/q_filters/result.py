"""A disturbance observer made of a Q-filter and the inverse of the plant, with what it achieves."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, final

import numpy as np

from hyst.control.linear_system import LinearSystem
from hyst.control.q_filters.certificate import QFilterCertificate
from hyst.control.q_filters.family import QFilter
from hyst.control.q_filters.loops import q_observer
from hyst.control.q_filters.problem import QFilterProblem


@final
@dataclass(frozen=True, eq=False)
class QFilterObserver:
    """The classical disturbance observer ``d_hat = Q (y / Pn - v)``.

    It has the members of ``DisturbanceObserver`` that a loop and a report need.

    Parameters
    ----------
    problem
        Plant, controller and weights it was designed for.
    filter
        Q.
    certificate
        Norms and poles, computed from the filter.
    family
        ``"textbook"`` or ``"free"``.
    steps
        What the search did.
    """

    problem: QFilterProblem
    filter: QFilter
    certificate: QFilterCertificate
    family: str
    steps: tuple[str, ...] = ()

    @property
    def gamma(self) -> float:
        """Exact H-infinity norm of [Wu T; Wp (1 - Q)]."""
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
            return (
                f"no {self.name} reaches gamma < 1; best found {self.gamma:.4g} at "
                f"{c.stacked_frequency:.4g} rad/s, limited by {c.limited_by}"
            )
        told = (
            f"gamma = {self.gamma:.4g} < 1 at {c.stacked_frequency:.4g} rad/s: stable for every "
            f"plant within Wu, {c.robust_stability_margin:.3g} times over"
        )
        if c.robust_performance < 1.0:
            return f"{told}, and what Wp asks for holds for each of them"
        return (
            f"{told}; what Wp asks for holds for the nominal plant, while the worst plant within "
            f"Wu may leave {c.worst_performance:.3g} times what Wp allows"
        )

    @property
    def name(self) -> str:
        """What it is called in a table: the formula of the textbook, or order and degree."""
        Q = self.filter
        if self.family == "textbook" and Q.relative_degree == Q.order:
            return "1/(tau s + 1)" + (f"^{Q.order}" if Q.order > 1 else "")
        kind = "filter" if self.family == "textbook" else "free filter"
        return f"{kind} of order {Q.order}, relative degree {Q.relative_degree}"

    @cached_property
    def observer(self) -> LinearSystem:
        """Inputs v and y, output the estimate of d, in continuous time; S1 eq. 35."""
        return q_observer(self.problem, self.filter)

    @property
    def Q(self) -> Any:
        """Q(s) as a ``control.TransferFunction``; its polynomials are in the certificate."""
        return self.filter.as_control()

    @property
    def tau(self) -> float | None:
        """Time constant, s; None if the filter has none of its own."""
        return self.filter.tau

    @property
    def plant(self) -> LinearSystem:
        """The nominal plant Pn."""
        return self.problem.plant

    @property
    def controller(self) -> LinearSystem:
        """The controller C."""
        return self.problem.controller

    def to_dict(self) -> dict[str, Any]:
        """Give filter, certificate and search as plain numbers, lists and texts."""
        return {
            "family": self.family,
            "name": self.name,
            "tau": self.tau,
            "gamma": self.gamma,
            "feasible": self.feasible,
            "message": self.message,
            "kept_zeros": [[z.real, z.imag] for z in self.problem.kept_zeros.tolist()],
            "steps": list(self.steps),
            "certificate": self.certificate.to_dict(),
        }

    def summary(self) -> str:
        """Say in words what was found."""
        c = self.certificate
        of_tau = "" if self.tau is None else f", tau = {self.tau:.6g} s"
        lines = [
            self.message,
            f"Q(s)           {self.name}{of_tau}",
            f"Wu T           {c.uncertainty_norm:.4f} at {c.uncertainty_frequency:.4g} rad/s",
            f"Wp (1 - Q)     {c.performance_norm:.4f} at {c.performance_frequency:.4g} rad/s",
            f"stacked        {c.stacked_norm:.4f} at {c.stacked_frequency:.4g} rad/s, limited by "
            f"{c.limited_by}",
            f"robust         {c.robust_performance:.4f} at {c.robust_performance_frequency:.4g} "
            f"rad/s; with the worst plant Wp (1 - Q) is {c.worst_performance:.4g}",
            f"noise to v     {c.noise_gain:.4g} in the loop at {c.noise_gain_frequency:.4g} rad/s; "
            f"Q/Pn {c.observer_noise_gain:.4g} at {c.observer_noise_gain_frequency:.4g} rad/s",
            _bandwidth(c.bandwidth),
        ]
        kept = self.problem.kept_zeros
        if kept.size:
            zeros = ", ".join(_complex(z) for z in kept if z.imag >= 0.0)
            lines.append(
                f"kept zeros     {zeros} 1/s: Q has these zeros of the plant, whose inverse would "
                "be unstable"
            )
        return "\n".join([*lines, *self.steps])


def _bandwidth(w: float) -> str:
    if np.isinf(w):
        return "bandwidth      |1 - Q| nowhere reaches 0.707"
    return f"bandwidth      {w / (2.0 * np.pi):.4g} Hz, where |1 - Q| first is 0.707"


def _complex(value: complex) -> str:
    if abs(value.imag) < 1e-9 * abs(value):
        return f"{value.real:+.4g}"
    return f"{value.real:+.4g} +- {abs(value.imag):.4g}j"
