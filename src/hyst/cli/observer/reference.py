"""The reference of a spec: sines around an offset, begun smoothly where the stage rests."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.checks.numbers import as_not_negative, said
from hyst.cli.spec_section import Section

if TYPE_CHECKING:
    from hyst.control import LinearSystem

Array = NDArray[np.float64]

_STARTS = ("rest", "settled")


@dataclass(frozen=True, eq=False)
class SpecifiedReference:
    """The reference, and how the loop starts.

    Parameters
    ----------
    samples
        Shape (N,).
    start
        ``"rest"`` or ``"settled"``, as ``simulate_closed_loop`` takes it.
    """

    samples: Array
    start: str


def read_reference(
    given: Section, dt: float, folder: Path, resting: Callable[[], float]
) -> SpecifiedReference:
    """Read the section of the reference.

    ``y_ref = y_0 + b(t) (offset + sum a sin(2 pi f t + phase) - y_0)``, y_0 where the stage rests
    without drive, and b rising from 0 to 1 within ``ramp`` with continuous acceleration; b is 1
    without a ramp.

    Parameters
    ----------
    given
        The section: a file, or sines as [amplitude, Hz] or [amplitude, Hz, degrees].
    dt
        Sample time, s.
    folder
        Of the spec.
    resting
        Gives the output at which the stage rests without drive.

    Returns
    -------
    SpecifiedReference
        It starts settled where there is an offset or a ramp, unless ``start`` says otherwise.

    Raises
    ------
    InputError
        If an entry is wrong.
    """
    if given.has("file"):
        start = given.text("start", "rest", _STARTS)
        path, column = given.text("file"), given.whole("column")
        given.done()
        if isinstance(column, bool) or not isinstance(column, int | str):
            raise hyst.InputError(f"[reference] column is {column!r}; give a name or an index")
        return SpecifiedReference(hyst.io.read_column(folder / path, column)[0], start)
    sines, duration = _sines(given), given.number("duration", positive=True)
    offset = given.number("offset", 0.0)
    ramp = as_not_negative(given.number("ramp", 0.0), "[reference] ramp", "a time in s")
    moved = offset != 0.0 or ramp > 0.0
    start = given.text("start", "settled" if moved else "rest", _STARTS)
    given.done()
    samples = round(duration / dt)
    if not 2 <= samples <= 10_000_000:
        raise hyst.InputError(
            f"[reference] duration is {duration:g} s, {samples} samples of {dt:g} s; give "
            "2 to 10 million"
        )
    if ramp >= duration:
        raise hyst.InputError(
            f"[reference] ramp is {ramp:g} s of {duration:g} s; leave some to follow"
        )
    for _, frequency, _ in sines:
        if abs(frequency) * dt >= 0.5:
            raise hyst.InputError(
                f"[reference] sines has {frequency:g} Hz, and half the sample rate is "
                f"{0.5 / dt:g} Hz: its samples would show a slower one; lower it"
            )
    t = np.arange(samples, dtype=np.float64) * dt
    wanted = np.asarray(sum(a * np.sin(2.0 * np.pi * f * t + p) for a, f, p in sines))
    if moved:
        wanted = wanted + offset
    if ramp > 0.0:
        begin = resting()
        wanted = begin + smooth_step(np.asarray(t / ramp)) * (wanted - begin)
    return SpecifiedReference(wanted, start)


def smooth_step(x: Array) -> Array:
    """Rise from 0 at 0 to 1 at 1 without a jump of velocity or acceleration.

    ``10 x^3 - 15 x^4 + 6 x^5``

    Parameters
    ----------
    x
        Shape (N,); below 0 it is 0, above 1 it is 1.

    Returns
    -------
    numpy.ndarray
        Shape (N,).
    """
    inside = np.clip(x, 0.0, 1.0)
    return np.asarray(inside**3 * (10.0 + inside * (6.0 * inside - 15.0)))


def resting_output(hysteresis: hyst.Operator, plant: LinearSystem) -> float:
    """Give the output without drive: the plant's static gain times what the hysteresis gives at 0.

    Parameters
    ----------
    hysteresis
        In its initial state.
    plant
        Nominal.

    Returns
    -------
    float

    Raises
    ------
    InputError
        If the plant does not rest.
    """
    gain = hyst.control.static_gain(plant)
    if not np.isfinite(gain):
        raise hyst.InputError(
            "[reference] ramp begins where the stage rests, and the plant, with a pole at the "
            "origin, does not; leave it out"
        )
    return gain * float(hysteresis(np.zeros(1))[0])


def _sines(given: Section) -> list[tuple[float, float, float]]:
    rows = given.whole("sines")
    if not isinstance(rows, list) or not rows:
        raise hyst.InputError(
            f"[reference] sines is {said(rows)}; give pairs as [[18.0, 1.0]], or with a phase in "
            "degrees [[18.0, 1.0, 90.0]]"
        )
    found = []
    for row in rows:
        numbers = Section({"sines": row}, "[reference]").numbers("sines")
        if numbers.size not in (2, 3):
            raise hyst.InputError(
                f"[reference] sines has {said(row)}; give [amplitude, Hz], or [amplitude, Hz, "
                "degrees]"
            )
        phase = float(np.radians(numbers[2])) if numbers.size == 3 else 0.0
        found.append((float(numbers[0]), float(numbers[1]), phase))
    return found
