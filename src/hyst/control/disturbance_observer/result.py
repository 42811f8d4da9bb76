"""A disturbance observer that was designed, with what it achieves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.control.disturbance_observer.certificate import Certificate
from hyst.control.disturbance_observer.internal_model import InternalModel
from hyst.control.disturbance_observer.problem import ObserverProblem
from hyst.control.linear_system import LinearSystem, transfer_function_of

Array = NDArray[np.float64]


@dataclass(frozen=True)
class DisturbanceObserver:
    """A disturbance observer: its gain, and a certificate computed from that gain.

    Parameters
    ----------
    problem
        Plant, controller, weights and internal model it was designed for.
    gain
        L, (n_p + n_d,): first for the states of ``plant``, then for those of the internal model.
        A transfer function gets a companion form: up to order 2 that of the paper, whose input
        drives the first state, above it the one whose output is the first state.
    certificate
        Norms, poles and Q(s), computed from the gain.
    lower_bound
        No observer of any order has a stacked norm below this.
    method
        ``"descent"``, ``"slpmm"`` or ``"slpmm+descent"``.
    steps
        What the search did: a line for each stage, with the norm it reached.
    """

    problem: ObserverProblem
    gain: Array
    certificate: Certificate
    lower_bound: float
    method: str
    steps: tuple[str, ...] = ()

    @property
    def gamma(self) -> float:
        """Exact H-infinity norm of [Wu T; Wp (1 - Q)]."""
        return self.certificate.stacked_norm

    @property
    def feasible(self) -> bool:
        """Whether gamma < 1 and the loop is stable, also around a perturbed plant if one is given.

        Then disturbances are rejected as Wp asks, for every plant within Wu.
        """
        return self.gamma < 1.0 and self.certificate.perturbed_stable is not False

    @property
    def message(self) -> str:
        """One sentence: whether the loop is safe, or what stands in the way."""
        c = self.certificate
        unstable = ""
        if c.perturbed_stable is False and c.perturbed_poles is not None:
            pole = c.perturbed_poles[np.argmax(c.perturbed_poles.real)]
            unstable = (
                f"; the loop around the perturbed plant is UNSTABLE, pole at {_complex(pole)} 1/s"
            )
            alone = c.perturbed_poles_without_observer
            if alone is not None and alone.real.max() >= 0.0:
                pole = alone[np.argmax(alone.real)]
                unstable += (
                    f", and so it is without the observer, pole at {_complex(pole)} 1/s: change "
                    "the controller"
                )
        if self.gamma < 1.0:
            return (
                f"gamma = {self.gamma:.4g} < 1 at {c.stacked_frequency:.4g} rad/s: stable for "
                f"every plant within Wu, {c.robust_stability_margin:.3g} times over{unstable}"
            )
        how = "found " if self.lower_bound < 1.0 else ""
        return (
            f"no gain {how}reaches gamma < 1; best found {self.gamma:.4g} at "
            f"{c.stacked_frequency:.4g} rad/s, limited by {c.limited_by}; no observer of any order "
            f"reaches below {self.lower_bound:.4g}{unstable}"
        )

    @property
    def observer(self) -> LinearSystem:
        """The observer of eq. 32 in continuous time: from v and y to the estimate of d.

        Its first input v is that of the inverse, the command after the estimate was taken off.
        """
        return self.problem.observer(self.gain)

    @property
    def Q(self) -> Any:
        """Q(s) as a ``control.TransferFunction``; its polynomials are in the certificate."""
        return transfer_function_of(self.certificate.Q_numerator, self.certificate.Q_denominator)

    @property
    def plant(self) -> LinearSystem:
        """The nominal plant Pn."""
        return self.problem.plant

    @property
    def controller(self) -> LinearSystem:
        """The controller C."""
        return self.problem.controller

    @property
    def internal_model(self) -> InternalModel:
        """The model of the disturbance."""
        return self.problem.internal_model

    def to_dict(self) -> dict[str, Any]:
        """Give gain, certificate, bound and search as plain numbers, lists and texts."""
        return {
            "gain": [float(each) for each in self.gain],
            "gamma": self.gamma if np.isfinite(self.gamma) else "inf",
            "feasible": self.feasible,
            "message": self.message,
            "lower_bound": self.lower_bound,
            "method": self.method,
            "steps": list(self.steps),
            "certificate": self.certificate.to_dict(),
        }

    def summary(self) -> str:
        """Say in words what was found."""
        c = self.certificate
        slowest = c.observer_poles[np.argmax(c.observer_poles.real)]
        lines = [
            self.message,
            "gain L         " + ", ".join(f"{each:.6g}" for each in self.gain),
            f"Wu T           {c.uncertainty_norm:.4f} at {c.uncertainty_frequency:.4g} rad/s",
            f"Wp (1 - Q)     {c.performance_norm:.4f} at {c.performance_frequency:.4g} rad/s",
            f"stacked        {c.stacked_norm:.4f} at {c.stacked_frequency:.4g} rad/s, "
            f"limited by {c.limited_by}; lower bound {self.lower_bound:.4f}",
            f"margin         Wu may grow {c.robust_stability_margin:.3f} times",
            f"Q(s)           order {c.Q_denominator.size - 1}, relative degree "
            f"{c.Q_relative_degree}, Q(0) = {c.Q_at_zero:.9g}",
            f"nominal loop   {'stable' if c.nominal_stable else 'UNSTABLE'}, slowest pole of the "
            f"observer {_complex(slowest)} 1/s",
        ]
        if c.perturbed_poles is not None:
            worst = c.perturbed_poles[np.argmax(c.perturbed_poles.real)]
            state = "stable" if c.perturbed_stable else "UNSTABLE"
            lines.append(f"perturbed loop {state}, rightmost pole {_complex(worst)} 1/s")
        return "\n".join([*lines, *self.steps])


def _complex(value: complex) -> str:
    if abs(value.imag) < 1e-9 * abs(value):
        return f"{value.real:+.4g}"
    return f"{value.real:+.4g} {'+' if value.imag > 0 else '-'} {abs(value.imag):.4g}j"
