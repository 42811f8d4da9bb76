"""A delay by parts of a sample, and its exact inverse where there is one."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self, final

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_not_negative, as_sample_time
from hyst.errors import InputError, NotInvertibleError
from hyst.operators import Operator
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.portrait import NOTHING, Portrait
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]

LARGEST_DELAY = 100_000
"""Samples; an export writes as many numbers of memory."""


@dataclass(frozen=True, eq=False, init=False, repr=False)
class _Late(Operator):
    """What a delay and its inverse have in common: all constants."""

    samples: float
    sample_time: float | None

    def __init__(self, samples: float, dt: float | None = None) -> None:
        late = as_not_negative(samples, "samples", "by how many samples it is late")
        if not self._allows(late):
            raise InputError(self._refusal(late))
        object.__setattr__(self, "samples", late)
        step = None if dt is None else as_sample_time(dt)
        object.__setattr__(self, "sample_time", step)

    @abstractmethod
    def _allows(self, samples: float) -> bool:
        """Tell whether there is such a delay, or such an inverse."""

    @abstractmethod
    def _refusal(self, samples: float) -> str:
        """Say why there is none."""

    @property
    def dt(self) -> float | None:
        """The sample time, seconds; None if any will do."""
        return self.sample_time

    @property
    def whole(self) -> int:
        """The whole samples of the delay."""
        return int(self.samples)

    def __repr__(self) -> str:
        of = "" if self.dt is None else f", dt={self.dt!r}"
        return f"{type(self).__name__}({self.samples!r}{of})"

    def at_sample_time(self, dt: float) -> Self:
        """Give the same time of delay for records of another sample time.

        Without a sample time of its own the delay is so many samples of any record.
        """
        step, own = as_sample_time(dt), self.dt
        return self if own is None or step == own else type(self)(self.samples * own / step, step)

    def initial_state(self) -> Array:
        """Give the place of the next sample, none held, and the memory of them, shape (n + 3,)."""
        return np.zeros(self.whole + 3)

    def traits(self) -> Traits:
        """Give the traits of a linear memory; without a delay it is the input itself."""
        none = self.samples == 0.0
        return Traits(
            memoryless=none,
            rate_independent=Degree.EXACTLY if none else Degree.NO,
            return_point_memory=none,
            congruent_loops=none,
            monotone=none,  # else it falls on while the input begins to rise
            invertible=self.is_invertible,
        )

    def with_parameters(self, theta: Sequence[float] | Array) -> Self:
        """Give another delay; the sample time stays."""
        return type(self)(float(as_parameter_vector(theta, 1)[0]), self.dt)

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give one: a delay is counted in samples.

        Raises
        ------
        InputError
            If input and output grow by different factors.
        """
        if input_scale != output_scale:
            raise InputError(
                "a delay leaves the unit of its signal as it is; put the gain into an Affine or "
                "the model beside it"
            )
        return np.ones(1)

    def keeps_unit(self) -> bool:
        """Tell that what is late has the unit of the signal."""
        return True

    def portrait(self) -> Portrait:
        """Show nothing: a delay is seen over time, not over the input."""
        return NOTHING

    def to_dict(self) -> dict[str, Any]:
        """Give kind, delay and, where there is one, the sample time."""
        more = {} if self.dt is None else {"dt": self.dt}
        return {"kind": self.kind, "samples": self.samples, **more}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, ("samples",), ("dt",)))

    @abstractmethod
    def _is_inverse(self) -> bool:
        """Tell whether the input is what is late."""

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        choices = {"whole": self.whole, "inverse": int(self._is_inverse())}
        return (Stage("delay", (self.samples,), choices=choices, dt=self.dt),)


@register
@final
@dataclass(frozen=True, eq=False, init=False, repr=False)
class Delay(_Late):
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
        return f"samples is {samples:.6g}; a delay is of at most {LARGEST_DELAY} samples"

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
            raise NotInvertibleError(
                f"the delay is {self.samples:.6g} samples; a causal inverse that does not grow is "
                f"for less than 0.5, so ask for inverse(preview=N), which answers N samples late"
            )
        return InverseDelay(self.samples, self.dt)

    def _is_inverse(self) -> bool:
        return False


@register
@final
@dataclass(frozen=True, eq=False, init=False, repr=False)
class InverseDelay(_Late):
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

    def _is_inverse(self) -> bool:
        return True
