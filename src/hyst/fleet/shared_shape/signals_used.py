"""The samples of a device's record that count."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.record_use.used_samples import Data, UsedSamples

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Used:
    """One record, from its first sample to the last one used.

    Parameters
    ----------
    dt
        Sample time, s.
    u
        Shape (k,), drive up to the last sample used.
    y
        Shape (n,), output brought forward by the delay, over the window.
    window
        Of ``u``, where outputs are compared; before it the memory is not known.
    samples
        The same in words of identification.
    """

    dt: float
    u: Array
    y: Array
    window: slice
    samples: UsedSamples


def used_of(data: Data) -> Used:
    """Give what counts of a record that identification has prepared.

    Parameters
    ----------
    data
        Of one record.
    """
    window = data.windows()[0]
    drive = np.ascontiguousarray(data.records[0].u[: window.stop])
    return Used(data.records[0].dt, drive, data.outputs()[0], window, data.used()[0])


def drive_of(u: Array, dt: float) -> Used:
    """Give a drive without measured output, all of it.

    Parameters
    ----------
    u
        Shape (N,).
    dt
        Sample time, s.
    """
    every = UsedSamples(0, u.size, u.size)
    return Used(dt, u, np.zeros(u.size), slice(0, u.size), every)
