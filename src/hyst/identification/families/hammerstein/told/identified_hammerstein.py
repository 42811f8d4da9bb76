"""What a Hammerstein identification gives back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.identification.families.family import Family
from hyst.identification.families.hammerstein.impulse_response.markov import MarkovParameters
from hyst.identification.families.hammerstein.told.dynamics_words import (
    dynamics_as_data,
    summary_lines,
)
from hyst.identification.families.hammerstein.told.found_root import FoundRoot, plain_number
from hyst.identification.families.hammerstein.told.frequency_response import FrequencyResponse
from hyst.identification.families.hammerstein.told.known_dynamics import KnownDynamics
from hyst.identification.families.hammerstein.yardstick.yardstick import Yardstick
from hyst.identification.families.hammerstein.yardstick.yardstick_told import in_one_line
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
        G as realized from the Markov parameters, of the order that was found; None where the drive
        does not determine them.
    markov
        Step 1 of the paper; None where the drive does not determine it, or G was given.
    singular_values
        Of the Hankel matrix, descending; empty without Markov parameters.
    hankel_noise
        Singular values below it are noise.
    poles, pole_standard_errors
        Shape (n,), complex: the errors of real and imaginary parts, infinite where the records do
        not determine them.
    inverse_of_dynamics
        Stable noncausal inverse of G, or None with the reason in ``undetermined``.
    loop
        Step 4.
    front
        Family of the hysteresis, with its options.
    noise_rms
        Residual after the refinement, output units.
    dynamics_are_given
        Whether G was known before and held: then the errors of its poles are 0.
    known
        What the fit tells of G: poles, zeros and frequency response with their errors.
    yardstick
        What richer models leave: its ratio tells whether the records are of such a system.
    """

    hysteresis: Operator
    dynamics: LinearDynamics
    first_dynamics: LinearDynamics | None
    markov: MarkovParameters | None
    singular_values: Array
    hankel_noise: float
    poles: NDArray[np.complex128]
    pole_standard_errors: NDArray[np.complex128]
    inverse_of_dynamics: StableInverse | None
    loop: Loop
    front: Family
    noise_rms: float
    known: KnownDynamics
    yardstick: Yardstick
    dynamics_are_given: bool = False

    @property
    def resonances(self) -> tuple[FoundRoot, ...]:
        """Complex pairs of poles of G, with natural frequency and damping, by rising frequency."""
        return tuple(each for each in self.known.poles if each.is_pair)

    @property
    def real_poles(self) -> tuple[FoundRoot, ...]:
        """Real poles of G, with their time constants where they have one."""
        return tuple(each for each in self.known.poles if not each.is_pair)

    @property
    def zeros(self) -> tuple[FoundRoot, ...]:
        """Zeros of G; ``side`` tells a nonminimum phase."""
        return self.known.zeros

    def frequency_response(self, frequencies: ArrayLike | None = None) -> FrequencyResponse:
        """Give the frequency response of G with the band in which it is known.

        Parameters
        ----------
        frequencies
            Shape (p,), Hz, from 0 to half the sample rate; None: some hundred, from below the
            drive's lowest, dense about resonances.

        Returns
        -------
        FrequencyResponse
            With a mark where the drive had no power and the response is an extrapolation.

        Raises
        ------
        InputError
            If one of them is no such number.

        Examples
        --------
        ::

            response = found.frequency_response([10.0, 100.0])
            response.gain, response.gain_band(0.95), response.excited
        """
        return self.known.frequency_response(frequencies)

    @property
    def hysteresis_family(self) -> str:
        """Name of the family of the hysteresis: ``pi``, ``mpi``, ..."""
        return self.front.name

    def delay_in_words(self) -> str:
        """Give the delay of the dynamics, which is part of the model."""
        beside = f" and {self.delay:.4g} beside the model" if self.delay else ""
        return f"delay {self.dynamics.delay} samples in G{beside}"

    def to_dict(self) -> dict[str, Any]:
        """Give everything but the model as plain numbers and text.

        Returns
        -------
        dict
        """
        inverse = self.inverse_of_dynamics
        more: dict[str, Any] = {
            "hysteresis_family": self.hysteresis_family,
            "given": self.dynamics_are_given,
            "state_order": self.dynamics.order,
            "delay": self.dynamics.delay,
            "poles": [[float(p.real), float(p.imag)] for p in self.poles],
            "pole_standard_errors": [
                [plain_number(p.real), plain_number(p.imag)] for p in self.pole_standard_errors
            ],
            "noise_rms": self.noise_rms,
            **dynamics_as_data(self.known),
            "yardstick": self.yardstick.to_dict(),
        }
        if self.markov is not None:
            more |= {
                "fir_order": self.markov.order,
                "regressor_condition": self.markov.condition,
                "markov_parameters": self.markov.values.tolist(),
                "markov_standard_errors": self.markov.standard_errors.tolist(),
                "hankel_singular_values": self.singular_values.tolist(),
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
        lines = [super().summary(), "", *summary_lines(self.known)]
        lines.append(f"yardstick: the model leaves {in_one_line(self.yardstick)}")
        inverse = self.inverse_of_dynamics
        if inverse is not None:
            lines.append(
                f"inverse of G: {inverse.preview} samples of preview, gain at most "
                f"{inverse.max_gain:.4g} at {inverse.max_gain_frequency:.4g} Hz"
            )
        return "\n".join(lines)
