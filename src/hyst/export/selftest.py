"""The self-test of an export: an input, and what Python makes of it in the target's precision."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from hyst.export.amplitude import drive_for
from hyst.export.block import Block, stepper_of
from hyst.export.drive import Array, Drive
from hyst.export.numbers import Precision
from hyst.operators import ModelDescription

SEEDS = (1, 2)
BAD = (500, 750)
"""Seed of every input, and which sample of every period is not finite."""


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
    """

    drive: Drive
    expected: Array
    away_from_double: float

    @classmethod
    def of(cls, block: Block, precision: Precision, about: ModelDescription) -> SelfTest:
        """Run a ``block`` in a ``precision``, over the input range that ``about`` tells, if any."""
        low, high = about.input_low, about.input_high
        if len(block.inputs) == 1 and low is not None and high is not None and low < high:
            drive = Drive.between(low, high)
        else:
            drive = drive_for(block.chain)
        expected = _outputs(block, drive, precision)
        exact = expected if precision == "double" else _outputs(block, drive, "double")
        return cls(drive, expected, float(np.abs(expected - exact).max()))


def _outputs(block: Block, drive: Drive, precision: Precision) -> Array:
    step = stepper_of(block, precision)
    signals = [
        drive.samples(seed, bad).tolist()
        for _, seed, bad in zip(block.inputs, SEEDS, BAD, strict=False)
    ]
    return np.array([step(*sample) for sample in zip(*signals, strict=True)])
