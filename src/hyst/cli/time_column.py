"""The time column of what is written along a file that was read."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import hyst


def time_column(
    file: Path, rate: float | None, dt: float | None, samples: int, **how: Any
) -> tuple[list[str], list[NDArray[np.float64]]]:
    """Give header and stamps of a file, or those that a rate or a sample time makes; else none.

    Parameters
    ----------
    file
        The file that was read.
    rate
        Samples per second, as the user says; before anything else.
    dt
        Sample time of the model, s, if it depends on it.
    samples
        Number of rows to be written.
    how
        Options of reading, as of ``hyst.io.read_column``.
    """
    if rate is None:
        found = hyst.io.read_time_column(file, **how)
        if found is not None and found[1].size == samples:
            return [found[0]], [found[1]]
    step = dt if rate is None else 1.0 / rate
    if step is None:
        return [], []
    # Divided and not multiplied where there is a rate: 3 / 10 is 0.3, and 3 * 0.1 is not.
    counts = np.arange(samples, dtype=np.float64)
    stamps = counts * step if rate is None else counts / rate
    return ["time [s]"], [stamps]
