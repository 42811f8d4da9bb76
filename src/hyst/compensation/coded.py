"""A command as codes of a driver, and what the model says the codes will do."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import one_record
from hyst.compensation.result import Compensation
from hyst.errors import InputError
from hyst.operators import Driver, Operator

Array = NDArray[np.float64]


@final
@dataclass(frozen=True, eq=False, repr=False)
class CodedCommand:
    """Codes for a command, and the output that the model predicts of their volts.

    Parameters
    ----------
    driver
        Whose codes they are.
    codes
        Shape (N,), whole numbers.
    u
        Volts of the codes, shape (N,), input units.
    y_ref
        Wanted output, shape (N,), output units.
    y_predicted
        The model's output for ``u``, shape (N,), output units: quantisation is in it.
    off
        Most by which ``u`` is off the command, input units: half a step, or more where the command
        is beyond the codes there are.
    """

    driver: Driver
    codes: NDArray[np.int64]
    u: Array
    y_ref: Array
    y_predicted: Array
    off: float

    def __repr__(self) -> str:
        return (
            f"CodedCommand({self.codes.size} samples, codes {self.codes.min()} to "
            f"{self.codes.max()}, error {self.rms:.3g} rms, {self.max_abs:.3g} at most)"
        )

    @property
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

    def told(self, input_unit: str = "", output_unit: str = "") -> str:
        """Say in a sentence what rounding to codes costs.

        Parameters
        ----------
        input_unit, output_unit
            Of the signals.
        """
        volts, output = (f" {each}" if each else "" for each in (input_unit, output_unit))
        return (
            f"as codes {self.codes.min()} to {self.codes.max()}: the drive is at most "
            f"{self.off:.3g}{volts} off the command, and the model then misses the reference by "
            f"{self.rms:.3g}{output} rms, {self.max_abs:.3g} at most"
        )


def in_codes(
    model: Operator,
    done: Compensation,
    driver: Driver | None = None,
    *,
    limits: tuple[float, float] | None = None,
    history: ArrayLike | None = None,
) -> CodedCommand:
    """Give a command as codes of a driver: at each sample the code whose volts are nearest.

    The command is made first and rounded last, so its memory is that of the drive as it was wanted.
    Rounding does not turn a drive that rises or falls, and plays, which take over no more than the
    largest difference of two drives, miss at no time by more than half a step: it does not add up.

    Parameters
    ----------
    model
        That the command was made with.
    done
        The command, as ``invert_trajectory`` gives it.
    driver
        Its table; that of the model's description if left out.
    limits
        Lowest and highest volts that a code may give; those of the table if left out.
    history
        As it was given to ``invert_trajectory``.

    Raises
    ------
    InputError
        If there is no driver, or no code within the limits.

    Examples
    --------
    >>> from hyst.compensation import invert_trajectory
    >>> from hyst.models import PrandtlIshlinskii
    >>> model = PrandtlIshlinskii(p=[0.5], r=[1.0], p0=1.0)
    >>> done = invert_trajectory(model, [0.0, 4.0, 2.5])
    >>> coded = in_codes(model, done, Driver.linear(0.25, 0.0, 0, 40))
    >>> coded.codes, coded.max_abs
    (array([ 0, 12,  6]), 0.0)
    """
    table = driver or model.description.driver
    if table is None:
        raise InputError("the model's description has no driver; give one")
    if not isinstance(table, Driver):
        raise InputError(f"driver is a {type(table).__name__}; give a hyst.Driver")
    codes = table.codes(done.u, limits)
    u = table.volts(codes)
    predicted = done.y_predicted + change_of_output(model, done.u, u, history)
    return CodedCommand(table, codes, u, done.y_ref, predicted, float(np.abs(u - done.u).max()))


def change_of_output(
    model: Operator, u: Array, other: Array, history: ArrayLike | None = None
) -> Array:
    """Give by how much the model's output changes where another drive is applied.

    Parameters
    ----------
    model
        Of the actuator.
    u, other
        The drives, shape (N,).
    history
        Inputs passed before both; none from the model's own start.
    """
    start = model.initial_state()
    if history is not None and np.size(history):
        start = model.run(one_record(history, "history"), start)[1]
    changed: Array = model.run(other, start)[0] - model.run(u, start)[0]
    return changed
