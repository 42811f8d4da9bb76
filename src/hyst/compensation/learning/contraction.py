"""Whether learning contracts: what the slopes of the plant behind the model's inverse allow."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, final

from hyst.compensation.error_of_inverse.inverse_slopes import slope_range
from hyst.errors import InputError
from hyst.operators import Operator


@final
@dataclass(frozen=True)
class Contraction:
    """What is left of an error after a repetition, at most.

    With slopes of ``plant(model^-1(v))``, its linear part taken off, between ``low`` and ``high``
    along the motion, and a share ``gain`` of every error corrected, an error shrinks by

        rate = max(|1 - gain low|, |1 - gain high|)

    which is below 1 for some gain if and only if both slopes are above 0, and for the gain 1 if
    both are in (0, 2).

    Parameters
    ----------
    low, high
        The slopes; NaN before anything is known of them.
    gain
        Share of the correction that is made, above 0, at most 1.
    source
        Where the slopes are from: ``"given"``, ``"bound"``, ``"measured"`` or ``"unknown"``.

    Examples
    --------
    >>> Contraction(0.8, 1.3, 1.0, "given").rate.__round__(9)
    0.3
    >>> Contraction(0.8, 2.4, 1.0, "given").holds
    False
    """

    low: float
    high: float
    gain: float
    source: str

    @classmethod
    def between(cls, plant: Operator, model: Operator, y_max: float) -> Contraction:
        """Give the condition for one bank of plays behind the inverse of another.

        Parameters
        ----------
        plant
            What the actuator may be: a PI, GPI or MPI model, as one at the edge of a band.
        model
            What is inverted, of the same kind.
        y_max
            Largest ``|y_ref|``, output units.

        Examples
        --------
        >>> from hyst.models import PrandtlIshlinskii
        >>> plant = PrandtlIshlinskii([0.6], [1.0], p0=1.0)
        >>> model = PrandtlIshlinskii([0.5], [1.0], p0=1.0)
        >>> Contraction.between(plant, model, 5.0).holds
        True
        """
        low, high = slope_range(plant, model.inverse(), y_max)
        return cls.with_best_gain(low, high, "bound")

    @classmethod
    def with_best_gain(cls, low: float, high: float, source: str) -> Contraction:
        """Give the condition with the gain 1, or, where that does not do, with the best one.

        Parameters
        ----------
        low, high, source
            As of the class.
        """
        gain = 1.0
        if low > 0.0 and not max(abs(1.0 - low), abs(1.0 - high)) < _SURELY:
            gain = min(1.0, 2.0 / (low + high))
        return cls(low, high, gain, source)

    @property
    def slopes(self) -> tuple[float, float]:
        """Least and largest slope."""
        return self.low, self.high

    @property
    def known(self) -> bool:
        """Whether there are slopes."""
        return math.isfinite(self.low) and math.isfinite(self.high)

    @property
    def rate(self) -> float:
        """Share of an error that is left after a repetition, at most; NaN if not known."""
        return max(abs(1.0 - self.gain * self.low), abs(1.0 - self.gain * self.high))

    @property
    def holds(self) -> bool:
        """Whether an error is known to shrink."""
        return self.known and self.rate < 1.0

    @property
    def sentence(self) -> str:
        """The condition with its numbers."""
        if not self.known:
            return (
                "whether learning contracts is not known before the first repetition is measured: "
                "give slopes of the plant behind the model's inverse (slopes=), or measure"
            )
        told = {"given": "as given", "bound": "by the bound of the model's error"}
        where = told.get(self.source, "as measured along the motion, not a bound")
        slopes = f"slopes of the plant behind the model's inverse {self.low:.3g} to {self.high:.3g}"
        if self.low <= 0.0:
            return (
                f"{slopes} ({where}): no gain contracts, for a slope is not above 0; identify a "
                "better model, or keep the reference where the plant responds"
            )
        if not self.holds:
            return f"{slopes} ({where}): with the gain {self.gain:.3g} an error need not shrink"
        return (
            f"{slopes} ({where}): with the gain {self.gain:.3g} at most {100.0 * self.rate:.3g} % "
            "of an error are left after a repetition"
        )

    def to_dict(self) -> dict[str, Any]:
        """Give plain numbers; None for a slope that is not known."""
        known = self.known
        low, high = (self.low, self.high) if known else (None, None)
        return {"low": low, "high": high, "gain": self.gain, "source": self.source}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Contraction:
        """Rebuild it from ``to_dict()``.

        Parameters
        ----------
        data
            What it gave.
        """
        low, high = (math.nan if data[key] is None else float(data[key]) for key in ("low", "high"))
        return cls(low, high, float(data["gain"]), str(data["source"]))


_SURELY = 0.9
"""A rate above this is too near 1 to learn by."""


def given_slopes(slopes: tuple[float, float]) -> Contraction:
    """Check slopes that the user gives.

    Parameters
    ----------
    slopes
        The least and the largest.

    Raises
    ------
    InputError
        If they are not two finite ascending numbers above 0.
    """
    try:
        low, high = (float(each) for each in slopes)
    except (TypeError, ValueError):
        low = high = math.nan
    if not (0.0 < low <= high < math.inf):
        raise InputError(
            f"slopes are {slopes!r}; give the least and the largest slope of the plant behind the "
            "model's inverse, two finite numbers above 0"
        )
    return Contraction.with_best_gain(low, high, "given")
