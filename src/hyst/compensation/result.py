"""What a compensation gives back."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Compensation:
    """A command, and what the model says it will do.

    Parameters
    ----------
    u
        Command, shape (N,), input units.
    y_ref
        Wanted output, shape (N,), output units.
    y_predicted
        The model's output for ``u``, shape (N,), output units.
    method
        How the command was computed.
    clipped
        Number of samples at which the command was held at an end of the input range.
    status
        ``solved`` in one pass, ``converged`` or ``iteration limit``.
    iterations
        Steps of the solver.
    notes
        What the user should know of how well the problem was posed, in sentences.
    interior
        First sample and the one beyond the last for which the method promises what it does; outside
        them are the edges, of which it assumes something. None if there are none.

    Examples
    --------
    >>> done = Compensation(np.zeros(2), np.zeros(2), np.array([3.0, -4.0]), "exact", 0)
    >>> done.max_abs, round(done.rms**2, 12), done.percent_of_range(done.rms)
    (4.0, 12.5, None)
    """

    u: Array
    y_ref: Array
    y_predicted: Array
    method: str
    clipped: int
    status: str = "solved"
    iterations: int = 1
    notes: tuple[str, ...] = ()
    interior: tuple[int, int] | None = None

    @cached_property
    def predicted_error(self) -> Array:
        """``y_predicted - y_ref``, shape (N,), output units."""
        return self.y_predicted - self.y_ref

    @property
    def rms(self) -> float:
        """Root mean square of the predicted error, output units."""
        return math.sqrt(float(np.mean(np.square(self.predicted_error))))

    @property
    def max_abs(self) -> float:
        """Largest absolute predicted error, output units."""
        return float(np.max(np.abs(self.predicted_error)))

    @property
    def total_variation(self) -> float | None:
        """Total variation of the command over that of the reference; None for one at rest."""
        return _ratio(np.sum, self.u, self.y_ref)

    @property
    def peak_rate(self) -> float | None:
        """Largest rate of the command over that of the reference; None for one at rest."""
        return _ratio(np.max, self.u, self.y_ref)

    @property
    def reversals(self) -> int:
        """How often the command turns; many more than the reference's mean that it chatters."""
        moves = np.diff(self.u)
        turns = np.diff(np.sign(moves[moves != 0.0]))
        return int(np.count_nonzero(turns))

    def percent_of_range(self, value: float) -> float | None:
        """Give an error in percent of the range of the wanted output.

        Parameters
        ----------
        value
            An error, output units.

        Returns
        -------
        float or None
            None if the wanted output does not move.
        """
        extent = float(np.ptp(self.y_ref))
        return 100.0 * value / extent if extent > 0.0 else None


@dataclass(frozen=True)
class ErrorPart:
    """The predicted error over some samples.

    Parameters
    ----------
    name
        Which samples.
    rms, max_abs
        Output units.
    """

    name: str
    rms: float
    max_abs: float


def error_parts(done: Compensation) -> tuple[ErrorPart, ...]:
    """Give the error over all samples and, where there are edges, over interior and edges.

    Parameters
    ----------
    done
        A compensation.

    Returns
    -------
    tuple of ErrorPart
    """
    error = done.predicted_error
    whole = ErrorPart("", done.rms, done.max_abs)
    if done.interior is None:
        return (whole,)
    first, beyond = done.interior
    inside = error[first:beyond]
    edges = np.concatenate([error[:first], error[beyond:]])
    named = ((f"samples {first} to {beyond - 1}", inside), ("the edges", edges))
    return (
        whole,
        *(
            ErrorPart(name, math.sqrt(float(np.mean(part**2))), float(np.abs(part).max()))
            for name, part in named
            if part.size
        ),
    )


def _ratio(measure: Callable[..., float], u: Array, y_ref: Array) -> float | None:
    wanted = float(measure(np.abs(np.diff(y_ref)), initial=0.0))
    return float(measure(np.abs(np.diff(u)), initial=0.0)) / wanted if wanted > 0.0 else None
