"""What delays by parts of a sample and their inverses have in common."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_not_negative, as_sample_time
from hyst.errors import InputError
from hyst.operators import Operator
from hyst.operators.parameters import as_parameter_vector
from hyst.operators.portrait import NOTHING, Portrait
from hyst.operators.registry import entries
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, init=False, repr=False)
class Late(Operator):
    """A delay by ``samples`` of ``sample_time``, or what takes one back."""

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

    def __repr__(self) -> str:
        of = "" if self.dt is None else f", dt={self.dt!r}"
        return f"{type(self).__name__}({self.samples!r}{of})"

    def at_sample_time(self, dt: float) -> Self:
        """Give the same time of delay for records of another sample time.

        Without a sample time of its own the delay is so many samples of any record.
        """
        step, own = as_sample_time(dt), self.dt
        return self if own is None or step == own else type(self)(self.samples * own / step, step)

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
        """Give ones: a delay is counted in samples.

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
        return np.ones(len(self.parameters()))

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
