"""What rates and sample times of the records mean for a model that depends on the rate."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.record_use.used_samples import Data
from hyst.signals import Record, reversals

Array = NDArray[np.float64]

ONE_FREQUENCY = 1.2
"""Half swings whose durations differ by less than this factor all belong to one frequency."""


def frequency_note(data: Data) -> tuple[str, ...]:
    """Say what it means if the records hold one frequency only; nothing if they hold more.

    Parameters
    ----------
    data
        The records.
    """
    durations = np.concatenate([_half_swings(record) for record in data.records])
    if durations.max() > ONE_FREQUENCY * durations.min():
        return ()
    frequency = 0.5 / float(np.median(durations))
    return (
        f"all records turn at one frequency, {frequency:.4g} Hz: beta and a linear lag cannot be "
        "told apart; beta was left at 0, so the model holds at that frequency only; add records at "
        "other frequencies",
    )


def _half_swings(record: Record) -> Array:
    """Give the durations between turns, s; of a record that turns once the longer side of it."""
    turns = reversals(record.u, 0.05 * float(np.ptp(record.u)))
    ends = [0, record.u.size - 1]
    samples = np.diff(turns) if turns.size > 1 else [np.diff(np.insert(ends, 1, turns)).max()]
    return np.asarray(record.dt * np.asarray(samples, dtype=np.float64))


def sample_times_note(data: Data) -> tuple[str, ...]:
    """Say for which of several sample times the model is written.

    Parameters
    ----------
    data
        The records.
    """
    times = [each.dt for each in data.records]
    if max(times) <= (1.0 + 1e-6) * min(times):
        return ()
    return (
        f"the records have sample times from {min(times):.4g} to {max(times):.4g} s; the model is "
        f"written for that of the first, {times[0]:.4g} s; as its rates are per second, "
        "model.at_sample_time(dt) gives it for any other",
    )
