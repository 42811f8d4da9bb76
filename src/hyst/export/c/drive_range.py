"""What the drive of an actuator may be on a target, as people and headers are told."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, final

import numpy as np

from hyst.export.c.limited import not_above, not_below
from hyst.export.c.numbers import Precision

Side = Literal["output", "input", "command", ""]

NO_RANGE = "none: no range of the drive is known"


@final
@dataclass(frozen=True)
class DriveRange:
    """Limits of a drive, in numbers of a target.

    Parameters
    ----------
    side
        Which signal of the block the drive is: its output, its input, or the command of an
        estimator; "" where that is not known.
    low, high
        Lowest and highest drive; None without limits.
    rate
        The most it moves in a second; None for any.
    source
        Where the limits come from, or why there are none.
    unit
        Of the drive, as text, or "".
    stated
        The limits before they were rounded inwards; None without limits.
    """

    side: Side = ""
    low: float | None = None
    high: float | None = None
    rate: float | None = None
    source: str = NO_RANGE
    stated: tuple[float, float] | None = None
    unit: str = ""

    @classmethod
    def of(
        cls,
        side: Side,
        limits: tuple[float, float] | None,
        rate: float | None,
        precision: Precision,
        source: str,
    ) -> DriveRange:
        """Give limits that hold in a ``precision``: no wider than they are.

        Parameters
        ----------
        side, limits, rate, source
            As the fields.
        precision
            Of the target.
        """
        if precision == "double":
            low, high = (None, None) if limits is None else limits
            return cls(side, low, high, rate, source, limits)
        low, high = (None, None) if limits is None else (not_below(limits[0]), not_above(limits[1]))
        inner = None if rate is None else not_above(rate)
        return cls(side, low, high, inner, source, limits)

    @property
    def limits(self) -> tuple[float, float] | None:
        """Lowest and highest drive, or None."""
        return None if self.low is None or self.high is None else (self.low, self.high)

    @property
    def is_limited(self) -> bool:
        """Whether anything limits the drive."""
        return self.low is not None or self.rate is not None

    def holds(self, drive: float) -> bool:
        """Tell whether a ``drive`` is within the limits."""
        return self.limits is None or self.limits[0] <= drive <= self.limits[1]

    def said(self) -> str:
        """Give the row of a table: limits, rate, and where they come from."""
        if not self.is_limited:
            return self.source
        parts = [] if self.limits is None else [f"{_short(self.low)} to {_short(self.high)}"]
        behind = f" {self.unit}" if self.unit else ""
        rate = "" if self.rate is None else f"at most {_short(self.rate)}{behind} per second"
        parts = [f"{each}{behind}" for each in parts] + ([rate] if rate else [])
        return f"{', '.join(parts)} ({self.source})"

    def told(self) -> dict[str, str | float]:
        """Give what a manifest says."""
        said = {
            "side": self.side,
            "low": self.low,
            "high": self.high,
            "rate": self.rate,
            "unit": self.unit,
        }
        return {"source": self.source} | {
            key: value for key, value in said.items() if value not in (None, "")
        }

    def defined(self, name: str) -> str:
        """Give the lines of a header that say it, for an export called ``name``."""
        values = {"MIN": self.low, "MAX": self.high, "RATE": self.rate}
        meanings = {
            "MIN": "the lowest drive that may be",
            "MAX": "the highest",
            "RATE": "the most it moves in a second",
        }
        return "".join(
            f"#define {name.upper()}_U_{key} (HYST_REAL({value!r})) /* {meanings[key]} */\n"
            for key, value in values.items()
            if value is not None
        )


def _short(value: float | None) -> str:
    return f"{np.float64(value or 0.0):.9g}"
