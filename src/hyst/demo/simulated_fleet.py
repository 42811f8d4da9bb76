"""A simulated production lot: actuators of several types that scatter, with a few odd ones."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hyst._files import replacing
from hyst.checks.numbers import whole_number
from hyst.io import write_columns
from hyst.models import PrandtlIshlinskii
from hyst.operators import DeadZone
from hyst.signals import Record

Array = NDArray[np.float64]

TYPES = 12
"""Shapes of hysteresis in a lot."""

SCATTER = 0.05
"""Of each constant from device to device, share of its value."""

NOISE = 0.003
"""Of the sensor, share of the stroke."""

LEAST = 20
"""Devices, of which five are odd or broken."""

_DT = 1e-3
_SAMPLES = 500
_RADII = np.array([4.0, 11.0, 22.0, 36.0])
_WEIGHTS = np.array([0.05, 0.04, 0.03, 0.02])


@dataclass(frozen=True, eq=False)
class SimulatedDevice:
    """One device of a simulated lot.

    Parameters
    ----------
    identifier
        Its serial number.
    record
        Its short record; None where its file is broken.
    oddness
        What is wrong with it; empty for most.
    """

    identifier: str
    record: Record | None
    oddness: str = ""


def simulated_fleet(count: int, types: int = TYPES, seed: int = 1) -> Iterator[SimulatedDevice]:
    """Make the devices of a lot one after the other, three of them odd and two without a record.

    A device has four plays whose weights are those of its type and scatter, as do radii and gain,
    by 5 %; a tenth of a second at each of five amplitudes is recorded, 500 samples in all.

    Parameters
    ----------
    count
        Devices, at least 20.
    types
        Shapes of hysteresis among them, at least 1.
    seed
        Of all that is random.

    Yields
    ------
    SimulatedDevice

    Raises
    ------
    InputError
        If there are too few.

    Examples
    --------
    >>> [each.identifier for each in simulated_fleet(20) if each.oddness]
    ['SN03', 'SN07', 'SN11', 'SN15', 'SN19']
    """
    whole_number(count, "count", LEAST)
    whole_number(types, "types", 1)
    shapes = np.random.default_rng(seed).uniform(0.4, 1.6, (types, _WEIGHTS.size))
    odd = {(2 * k + 1) * count // 10: what for k, what in enumerate(_ODDNESS)}
    for number in range(count):
        random = np.random.default_rng((seed, number))
        shape = shapes[number % types]
        what = odd.get(number, "")
        identifier = f"SN{number + 1:0{len(str(count))}d}"
        record = None if what in _BROKEN else _record(shape, what, random)
        yield SimulatedDevice(identifier, record, what)


_BROKEN = ("a file without numbers", "a file cut short")
_ODDNESS = ("a third too much gain", "half the opening", "a rail that saturates", *_BROKEN)


def write_simulated_fleet(
    folder: Path, count: int, types: int = TYPES, seed: int = 1
) -> list[SimulatedDevice]:
    """Write the records of a simulated lot, a CSV file a device; give those that are odd.

    Parameters
    ----------
    folder
        Made if it is not there.
    count, types, seed
        As of ``simulated_fleet``.
    """
    odd = []
    for each in simulated_fleet(count, types, seed):
        path = folder / f"{each.identifier}.csv"
        if each.oddness:
            odd.append(each)
        if each.record is None:
            _write_broken(path, each.oddness)
            continue
        signals = each.record.time, each.record.u, each.record.y
        write_columns(path, ("time [s]", "drive [V]", "position [um]"), signals)
    return odd


def _record(shape: Array, what: str, random: np.random.Generator) -> Record:
    u = _drive()
    scattered = 1.0 + SCATTER * random.standard_normal(2 * _RADII.size + 1)
    weights = _WEIGHTS * shape * scattered[: _RADII.size]
    radii = np.sort(_RADII * scattered[_RADII.size : -1])
    straight, gain = 0.12, float(scattered[-1])
    if what == "a third too much gain":
        gain *= 4.0 / 3.0
    if what == "half the opening":
        weights, straight = 0.5 * weights, straight + 0.5 * float(weights.sum())
    y = gain * PrandtlIshlinskii(weights, radii, straight)(u - u[0])
    if what == "a rail that saturates":
        y = DeadZone([1.0, -0.6], [0.0, 0.7 * float(y.max())])(y)
    y = y + NOISE * np.ptp(y) * random.standard_normal(y.size)
    return Record(u, y, _DT, "drive", "position", "V", "um")


def _drive() -> Array:
    """Give five periods between 0 and 100 V, each smaller than the one before."""
    t = _DT * np.arange(_SAMPLES)
    amplitude = 50.0 - 8.0 * np.floor(t / (_SAMPLES * _DT / 5.0))
    return np.asarray(50.0 - amplitude * np.cos(2.0 * np.pi * t * 5.0 / (_SAMPLES * _DT)))


def _write_broken(path: Path, what: str) -> None:
    with replacing(path) as temporary:
        text = "time [s],drive [V],position [um]\n"
        if what == "a file cut short":
            text += "0.0,0.0,0.0\n0.001,0.1"
        temporary.write_text(text, encoding="utf-8")
