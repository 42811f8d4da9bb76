"""What a Hammerstein identification gives back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.family import Family
from hyst.identification.families.hammerstein.markov import MarkovParameters
from hyst.identification.families.hammerstein.yardstick import Yardstick
from hyst.identification.families.hammerstein.yardstick_told import in_one_line
from hyst.identification.result.identified import Identified
from hyst.models import LinearDynamics, StableInverse
from hyst.operators import Operator

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Loop:
    """Nonparametric loop: the input, and the signal behind the hysteresis estimated from y.

    Parameters
    ----------
    u, v
        Shape (N,) of the first record; v in units of the output, since the DC gain of G is 1.
    valid
        Samples that depend on measured ones only.
    band
        Half-width within which the noise of y keeps v, two standard deviations; NaN where G has no
        stable inverse.
    """

    u: Array
    v: Array
    valid: slice
    band: float


@dataclass(frozen=True, eq=False, repr=False)
class IdentifiedHammerstein(Identified):
    """Hysteresis and linear dynamics identified together; ``model = dynamics @ hysteresis``.

    Parameters
    ----------
    hysteresis
        In front, with everything that has units of gain.
    dynamics
        G, DC gain 1, with the delay that was found.
    first_dynamics
        G as realized from the Markov parameters, before the refinement.
    markov
        Step 1.
    singular_values
        Of the Hankel matrix, descending, for the choice of the order.
    hankel_noise
        Singular values below it are noise.
    poles, pole_standard_errors
        Shape (n,), complex: the errors of real and imaginary parts.
    inverse_of_dynamics
        Stable noncausal inverse of G, or None with the reason in ``undetermined``.
    loop
        Step 4.
    front
        Family of the hysteresis, with its options.
    noise_rms
        Residual after the refinement, output units.
    yardstick
        What richer models leave: its ratio tells whether the records are of such a system.
    """

    hysteresis: Operator
    dynamics: LinearDynamics
    first_dynamics: LinearDynamics
    markov: MarkovParameters
    singular_values: Array
    hankel_noise: float
    poles: NDArray[np.complex128]
    pole_standard_errors: NDArray[np.complex128]
    inverse_of_dynamics: StableInverse | None
    loop: Loop
    front: Family
    noise_rms: float
    yardstick: Yardstick

    @property
    def hysteresis_family(self) -> str:
        """Name of the family of the hysteresis: ``pi``, ``mpi``, ..."""
        return self.front.name

    def to_dict(self) -> dict[str, Any]:
        """Give everything but the model as plain numbers and text.

        Returns
        -------
        dict
        """
        inverse = self.inverse_of_dynamics
        more: dict[str, Any] = {
            "hysteresis_family": self.hysteresis_family,
            "fir_order": self.markov.order,
            "regressor_condition": self.markov.condition,
            "markov_parameters": self.markov.values.tolist(),
            "markov_standard_errors": self.markov.standard_errors.tolist(),
            "hankel_singular_values": self.singular_values.tolist(),
            "state_order": self.dynamics.order,
            "delay": self.dynamics.delay,
            "poles": [[float(p.real), float(p.imag)] for p in self.poles],
            "pole_standard_errors": [
                [float(p.real), float(p.imag)] for p in self.pole_standard_errors
            ],
            "noise_rms": self.noise_rms,
            "yardstick": self.yardstick.to_dict(),
        }
        if inverse is not None:
            more |= {
                "preview": inverse.preview,
                "inverse_max_gain": inverse.max_gain,
                "inverse_noise_gain": inverse.noise_gain,
            }
        return super().to_dict() | {"dynamics": more}

    def summary(self) -> str:
        """Give a table of a page or less for people.

        Returns
        -------
        str
        """
        lines = [super().summary(), "", f"poles of G (order {self.dynamics.order}):"]
        for pole, error in zip(self.poles, self.pole_standard_errors, strict=True):
            lines.append(
                f"  {pole.real:+.6g} {pole.imag:+.6g}j   standard error "
                f"{error.real:.2g}, {error.imag:.2g}"
            )
        lines.append(f"yardstick: the model leaves {in_one_line(self.yardstick)}")
        inverse = self.inverse_of_dynamics
        if inverse is not None:
            lines.append(
                f"inverse of G: {inverse.preview} samples of preview, gain at most "
                f"{inverse.max_gain:.4g} at {inverse.max_gain_frequency:.4g} Hz"
            )
        return "\n".join(lines)
