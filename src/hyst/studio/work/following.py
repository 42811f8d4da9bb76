"""The command for a reference, and how the output is predicted to follow it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.compensation import invert_trajectory, methods_for
from hyst.compensation.result import Compensation
from hyst.errors import InputError, NotInvertibleError
from hyst.identification import Identified
from hyst.studio.drawing.extremes import extreme_samples
from hyst.studio.drawing.plot import Line, Plot
from hyst.studio.work.identifying import FoundModel
from hyst.studio.work.reference import Reference

Array = NDArray[np.float64]

_COLUMNS = 400
# The last ones need many seconds for a reference that is being dragged.
_ORDER = ("exact", "noncausal", "sample-exact", "preview", "explicit", "trajectory")


@dataclass(frozen=True)
class Followed:
    """A command and its prediction as the page shows them.

    Parameters
    ----------
    method
        By which the command was made.
    tracking, command
        Pictures.
    sentences
        What is expected, and what to know.
    """

    method: str
    tracking: str
    command: str
    sentences: tuple[str, ...]


def follow(model: FoundModel, reference: Reference, tell: Callable[..., None]) -> Followed:
    """Make the command for a reference, and predict what the output does.

    Parameters
    ----------
    model, reference
        What is to follow what.
    tell
        Not told anything.

    Raises
    ------
    InputError, NotInvertibleError
        If there is no command.
    """
    found = model.result()
    time, y_ref = reference.sampled(found.model.dt)
    done, method = command_for(found, y_ref)
    dt = None if found.model.dt is not None else float(time[1] - time[0])
    low, high = found.band(done.u, 0.95, dt if found.delay == 0 else None)
    about = found.description
    return Followed(
        method,
        _tracking(time, done, (low, high), _label(about.output_name, about.output_unit, "output")),
        _command(time, done.u, _label(about.input_name, about.input_unit, "input")),
        _sentences(done, found),
    )


def command_for(found: Identified, y_ref: Array) -> tuple[Compensation, str]:
    """Make a command within the range that the records showed, by the first method there is.

    Parameters
    ----------
    found, y_ref
        Model and wanted output.

    Raises
    ------
    InputError, NotInvertibleError
        If there is none.
    """
    about = found.description
    methods = methods_for(found.model)
    if not methods:
        found.model.inverse()  # says why there is none
        raise NotInvertibleError("this model has no inverse, so that no command can be made")
    method = next(each for each in _ORDER if each in methods)
    ends = None
    if about.input_low is not None and about.input_high is not None:
        ends = (about.input_low, about.input_high)
    if method == "noncausal":
        return invert_trajectory(found.model, y_ref, method, input_range=ends), method
    done = invert_trajectory(found.model, y_ref, method, input_range=ends, outside="clip")
    return done, method


def _label(name: str, unit: str, otherwise: str) -> str:
    return f"{name or otherwise} [{unit}]" if unit else name or otherwise


def _sentences(done: Compensation, found: Identified) -> tuple[str, ...]:
    about = found.description
    unit = f" {about.input_unit}" if about.input_unit else ""
    said = [f"Expected: {done.expectation(about.output_unit)}."]
    said.append(f"Command from {done.u.min():.5g} to {done.u.max():.5g}{unit}.")
    if done.clipped:
        said.append(
            f"{done.clipped} of {done.u.size} samples are out of reach: the command is held at an "
            "end of the range that the record showed."
        )
    if about.delay > 0:
        said.append(
            f"The output lags by {about.delay:.3g} samples, which is left out here; the command "
            "line takes it back with hyst compensate --with-delay."
        )
    return (*said, *done.unknown, *done.notes)


def _tracking(time: Array, done: Compensation, band: tuple[Array, Array], label: str) -> str:
    low, high = band
    at = extreme_samples(_COLUMNS, done.y_ref, done.y_predicted)
    both = np.concatenate([at, at[::-1]])
    edge = np.concatenate([low[at], high[at][::-1]])
    lines = (
        Line(time[both], edge, "95 % band", 3, "band"),
        Line(time[at], done.y_predicted[at], "predicted", 1),
        Line(time[at], done.y_ref[at], "wanted", 0, "dashed"),
    )
    worst = float(np.abs(done.y_predicted - done.y_ref).max())
    told = f"Wanted and predicted {label} over time; the prediction is at most {worst:.3g} off"
    return Plot(lines, "time [s]", label, told).svg()


def _command(time: Array, u: Array, label: str) -> str:
    at = extreme_samples(_COLUMNS, u)
    told = f"Command: {label} over time, {u.min():.4g} to {u.max():.4g}"
    return Plot((Line(time[at], u[at], "", 2),), "time [s]", label, told).svg()


def require_commands(model: FoundModel) -> None:
    """Refuse what needs a command of a model that is unfit.

    Raises
    ------
    InputError
        If its verdict is.
    """
    if model.level == "unfit":
        raise InputError(f"{model.name} is unfit: {' '.join(model.sentences)}")
