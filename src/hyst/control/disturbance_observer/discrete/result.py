"""A sampled disturbance observer that was designed, with what it achieves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from hyst.control.disturbance_observer.discrete.certificate import SampledObserverCertificate
from hyst.control.disturbance_observer.discrete.problem import SampledObserverProblem
from hyst.control.disturbance_observer.result import DisturbanceObserver
from hyst.control.linear_system import transfer_function_of


@dataclass(frozen=True)
class SampledDisturbanceObserver(DisturbanceObserver):
    """A disturbance observer designed in discrete time: its gain, and a certificate from it.

    The members are those of ``DisturbanceObserver``, at samples: ``observer``, ``plant`` and
    ``controller`` are sampled, poles are those of z, and the certificate is of the block that runs.

    Parameters
    ----------
    problem, gain, certificate, lower_bound, method, steps
        As there; L is of the observer that predicts, whose estimate the sample at hand corrects.
    lower_bound_at_noise, noise, shortfall
        As there, but no bound at the noise gain is known here: None.
    """

    problem: SampledObserverProblem
    certificate: SampledObserverCertificate  # type: ignore[assignment]

    @property
    def dt(self) -> float:
        """Sample time, s."""
        return self.problem.dt

    @property
    def delay(self) -> float:
        """Delay of computation the design is for, s."""
        return self.problem.sampled.delay

    @property
    def message(self) -> str:
        """One sentence: whether the loop is safe, or what stands in the way."""
        c = self.certificate
        unstable = self._unstable()
        if c.stacked_norm < 1.0 and (c.noise_norm is None or c.noise_norm < 1.0):
            return (
                f"gamma = {self.gamma:.4g}{' < 1' * (self.gamma < 1.0)} at "
                f"{c.minimized_frequency:.4g} rad/s: the sampled loop is stable for every plant "
                f"within Wu, {c.robust_stability_margin:.3g} times over{unstable}"
            )
        return (
            f"no gain {'found ' if self.lower_bound < 1.0 else ''}reaches gamma < 1 at dt = "
            f"{self.dt:.4g} s and {self.delay:.4g} s of delay; best found {self.gamma:.4g} at "
            f"{c.minimized_frequency:.4g} rad/s, limited by {c.limited_by}; no observer of any "
            f"order reaches below {self.lower_bound:.4g}; {self.shortfall}{unstable}"
        )

    def _unstable(self) -> str:
        c = self.certificate
        if c.perturbed_stable is not False or c.perturbed_poles is None:
            return ""
        pole = c.perturbed_poles[np.argmax(np.abs(c.perturbed_poles))]
        text = f"; the loop around the perturbed plant is UNSTABLE, pole at z = {pole:.4g}"
        alone = c.perturbed_poles_without_observer
        if alone is not None and np.abs(alone).max() >= 1.0:
            text += ", and so it is without the observer: change the controller"
        return text

    @property
    def Q(self) -> Any:
        """Q(z) as a ``control.TransferFunction``; its polynomials are in the certificate."""
        c = self.certificate
        return transfer_function_of(c.Q_numerator, c.Q_denominator, self.dt)

    def to_dict(self) -> dict[str, Any]:
        """Give gain, certificate, bound and search as plain numbers, lists and texts."""
        return super().to_dict() | {"dt": self.dt, "delay": self.delay}

    def summary(self) -> str:
        """Say in words what was found."""
        c = self.certificate
        slowest = c.observer_poles[np.argmax(np.abs(c.observer_poles))]
        lines = [
            self.message,
            f"sampled        every {self.dt:.4g} s, {self.delay:.4g} s of delay, "
            f"{self.plant.order} states of the plant with it",
            "gain L         " + ", ".join(f"{each:.6g}" for each in self.gain),
            f"Wu T           {c.uncertainty_norm:.4f} at {c.uncertainty_frequency:.4g} rad/s, "
            "aliases folded",
            f"Wp (1 - Q)     {c.performance_norm:.4f} at {c.performance_frequency:.4g} rad/s",
            f"stacked        {c.stacked_norm:.4f} at {c.stacked_frequency:.4g} rad/s, "
            f"limited by {c.limited_by}; lower bound {self.lower_bound:.4f}",
            f"margin         Wu may grow {c.robust_stability_margin:.3f} times",
            *self._noise_lines(),
            f"white noise    {c.loop.noise_rms:.4g} times its standard deviation in v",
            f"Q(z)           order {c.Q_denominator.size - 1}, relative degree "
            f"{c.Q_relative_degree}, Q(1) = {c.Q_at_zero:.9g}",
            f"nominal loop   {'stable' if c.nominal_stable else 'UNSTABLE'}, slowest pole of the "
            f"observer z = {slowest:.6g}",
        ]
        if c.perturbed_poles is not None:
            worst = c.perturbed_poles[np.argmax(np.abs(c.perturbed_poles))]
            state = "stable" if c.perturbed_stable else "UNSTABLE"
            lines.append(f"perturbed loop {state}, largest pole z = {worst:.6g}")
        return "\n".join([*lines, *self.steps])
