"""Inverse of a delay by more than half a sample, which knows some samples ahead."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Never, Self, final

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import whole_number
from hyst.errors import NotInvertibleError
from hyst.models.late import Late
from hyst.operators.inverses import MOST_PREVIEW
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage

Array = NDArray[np.float64]


@register
@final
@dataclass(frozen=True, eq=False, init=False, repr=False)
class PreviewedDelay(Late):
    """Inverse of a delay by a fraction f > 1/2 of a sample, n + 1 samples late.

    From the newest sample, as if the output rested there, back to the one that is wanted:
    ``u_{i-1} = y_i + q (y_i - u_i)`` with ``q = (1 - f) / f``, for i = k - 1 to k - n. What the
    beginning does not know is smaller by ``q^n`` in the end. ``Delay.inverse(preview=)`` makes it.

    Parameters
    ----------
    samples
        f, above 1/2 and at most 1.
    ahead
        n, samples that are known beyond the first that shows the command, 0 to 1000. A step costs n
        multiplications.
    dt
        Sample time, s; None if any will do.

    Raises
    ------
    InputError
        If f or n is out of range.

    Examples
    --------
    >>> from hyst.models import Delay
    >>> late = Delay(0.8, dt=1.0)
    >>> u = np.sin(np.arange(40.0) / 3.0)
    >>> back = late.inverse(preview=31)(late(u))
    >>> bool(np.abs(back[31:] - u[:-31]).max() < 1e-9)
    True
    """

    ahead: int

    kind = "previewed-delay"

    def __init__(self, samples: float, ahead: int, dt: float | None = None) -> None:
        super().__init__(samples, dt)
        object.__setattr__(self, "ahead", whole_number(ahead, "ahead", 0, MOST_PREVIEW))

    def _allows(self, samples: float) -> bool:
        return 0.5 < samples <= 1.0

    def _refusal(self, samples: float) -> str:
        return (
            f"samples is {samples:.6g}; an inverse from the newest sample back settles for a delay "
            "above half a sample, up to one"
        )

    def __repr__(self) -> str:
        of = "" if self.dt is None else f", dt={self.dt!r}"
        return f"PreviewedDelay({self.samples!r}, {self.ahead}{of})"

    def initial_state(self) -> Array:
        """Give the place of the next sample, none held, and the memory of them, shape (n + 3,)."""
        return np.zeros(self.ahead + 3)

    def parameters(self) -> Parameters:
        """Give none: what it undoes has the constant."""
        return Parameters(np.empty(0), (), np.empty(0), np.empty(0))

    def with_parameters(self, theta: Sequence[float] | Array) -> Self:
        """Give the same inverse: it has no parameters."""
        as_parameter_vector(theta, 0)
        return self

    def at_sample_time(self, dt: float) -> Self:
        """Refuse another sample time, at which another delay would take another preview."""
        self.require_sample_time(dt)
        return self

    def lipschitz_constant(self) -> float:
        """Give the sum of the absolute taps, below ``1 / (2 f - 1)``."""
        q = (1.0 - self.samples) / self.samples
        taps = (1.0 + q) * sum(q**j for j in range(self.ahead)) + q**self.ahead
        return float(taps) * (1.0 + 1e-9)

    def exact_inverse(self) -> Never:
        """Refuse: the way back is the delay it was made for.

        Raises
        ------
        NotInvertibleError
            Always.
        """
        raise NotInvertibleError(
            "a previewed delay answers late and is no delay read backwards; keep the Delay it was "
            "made for"
        )

    def to_dict(self) -> dict[str, Any]:
        """Give kind, delay, preview and, where there is one, the sample time."""
        return {**super().to_dict(), "ahead": self.ahead}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, ("samples", "ahead"), ("dt",)))

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        fixed, choices = {"fraction": (self.samples,)}, {"ahead": self.ahead}
        return (Stage("delay_preview", (), fixed, choices, dt=self.dt),)
