"""What a compensation gives back."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hyst.compensation.expectation import ModelError, expectation_of

Array = NDArray[np.float64]

_ROUNDING = 1e-9  # of the largest output; an inverse in double leaves some 1e-15


@dataclass(frozen=True, eq=False, repr=False)
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
    expected
        By how much the model itself missed a record, which is what to expect of the actuator beside
        the predicted error; None if the model does not tell.
    unknown
        Where not even that is known, in sentences: the command leaves what the model's records
        showed.
    objective
        Which error the command was polished for, ``rms`` or ``largest``; empty if for none.

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
    expected: ModelError | None = None
    unknown: tuple[str, ...] = ()
    objective: str = ""

    def __repr__(self) -> str:
        return (
            f"Compensation({self.method}, {self.u.size} samples, u {self.u.min():.4g} to "
            f"{self.u.max():.4g}, {self.expectation()})"
        )

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
    def command_size(self) -> float:
        """Largest absolute value of the command, input units."""
        return float(np.max(np.abs(self.u)))

    @property
    def roughness(self) -> float:
        """Root mean square of the command's second differences, input units."""
        bends = np.diff(self.u, 2)
        return math.sqrt(float(np.mean(np.square(bends)))) if bends.size else 0.0

    @property
    def largest_bend(self) -> float:
        """Largest absolute second difference of the command, input units."""
        return float(np.max(np.abs(np.diff(self.u, 2)), initial=0.0))

    def expectation(self, unit: str = "") -> str:
        """Say which tracking error to expect of the actuator: the model's own beside the predicted.

        Parameters
        ----------
        unit
            Of the output.

        Returns
        -------
        str
        """
        return expectation_of(self.rms, self.max_abs, self._is_exact(), self.expected, unit)

    def summary(self, unit: str = "") -> str:
        """Give what there is to know of a command in some lines, the error to expect first.

        Parameters
        ----------
        unit
            Of the output.

        Returns
        -------
        str
        """
        lines = [self.expectation(unit), *self.unknown, *self.notes]
        if self.clipped:
            lines.append(
                f"{self.clipped} of {self.u.size} samples were held at an end of the range"
            )
        return "\n".join(lines)

    def _is_exact(self) -> bool:
        """Whether what is left of the reference is rounding."""
        largest = max(float(np.abs(self.y_ref).max()), float(np.abs(self.y_predicted).max()))
        return self.method == "exact" and self.max_abs <= _ROUNDING * largest

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
