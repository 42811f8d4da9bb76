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
    lower_bound_at_noise
        No observer of any order has a stacked norm below this with a noise gain sup |Q/Pn| of at
        most this one's: the other bound may take any. None if the loop is unstable.
    noise
        Standard deviation of the sensor's noise it was designed for; None if none was given.
    shortfall
        Which row fails, where, and what would have to change; empty if none does.
    """

    problem: ObserverProblem
    gain: Array
    certificate: Certificate
    lower_bound: float
    method: str
    steps: tuple[str, ...] = ()
    lower_bound_at_noise: float | None = None
    noise: float | None = None
    shortfall: str = ""

    @property
    def gamma(self) -> float:
        """Exact H-infinity norm of what was minimized.

        [Wu T; Wp (1 - Q)], eq. 36, with the row Wn K S where noise was given a weight; the norm of
        the first two alone is in the certificate.
        """
        return self.certificate.minimized_norm

    @property
    def feasible(self) -> bool:
        """Whether the weights are met, and the loop is stable, also around a perturbed plant.

        That is a stacked norm below 1, so that disturbances are rejected as Wp asks while the loop
        is stable for every plant within Wu, and a norm of Wn K S below 1 where noise was given a
        weight. A gamma below 1 has both.
        """
        c = self.certificate
        quiet = c.noise_norm is None or c.noise_norm < 1.0
        return c.stacked_norm < 1.0 and quiet and c.perturbed_stable is not False

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
        if c.stacked_norm < 1.0 and (c.noise_norm is None or c.noise_norm < 1.0):
            return (
                f"gamma = {self.gamma:.4g}{' < 1' * (self.gamma < 1.0)} at "
                f"{c.minimized_frequency:.4g} rad/s: stable for every plant within Wu, "
                f"{c.robust_stability_margin:.3g} times over{unstable}"
            )
        how = "found " if self.lower_bound < 1.0 else ""
        why = f"; {self.shortfall}" if self.shortfall else ""
        return (
            f"no gain {how}reaches gamma < 1; best found {self.gamma:.4g} at "
            f"{c.minimized_frequency:.4g} rad/s, limited by {c.limited_by}; {self._bounds()}"
            f"{why}{unstable}"
        )

    def _bounds(self) -> str:
        told = f"no observer of any order reaches below {self.lower_bound:.4g}"
        if self.lower_bound_at_noise is None:
            return told
        return (
            f"{told}, whatever its noise gain, nor below {self.lower_bound_at_noise:.4g} at the "
            f"{self.certificate.observer_noise_gain:.3g} of this one"
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
            "lower_bound_at_noise": self.lower_bound_at_noise,
            "noise": self.noise,
            "shortfall": self.shortfall,
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
            *self._noise_lines(),
            f"margin         Wu may grow {c.robust_stability_margin:.3f} times",
            f"Q(s)           order {c.Q_denominator.size - 1}, relative degree "
            f"{c.Q_relative_degree}, Q(0) = {c.Q_at_zero:.9g}",
            f"nominal loop   {'stable' if c.nominal_stable else 'UNSTABLE'}, slowest pole of the "
            f"observer {_complex(slowest)} 1/s, fastest {c.fastest_pole:.4g} rad/s",
        ]
        if c.perturbed_poles is not None:
            worst = c.perturbed_poles[np.argmax(c.perturbed_poles.real)]
            state = "stable" if c.perturbed_stable else "UNSTABLE"
            lines.append(f"perturbed loop {state}, rightmost pole {_complex(worst)} 1/s")
        return "\n".join([*lines, *self.steps])

    def _noise_lines(self) -> list[str]:
        """Say what the sensor's noise does, and what of it the lower bound would cost."""
        c = self.certificate
        lines = []
        if self.lower_bound_at_noise is not None:
            lines.append(f"bounds         {self._bounds()}")
        lines.append(
            f"noise gain     K S {c.noise_gain:.4g} at {c.noise_gain_frequency:.4g} rad/s, "
            f"without observer {c.controller_noise_gain:.4g}; Q/Pn {c.observer_noise_gain:.4g} at "
            f"{c.observer_noise_gain_frequency:.4g} rad/s"
        )
        if c.noise_norm is not None:
            lines.append(f"Wn K S         {c.noise_norm:.4f} at {c.noise_frequency:.4g} rad/s")
        if self.noise is not None:
            lines.append(
                f"drive jitter   at most {self.noise * c.noise_gain:.4g} for sensor noise of "
                f"{self.noise:.4g}"
            )
        return lines


def _complex(value: complex) -> str:
    if abs(value.imag) < 1e-9 * abs(value):
        return f"{value.real:+.4g}"
    return f"{value.real:+.4g} {'+' if value.imag > 0 else '-'} {abs(value.imag):.4g}j"
