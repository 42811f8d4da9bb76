"""What came of a simulated loop."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@final
@dataclass(frozen=True, eq=False)
class ClosedLoop:
    """Signals of a loop, and how well it tracked.

    A loop that diverged ends before the sample that gave it away: all signals are finite.

    Parameters
    ----------
    dt
        Sample time, s.
    r
        Reference, shape (N,), output units.
    y
        Output without noise, shape (N,).
    noise
        Of the measurement, shape (N,); the controller is given ``y + noise``.
    v
        Output wanted of the hysteresis, which is the input wanted of the plant, shape (N,); where a
        TrackingController limits its drive, the v that belongs to the drive applied.
    u
        Drive, the output of the inverse, shape (N,), within the limits of a TrackingController.
    eta
        What the hysteresis gives, shape (N,), in units of v.
    d_hat
        Estimate of the disturbance, in v already taken off, shape (N,), in units of v. Zeros
        without an observer, or where a TrackingController does not tell.
    disturbance
        Shape (N,); in units of u before the hysteresis, of v behind it.
    settle
        Seconds at the start that the metrics leave out.
    diverged_at
        Time of divergence, s, or None.
    held
        Whether a TrackingController ever held its drive, at its limits or its rate, or where no
        drive belongs to v.
    """

    dt: float
    r: Array
    y: Array
    noise: Array
    v: Array
    u: Array
    eta: Array
    d_hat: Array
    disturbance: Array
    settle: float
    diverged_at: float | None
    held: bool = False

    @property
    def t(self) -> Array:
        """Time, s, shape (N,)."""
        return np.arange(self.r.size, dtype=np.float64) * self.dt

    @property
    def e(self) -> Array:
        """Tracking error ``r - y``, shape (N,)."""
        return self.r - self.y

    @property
    def y_measured(self) -> Array:
        """What the controller is given, ``y + noise``, shape (N,)."""
        return self.y + self.noise

    @property
    def rms_error(self) -> float:
        """Root mean square of the tracking error after ``settle``; infinity if it diverged."""
        return self._metric(lambda e: math.sqrt(float(np.mean(e**2))))

    @property
    def max_error(self) -> float:
        """Largest tracking error after ``settle``, without sign; infinity if it diverged."""
        return self._metric(lambda e: float(np.abs(e).max()))

    @property
    def max_drive(self) -> float:
        """Largest drive after ``settle``, without sign; infinity if it diverged."""
        if self.diverged_at is not None:
            return math.inf
        return float(np.abs(self.u[self._settled :]).max())

    @property
    def drive_jitter(self) -> float:
        """Standard deviation of the drive's change in a sample after ``settle``; infinity likewise.

        In units of the drive. What reference and noise do to it is both in it.
        """
        if self.diverged_at is not None:
            return math.inf
        return float(np.diff(self.u[self._settled :]).std()) if self.u.size > 1 else 0.0

    def summary(self) -> str:
        """Say in one line what came of it."""
        if self.diverged_at is not None:
            return f"the loop diverges: its output leaves all bounds at {self.diverged_at:.4g} s"
        return (
            f"tracking error after {self.settle:g} s: rms {self.rms_error:.4g}, "
            f"max {self.max_error:.4g}; drive up to {self.max_drive:.4g}"
        )

    @property
    def _settled(self) -> int:
        return math.ceil(self.settle / self.dt - 1e-6)

    def _metric(self, measure: Callable[[Array], float]) -> float:
        return math.inf if self.diverged_at is not None else measure(self.e[self._settled :])
