"""The self-test of an export: an input, and what Python makes of it in the target's precision."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from hyst.export.c.amplitude import drive_for
from hyst.export.c.block import Block, stepper_of
from hyst.export.c.drive import PERIOD, Array, Drive
from hyst.export.c.numbers import Precision
from hyst.operators import ModelDescription

SEEDS = (1, 2)
BAD = (500, 750)
"""Seed of every input, and which sample of every period is not finite."""

SECOND_RESTS = 8
"""Samples for which a second signal rests at each of its values."""


@final
@dataclass(frozen=True, eq=False)
class SelfTest:
    """Input and expected output.

    Parameters
    ----------
    drive
        The input.
    expected
        Shape (samples,), the output in the target's precision, to the last bit.
    away_from_double
        Largest difference of it from the output in double; 0 in double.
    measured
        Shape (samples,), the output that an estimator is given; None for others.
    """

    drive: Drive
    expected: Array
    away_from_double: float
    measured: Array | None = None

    @classmethod
    def of(cls, block: Block, precision: Precision, about: ModelDescription) -> SelfTest:
        """Run a ``block`` in a ``precision``, over the input range that ``about`` tells, if any."""
        low, high = about.input_low, about.input_high
        driven = len(block.inputs) == 1 or block.second
        if block.tested is not None:
            drive = Drive.between(*block.tested)
        elif driven and low is not None and high is not None and low < high:
            drive = Drive.between(low, high)
        else:
            drive = drive_for(block.chain)
        measured = _measured(block, drive) if block.is_estimator else None
        expected = _outputs(block, drive, precision, measured)
        exact = expected if precision == "double" else _outputs(block, drive, "double", measured)
        return cls(drive, expected, float(np.abs(expected - exact).max()), measured)


def _outputs(block: Block, drive: Drive, precision: Precision, measured: Array | None) -> Array:
    step = stepper_of(block, precision)
    signals = [drive.samples(SEEDS[0], BAD[0])]
    if measured is not None:
        with_bad = measured.copy()
        with_bad[BAD[1] :: PERIOD] = np.nan
        signals += [with_bad, measured]
    elif block.second:
        places = (np.arange(signals[0].size) // SECOND_RESTS) % len(block.second)
        second = np.array(block.second)[places]
        second[BAD[1] :: PERIOD] = np.nan
        signals.append(second)
    elif len(block.inputs) == 2:
        signals.append(drive.samples(SEEDS[1], BAD[1]))
    samples = [each.tolist() for each in signals]
    return np.array([step(*sample) for sample in zip(*samples, strict=True)])


def _measured(block: Block, drive: Drive) -> Array:
    """Give the output of a plant that the estimate does not fit, in numbers of single precision."""
    u = drive.samples(SEEDS[0], BAD[0])
    finite = np.where(np.isfinite(u), u, 0.0)
    return (
        (1.1 * block.chain(finite) + 0.05 * block.chain(finite[::-1].copy()))
        .astype(np.float32)
        .astype(np.float64)
    )
