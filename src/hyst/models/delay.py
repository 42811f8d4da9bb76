"""A delay by parts of a sample, and its inverses: exact at once, or by preview."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.errors import NotInvertibleError
from hyst.models.late import Late
from hyst.models.previewed_delay import PreviewedDelay
from hyst.operators import Affine, Operator
from hyst.operators.inverses import MOST_PREVIEW
from hyst.operators.parameters import Parameters
from hyst.operators.registry import delayed, register
from hyst.operators.stage import Stage

Array = NDArray[np.float64]

LARGEST_DELAY = 100_000
"""Samples; an export writes as many numbers of memory."""


@register
@final
@dataclass(frozen=True, eq=False, init=False, repr=False)
class Delay(Late):
    """A delay by n whole samples and a fraction f, on the line between two samples.

    ``y_k = (1 - f) u_{k-n} + f u_{k-n-1}``. The signal has rested at its first sample.

    Parameters
    ----------
    samples
        n + f, from 0 to 100,000.
    dt
        Sample time, s; None for a delay of so many samples, whatever they last. At another one
        (``at_sample_time``) the delay keeps its time.

    Raises
    ------
    InputError
        If the delay is negative, longer, or not a finite number.

    Notes
    -----
    The line between two samples delays slow signals by n + f exactly and makes fast ones smaller,
    at half the sample rate by ``|1 - 2 f|``: at f = 1/2 these are lost. As a parameter the delay
    moves within its whole sample only, since its memory has a length and its derivative a kink at
    whole samples; bounds say so.

    T. I. Laakso, V. Valimaki, M. Karjalainen and U. K. Laine, Splitting the unit delay, IEEE Signal
    Processing Magazine 13 (1996) 30-60, for lines as fractional delays.

    Examples
    --------
    >>> Delay(1.25, dt=1e-3)([0.0, 4.0, 8.0, 0.0])
    array([0., 0., 3., 7.])
    """

    kind = "delay"

    def _allows(self, samples: float) -> bool:
        return samples <= LARGEST_DELAY

    def _refusal(self, samples: float) -> str:
        return f"samples is {samples:.10g}; a delay is of at most {LARGEST_DELAY} samples"

    def parameters(self) -> Parameters:
        """Give the delay, samples, which may move within its whole sample."""
        beyond = np.nextafter(self.whole + 1.0, 0.0)
        return Parameters(
            values=np.array([self.samples]),
            names=("samples",),
            lower=np.array([float(self.whole)]),
            upper=np.array([min(beyond, float(LARGEST_DELAY))]),
        )

    def lipschitz_constant(self) -> float:
        """Give 1: the output is a mean of two inputs."""
        return 1.0

    def exact_inverse(self) -> InverseDelay:
        """Give the exact inverse of a delay of less than half a sample.

        Raises
        ------
        NotInvertibleError
            If the delay is longer: the command would have to be given before the sample that asks
            for it is known, or would grow.
        """
        if not self.samples < 0.5:
            self.preview_range()
            raise NotInvertibleError(
                f"the delay is {self.samples:.6g} samples; a causal inverse that does not grow is "
                "for less than 0.5, so ask for inverse(preview=N), which answers N samples late"
            )
        return InverseDelay(self.samples, self.dt)

    def preview_range(self) -> tuple[int, int]:
        """Give what an inverse needs: n samples where f < 1/2; else n + 1, and more to be exact.

        Raises
        ------
        NotInvertibleError
            If f is 1/2: what the drive does at half the sample rate does not show in the output.
        """
        whole, fraction = self.whole, self.samples - self.whole
        if fraction == 0.5:
            raise NotInvertibleError(
                f"the delay is {self.samples:.6g} samples: the line half way between two samples "
                "loses what alternates from sample to sample, so there is no inverse, with preview "
                "neither"
            )
        if fraction < 0.5:
            return whole, whole
        # Beyond, a sample more of preview changes no digit of the command.
        useful = math.ceil(math.log(2.0**-53) / math.log((1.0 - fraction) / fraction))
        return whole + 1, min(whole + 1 + useful, max(MOST_PREVIEW, whole + 1))

    def preview_inverse(self, samples: int) -> Operator:
        """Give an inverse whose output at k is the command for sample k - samples.

        With f < 1/2 it is exact. With f > 1/2 the output that is reached is wrong by
        ``f ((1 - f) / f)^(samples - n) |y_i - y_{i-1}|``, y_i the last sample that is known: what
        comes after it is taken to rest there.

        Raises
        ------
        NotInvertibleError
            If the preview is shorter than the delay asks for, or f is 1/2.
        """
        least, most = self.preview_range()
        if samples < least:
            raise NotInvertibleError(
                f"the delay is {self.samples:.6g} samples, so its inverse must know {least} "
                f"samples of the reference beyond the present one; a preview of {samples} is too "
                "short"
            )
        whole, fraction, used = self.whole, self.samples - self.whole, min(samples, most)
        inverse: Operator = Affine(1.0, 0.0)
        if fraction > 0.5:
            inverse = PreviewedDelay(fraction, used - whole - 1, self.dt)
        elif fraction > 0.0:
            inverse = InverseDelay(fraction, self.dt)
        return inverse if samples == used else delayed(inverse, samples - used)

    @property
    def whole(self) -> int:
        """The whole samples of the delay."""
        return int(self.samples)

    def initial_state(self) -> Array:
        """Give the place of the next sample, none held, and the memory of them, shape (n + 3,)."""
        return np.zeros(self.whole + 3)

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        choices = {"whole": self.whole, "inverse": 0}
        return (Stage("delay", (self.samples,), choices=choices, dt=self.dt),)


@register
@final
@dataclass(frozen=True, eq=False, init=False, repr=False)
class InverseDelay(Late):
    """Inverse of a delay by a fraction of a sample, from what is late to what was given.

    ``u_k = (y_k - f u_{k-1}) / (1 - f)``; ``Delay.inverse()`` makes it.

    Parameters
    ----------
    samples
        f, from 0 to less than 1/2.
    dt
        As in ``Delay``.

    Raises
    ------
    InputError
        As ``Delay``, or if the delay is half a sample or more, where the command would not settle.

    Examples
    --------
    >>> Delay(0.25, dt=1.0).inverse()([0.0, 3.0, 3.0]).round(6)
    array([0.      , 4.      , 2.666667])
    """

    kind = "inverse-delay"

    def _allows(self, samples: float) -> bool:
        return samples < 0.5

    def _refusal(self, samples: float) -> str:
        return (
            f"samples is {samples:.6g}; the inverse of a delay is stable below half a sample only"
        )

    def parameters(self) -> Parameters:
        """Give the delay, samples."""
        return Parameters(
            values=np.array([self.samples]),
            names=("samples",),
            lower=np.array([0.0]),
            upper=np.array([np.nextafter(0.5, 0.0)]),
        )

    def lipschitz_constant(self) -> float:
        """Give ``1 / (1 - 2 f)``, the sum of the absolute impulse response."""
        return 1.0 / (1.0 - 2.0 * self.samples)

    def exact_inverse(self) -> Delay:
        """Give the delay."""
        return Delay(self.samples, self.dt)

    def initial_state(self) -> Array:
        """Give the place of the next sample, none held, and the memory of one, shape (3,)."""
        return np.zeros(3)

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        choices = {"whole": 0, "inverse": 1}
        return (Stage("delay", (self.samples,), choices=choices, dt=self.dt),)
