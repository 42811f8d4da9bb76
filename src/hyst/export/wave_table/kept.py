"""What a wave must keep: limits, a largest rate, a closed end, a number of points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError

Array = NDArray[np.float64]

_ROUNDING = 1e-9  # of the limits' distance, or of a step: what an inversion leaves
_JUMP = 2.0  # of the largest step of a wave: its own end may be where it is steepest


@final
@dataclass(frozen=True)
class Kept:
    """What the wave must keep.

    Parameters
    ----------
    limits
        Lowest and highest drive.
    slew
        Largest rate, units per second; None for any.
    points
        Most points of the table; None for any number.
    repeat
        Whether the first point follows the last.
    """

    limits: tuple[float, float]
    slew: float | None
    points: int | None
    repeat: bool

    def require_points(self, count: int, dt: float) -> None:
        """Refuse more points than the controller has.

        Parameters
        ----------
        count
            Of the table.
        dt
            From point to point, s.

        Raises
        ------
        InputError
            If there are more.
        """
        if self.points is None or count <= self.points:
            return
        steps = count if self.repeat else count - 1
        most = self.points if self.repeat else self.points - 1
        slower = f"a controller's rate of {most / (steps * dt):.12g} Hz or less, or "
        raise InputError(
            f"the table has {count} points at {1.0 / dt:.6g} Hz, and {self.points} are allowed; "
            f"give {slower if most > 0 else ''}a shorter signal"
        )

    def within(self, u: Array, dt: float, unit: str) -> Array:
        """Give a wave within the limits.

        Parameters
        ----------
        u
            Drive, shape (N,).
        dt
            From point to point, s.
        unit
            Of the drive, with a blank before it.

        Raises
        ------
        InputError
            If it leaves them by more than rounding; the first point is named.
        """
        low, high = self.limits
        slack = _ROUNDING * (high - low)
        wrong = (u < low - slack) | (u > high + slack)
        if wrong.any():
            k = int(wrong.argmax())
            raise InputError(
                f"point {k} at {k * dt:.6g} s is {u[k]:.9g}{unit}, out of the limits {low:.6g} to "
                f"{high:.6g}{unit}; {int(wrong.sum())} of {u.size} points are, from {u.min():.6g} "
                f"to {u.max():.6g}; give another signal or other limits"
            )
        return np.clip(u, low, high)

    def require_slew(self, u: Array, dt: float, unit: str) -> None:
        """Refuse a wave that is too fast, or that does not close where it repeats.

        Parameters
        ----------
        u
            Drive, shape (N,).
        dt
            From point to point, s.
        unit
            Of the drive, with a blank before it.

        Raises
        ------
        InputError
            If it is; the first point is named.
        """
        steps = np.abs(np.diff(u))
        if self.slew is not None:
            wrong = steps > self.slew * dt * (1.0 + _ROUNDING)
            if wrong.any():
                k = int(wrong.argmax())
                raise InputError(
                    f"from point {k} at {k * dt:.6g} s to the next the drive goes from {u[k]:.6g} "
                    f"to {u[k + 1]:.6g}{unit}, {steps[k] / dt:.6g} per second, more than the slew "
                    f"{self.slew:.6g}; give a slower signal"
                )
        if not self.repeat:
            return
        jump = abs(float(u[0] - u[-1]))
        most = self.slew * dt if self.slew is not None else _JUMP * float(steps.max(initial=0.0))
        if jump > most * (1.0 + _ROUNDING):
            than = (
                f"{jump / dt:.6g} per second, more than the slew {self.slew:.6g}"
                if self.slew is not None
                else f"while its largest step elsewhere is {steps.max(initial=0.0):.6g}"
            )
            raise InputError(
                f"repeated, the wave goes from its last point {u[-1]:.6g} to its first "
                f"{u[0]:.6g}{unit} at once, {than}; let it end where it begins"
                + ("" if self.slew is not None else ", or give the slew that the drive may have")
            )
