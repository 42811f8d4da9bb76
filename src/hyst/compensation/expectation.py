"""The tracking error to expect of an actuator, and where nothing is known of it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.operators import ModelDescription
from hyst.signals.turning_points import swings_of

Array = NDArray[np.float64]

_SMALLER = 0.9  # of the smallest swing of the record: below, a loop is one it did not show
_ROUNDING = 1e-9  # of a range: what an output may leave it by without leaving it


@dataclass(frozen=True)
class ModelError:
    """By how much a model missed a measured record.

    Parameters
    ----------
    record
        Which: the validation record it missed most, or that it was identified from.
    rms, max_abs
        Output units.
    disturbed
        The same two with what was taken out of the record before the fit, as drift; None if
        nothing was.
    """

    record: str
    rms: float
    max_abs: float
    disturbed: tuple[float, float] | None = None


def error_to_expect(about: ModelDescription) -> ModelError | None:
    """Give by how much a model missed a record: one it has not seen if there is one.

    Parameters
    ----------
    about
        Of the model.

    Returns
    -------
    ModelError or None
        None if the description does not tell.
    """
    told = {
        record: (errors["rms"], errors["max_abs"])
        for record, errors in about.errors.items()
        if {"rms", "max_abs"} <= set(errors)
    }
    known = [
        ModelError(record, *errors, told.get(f"{record}, disturbances left in"))
        for record, errors in told.items()
        if "," not in record  # the others are of the same records, otherwise
    ]
    unseen = [each for each in known if each.record.startswith("validation")]
    return max(unseen or known, key=lambda each: each.rms, default=None)


def expectation_of(
    rms: float, max_abs: float, exact: bool, expected: ModelError | None, unit: str
) -> str:
    """Say which tracking error to expect.

    Parameters
    ----------
    rms, max_abs
        Of the model's output against the reference, output units.
    exact
        Whether that is rounding.
    expected
        What the model itself missed.
    unit
        Of the output.

    Returns
    -------
    str
    """
    behind = f" {unit}" if unit else ""
    if exact:
        model = f"exact for the model (rounding {_rounded(rms)}{behind})"
    else:
        model = f"the model misses the reference by {rms:.3g}{behind} rms, {max_abs:.3g} at most"
    if expected is None:
        return (
            f"{model}; how far the actuator is from the model is not known, for the model tells no "
            "errors"
        )
    more = ""
    if expected.disturbed is not None:
        with_all, largest = expected.disturbed
        taken = "with drift and foreign sines, which were taken out"
        more = f"; {with_all:.3g} and {largest:.3g} {taken}"
    return (
        f"{model}; the model itself missed its record by {expected.rms:.3g}{behind} rms, "
        f"{expected.max_abs:.3g} at most ({expected.record}{more}): expect "
        + ("that" if exact else "both together")
    )


def beyond_the_records(about: ModelDescription, u: Array, y_ref: Array) -> tuple[str, ...]:
    """Say where a command leaves what the model's records showed.

    Parameters
    ----------
    about
        Of the model.
    u, y_ref
        Command and wanted output, shape (N,).

    Returns
    -------
    tuple of str
        Sentences; none where it stays within, or the description does not tell.
    """
    signals = (
        ("command", "input", u, about.input_low, about.input_high, about.input_unit),
        ("reference", "output", y_ref, about.output_low, about.output_high, about.output_unit),
    )
    told = []
    for name, side, signal, low, high, unit in signals:
        if low is None or high is None or not _leaves(signal, low, high):
            continue
        told.append(
            f"the {name} goes from {signal.min():.6g} to {signal.max():.6g}, the records showed "
            f"the {side} from {low:.6g} to {high:.6g}{_behind(unit)}; beyond that the error is not "
            "known"
        )
    return (*told, *_smaller_loops(about, u))


def _leaves(signal: Array, low: float, high: float) -> bool:
    slack = _ROUNDING * (high - low)
    return bool(signal.min() < low - slack or signal.max() > high + slack)


def _smaller_loops(about: ModelDescription, u: Array) -> tuple[str, ...]:
    low, high, shown = about.input_low, about.input_high, about.smallest_swing
    if low is None or high is None or shown is None:
        return ()
    swings = swings_of(u, high - low)
    smaller = swings[swings < _SMALLER * shown]
    if not smaller.size:
        return ()
    return (
        f"{smaller.size} {_swings_are(smaller.size)} smaller than any in the records, down to "
        f"{smaller.min():.3g}{_behind(about.input_unit)} where those go down to {shown:.3g}; the "
        "error in such loops is not known",
    )


def _swings_are(count: int) -> str:
    return "swings of the command are" if count > 1 else "swing of the command is"


def _behind(unit: str) -> str:
    return f" {unit}" if unit else ""


def _rounded(rms: float) -> str:
    """Give the size of a rounding error; of it, more than one digit means nothing."""
    return "0" if rms == 0.0 or not math.isfinite(rms) else f"{rms:.0e}"
