"""A wanted output, drawn with a few points and some sliders."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from hyst.errors import InputError

Array = NDArray[np.float64]

POINTS = 12
"""Of one period."""

MOST_SAMPLES = 40_000
_A_PERIOD, _PERIODS = 600, 3
_PHASE = np.arange(POINTS) / POINTS
SHAPES: dict[str, tuple[float, ...]] = {
    "sine": tuple(np.sin(2.0 * np.pi * _PHASE)),
    "triangle": tuple(1.0 - 4.0 * np.abs(np.mod(_PHASE + 0.25, 1.0) - 0.5)),
    "steps": tuple(np.where(_PHASE < 0.5, 1.0, -1.0)),
}
"""Values of the points by the name of a shape, from -1 to 1."""


@dataclass(frozen=True)
class Reference:
    """A wanted output that repeats.

    Parameters
    ----------
    middle, amplitude
        Output units: where a point of 0 lies, and how far one of 1 is from it.
    frequency
        Hz, of a period.
    shape
        What goes through the points: ``sine`` a smooth curve, ``triangle`` straight lines,
        ``steps`` levels.
    points
        Values of one period, from -1 to 1.
    """

    middle: float
    amplitude: float
    frequency: float
    shape: str = "sine"
    points: tuple[float, ...] = SHAPES["sine"]

    def shaped(self, shape: str) -> Reference:
        """Give it another shape, with the points of that."""
        return replace(self, shape=shape, points=SHAPES[shape])

    def with_number(self, name: str, value: float) -> Reference:
        """Give it another middle, amplitude or frequency.

        Parameters
        ----------
        name, value
            Of the number.
        """
        numbers = {"middle": self.middle, "amplitude": self.amplitude, "frequency": self.frequency}
        return replace(self, **(numbers | {name: value}))  # type: ignore[arg-type]

    def moved(self, point: int, value: float) -> Reference:
        """Move one of its points.

        Parameters
        ----------
        point
            Its number, from 0.
        value
            Wanted output there; held within the amplitude.
        """
        share = (value - self.middle) / self.amplitude if self.amplitude else 0.0
        points = list(self.points)
        points[point] = min(max(share, -1.0), 1.0)
        return replace(self, points=tuple(points))

    def at_points(self) -> tuple[Array, Array]:
        """Give times, s, and wanted outputs of the points of the first period."""
        return _PHASE / self.frequency, self.middle + self.amplitude * np.array(self.points)

    def sampled(self, dt: float | None) -> tuple[Array, Array]:
        """Give times, s, and wanted outputs of a few periods, from the middle on.

        Parameters
        ----------
        dt
            Sample time of the model; None where it has none.

        Raises
        ------
        InputError
            If that is too many samples, or too few in a period.
        """
        step = 1.0 / (self.frequency * _A_PERIOD) if dt is None else dt
        in_period = 1.0 / (self.frequency * step)
        if in_period < 2.0 * POINTS:
            raise InputError(
                f"a period of {1.0 / self.frequency:.3g} s has {in_period:.3g} samples of the "
                f"model's {step:.3g} s; choose at most {1.0 / (2 * POINTS * step):.3g} Hz"
            )
        samples = int(np.ceil(_PERIODS * in_period)) + 1
        if samples > MOST_SAMPLES:
            raise InputError(
                f"{_PERIODS} periods are {samples} samples of the model's {step:.3g} s, and the "
                f"page takes {MOST_SAMPLES}; choose at least "
                f"{_PERIODS / (MOST_SAMPLES * step):.3g} Hz"
            )
        time = np.arange(samples, dtype=np.float64) * step
        return time, self.middle + self.amplitude * self.through_points(time * self.frequency)

    def through_points(self, periods: Array) -> Array:
        """Give values, 1 at the amplitude, of what goes through the points.

        Parameters
        ----------
        periods
            Times over the period.
        """
        phase = np.mod(periods, 1.0)
        closed = np.append(self.points, self.points[0])
        knots = np.append(_PHASE, 1.0)
        if self.shape == "triangle":
            return np.array(np.interp(phase, knots, closed), dtype=np.float64)
        if self.shape == "steps":
            # A little more, so that a sample on a point is never before it by rounding.
            held: Array = np.asarray(closed)[
                np.minimum((phase * POINTS + 1e-9).astype(int), POINTS - 1)
            ]
            return held
        return np.array(CubicSpline(knots, closed, bc_type="periodic")(phase), dtype=np.float64)
