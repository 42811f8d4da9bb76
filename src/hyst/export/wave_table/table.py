"""Export as a waveform table, for controllers that run no code."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import one_record
from hyst.checks.numbers import as_number, as_positive, as_sample_time, whole_number
from hyst.errors import InputError
from hyst.export.wave_table.kept import Kept
from hyst.export.wave_table.played import HeldError, command_of, output_of
from hyst.export.wave_table.resampling import Resampled, resampled
from hyst.operators import Driver, ModelDescription, Operator
from hyst.operators.verdict import refuse_if_unfit

Array = NDArray[np.float64]

_MOST_BITS = 31


@final
@dataclass(frozen=True, eq=False, repr=False)
class Waveform:
    """A table of drives that a controller gives one after the other, each held until the next.

    Parameters
    ----------
    u
        The drive wanted at each point, shape (N,), input units.
    codes
        Codes of the driver nearest to it; None without a driver.
    played
        The drive that is given: volts of the codes, or ``u``.
    dt
        From point to point, s.
    driver
        Whose codes they are.
    limits
        That all of ``played`` keep.
    command_error
        By how much what is played is off the command, at the points and while it is held.
    sentences
        How the points were made, and what else is to be known.
    y_ref, y_predicted
        Wanted output and the model's, shape (N,), with a model only; of a wave that repeats, in the
        cycle that it comes to.
    repeat
        Whether the first point follows the last.
    error, first_error
        Of the output predicted against the wanted one: in that cycle, and in the first pass. What
        is held is told of models that any sample time suits; else it is as at the points.
    """

    u: Array
    codes: NDArray[np.int64] | None
    played: Array
    dt: float
    driver: Driver | None
    limits: tuple[float, float]
    command_error: HeldError
    sentences: tuple[str, ...]
    y_ref: Array | None = None
    y_predicted: Array | None = None
    error: HeldError | None = None
    first_error: HeldError | None = None
    repeat: bool = False

    def __repr__(self) -> str:
        codes = "" if self.codes is None else f", codes {self.codes.min()} to {self.codes.max()}"
        return (
            f"Waveform({self.u.size} points every {self.dt:.6g} s, {self.played.min():.6g} to "
            f"{self.played.max():.6g}{codes})"
        )

    @property
    def largest_rate(self) -> float:
        """Largest rate of the drive wanted, per second; where it repeats, back to its start too."""
        return _largest_step(self.u, self.repeat) / self.dt

    def columns(self, name: str = "u", unit: str = "") -> tuple[list[str], list[NDArray[Any]]]:
        """Give headers and columns of the table's file, as ``hyst.io.write_columns`` takes them.

        Parameters
        ----------
        name, unit
            Of the drive.
        """
        headers = ["time [s]", f"{name} [{unit}]" if unit else name]
        counts, rate = np.arange(self.u.size, dtype=np.float64), round(1.0 / self.dt)
        # Divided where the rate is whole: 3 / 10 is 0.3, and 3 * 0.1 is not.
        is_whole = abs(rate * self.dt - 1.0) < 1e-12
        columns: list[NDArray[Any]] = [counts / rate if is_whole else counts * self.dt, self.played]
        if self.codes is not None:
            headers.append("code")
            columns.append(self.codes)
        return headers, columns


def waveform(
    signal: ArrayLike,
    dt: float,
    *,
    controller_rate: float | None = None,
    limits: tuple[float, float] | None = None,
    slew: float | None = None,
    driver: Driver | None = None,
    bits: int | None = None,
    points: int | None = None,
    repeat: bool = False,
    model: Operator | None = None,
    history: Sequence[float] | None = None,
    despite_verdict: bool = False,
) -> Waveform:
    """Give a command, or the command of a wanted output, as a table at a controller's sample time.

    Parameters
    ----------
    signal
        The command, shape (n,), input units; with a model the wanted output, output units.
    dt
        From sample to sample of it, s.
    controller_rate
        Points per second; as many as samples if left out. Where one rate is a whole multiple of the
        other, samples are points unchanged; else, and in between, points are on straight lines.
    limits
        Lowest and highest drive; left out, those of the model's record, or of the driver.
    slew
        Largest rate of the drive, input units per second.
    driver
        Table of the converter: the points are given in its codes too, by the nearest volts; that of
        the model's description if left out.
    bits
        Instead of a driver: codes 0 to 2**bits - 1 for the limits and evenly between, 1 to 31.
    points
        Most points that the controller has.
    repeat
        Whether it plays the table again and again: the first point follows the last.
    model
        Of the actuator: the command is exact for it, and of a wave that repeats that of the steady
        cycle, with the memory that the cycles before left.
    history
        With a model: the drive before the first point.
    despite_verdict
        Go on with a model whose verdict is ``unfit``.

    Returns
    -------
    Waveform

    Raises
    ------
    InputError
        If an argument cannot be used, no limits are known, a point leaves them or is too fast for
        ``slew`` (the first is named), a wave that repeats does not end where it begins or is no
        whole number of points, there are too many points, or the verdict on the model is ``unfit``.
    NotInvertibleError
        If the model has no exact inverse.

    Examples
    --------
    >>> ramp = np.linspace(0.0, 10.0, 11)
    >>> table = waveform(ramp, 0.1, controller_rate=5, limits=(0, 10), bits=8)
    >>> table.u, table.codes
    (array([ 0.,  2.,  4.,  6.,  8., 10.]), array([  0,  51, 102, 153, 204, 255]))
    """
    given, step = one_record(signal, "signal"), as_sample_time(dt)
    wanted = step
    if controller_rate is not None:
        wanted = 1.0 / as_positive(controller_rate, "controller_rate", "points per second")
    if model is not None and not isinstance(model, Operator):
        raise InputError(f"model is a {type(model).__name__}; give an operator")
    if driver is not None and not isinstance(driver, Driver):
        raise InputError(f"driver is a {type(driver).__name__}; give a hyst.Driver")
    about = ModelDescription() if model is None else model.description
    refuse_if_unfit(about.verdict, "no table is made", despite_verdict)
    table = driver if bits is not None else driver or about.driver
    ends = _limits(limits, about, table)
    if bits is not None:
        table = _even(bits, ends, driver, about.input_unit)
    kept = Kept(ends, _slew(slew), _points(points), repeat)
    even = _at_points(given, (step, wanted), repeat, model)
    kept.require_points(even.values.size, wanted)
    before = _history(history, model)
    u = even.values
    if model is not None:
        u = command_of(model, u, ends, repeat, before, despite_verdict)
    found = _checked(u, wanted, kept, table, about)
    found = replace(found, sentences=(even.sentence, *_notes(given, found, kept)))
    return found if model is None else _predicted(found, model, even.values, repeat, before)


def _at_points(
    given: Array, times: tuple[float, float], repeat: bool, model: Operator | None
) -> Resampled:
    """Give a signal at the controller's sample time, which must be the model's if it has one."""
    if model is None:
        return resampled(given, *times, repeat, "the command", "")
    if model.dt is not None:
        model.require_sample_time(times[1], "the controller")
    return resampled(given, *times, repeat, "the wanted output", model.description.output_unit)


def _checked(
    u: Array, dt: float, kept: Kept, table: Driver | None, about: ModelDescription
) -> Waveform:
    """Give the table of a drive that keeps what it must."""
    unit = f" {about.input_unit}" if about.input_unit else ""
    u = kept.within(u, dt, unit)
    kept.require_slew(u, dt, unit)
    codes = None if table is None else table.codes(u, kept.limits)
    played = u if codes is None or table is None else table.volts(codes)
    off = HeldError.of(played, u, kept.repeat)
    return Waveform(u, codes, played, dt, table, kept.limits, off, (), repeat=kept.repeat)


def _largest_step(u: Array, repeat: bool) -> float:
    """Give the largest way from point to point, the way back to the first one included."""
    ends = np.append(u, u[0]) if repeat else u
    return float(np.abs(np.diff(ends)).max(initial=0.0))


def _predicted(
    found: Waveform, model: Operator, y_ref: Array, repeat: bool, history: list[float] | None
) -> Waveform:
    """Give a table with the output that the model predicts of what is played."""
    first, steady = output_of(model, found.played, repeat, history)
    return replace(
        found,
        y_ref=y_ref,
        y_predicted=steady,
        error=_error(steady, y_ref, repeat, model.dt),
        first_error=_error(first, y_ref, repeat, model.dt),
    )


def _history(history: Sequence[float] | None, model: Operator | None) -> list[float] | None:
    if history is None:
        return None
    if model is None:
        raise InputError("history is of a model's memory, and there is no model; leave it out")
    before: list[float] = one_record(history, "history").tolist()
    return before


def _error(y: Array, y_ref: Array, repeat: bool, dt: float | None) -> HeldError:
    """Give the error; a model that is known at its samples only has none in between."""
    found = HeldError.of(y, y_ref, repeat)
    return found if dt is None else HeldError(found.rms, found.max_abs, found.rms, found.max_abs)


def _limits(
    limits: tuple[float, float] | None, about: ModelDescription, driver: Driver | None
) -> tuple[float, float]:
    """Give the limits that hold: those asked for or of the record, within what a driver gives."""
    if limits is not None:
        if not isinstance(limits, tuple | list) or len(limits) != 2:
            raise InputError(f"limits is {limits!r}; give the lowest and the highest drive")
        low, high = (as_number(each, "a limit") for each in limits)
        if not low < high:
            raise InputError(f"limits is {limits!r}; give the lower one first")
    elif about.input_low is not None and about.input_high is not None:
        low, high = about.input_low, about.input_high
    elif driver is not None:
        return driver.volt_range
    else:
        raise InputError("no limits of the drive are known; give the lowest and the highest")
    if driver is None:
        return low, high
    driver.codes_within(low, high)
    return max(low, driver.volt_range[0]), min(high, driver.volt_range[1])


def _even(bits: int, limits: tuple[float, float], driver: Driver | None, unit: str) -> Driver:
    """Give the driver of so many bits over the limits."""
    if driver is not None:
        raise InputError("bits and a driver are both given; give one of them")
    last = 2 ** whole_number(bits, "bits", 1, _MOST_BITS) - 1
    return Driver((0, last), limits, unit)


def _slew(slew: float | None) -> float | None:
    return None if slew is None else as_positive(slew, "slew", "a rate per second")


def _points(points: int | None) -> int | None:
    return None if points is None else whole_number(points, "points", 1)


def _notes(given: Array, found: Waveform, kept: Kept) -> tuple[str, ...]:
    """Say what a user would want to know and no check refuses."""
    told, u = [], found.u
    # A rest on both sides of the end is one rest.
    moves = given.size > 2 and given[1] != given[0] and given[-2] != given[-1]
    if kept.repeat and moves and given[-1] == given[0]:
        told.append(
            "the last sample is the first one again, so the value is held twice; if the file ends "
            "with the start of the next period, leave that row out"
        )
    if not kept.repeat and u.size > 1 and u[-1] != u[0]:
        told.append(
            f"played again, the drive would go from {u[-1]:.6g} to {u[0]:.6g} at once; ask for a "
            "wave that repeats to have that checked"
        )
    if kept.slew is not None:
        fastest = _largest_step(found.played, kept.repeat) / found.dt
        if fastest > kept.slew * (1.0 + 1e-9):
            told.append(
                f"the drive wanted keeps the slew, its codes move by up to {fastest:.6g} per "
                "second, for a code is a step"
            )
    return tuple(told)
