"""What a record must not be, and what one should know of it, before dynamics are identified."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError, NotIdentifiableError
from hyst.signals import Record

Array = NDArray[np.float64]

_RUN = 4  # samples that rest at an extreme of the record before that looks like a limit
_SHARE = 1e-3


def check_records(records: Sequence[Record]) -> tuple[str, ...]:
    """Refuse outputs that rest; report outputs cut off at the ends of a sensor's range.

    Parameters
    ----------
    records
        To be identified from.

    Returns
    -------
    tuple of str
        A sentence for each record with flat tops.

    Raises
    ------
    NotIdentifiableError
        If an output is constant.
    """
    notes: list[str] = []
    for number, record in enumerate(records, 1):
        if np.ptp(record.y) == 0.0:
            raise NotIdentifiableError(
                f"the output of record {number} is constant ({record.y[0]:.6g}); check the sensor "
                "and the column"
            )
        for end, value in (("top", float(record.y.max())), ("bottom", float(record.y.min()))):
            flat = samples_in_flat_runs(record.y == value)
            if flat >= max(_RUN, _SHARE * len(record)):
                notes.append(
                    f"record {number} rests at its {end}, {value:.6g}, for {flat} samples: the "
                    "sensor or converter looks saturated, which bends the model; lower the drive "
                    "or the sensor's gain"
                )
    return tuple(notes)


def check_sample_time(validation: Sequence[Record], dt: float) -> None:
    """Refuse to judge dynamics by records of another sample time.

    Parameters
    ----------
    validation
        To be judged by.
    dt
        Sample time of the dynamics, s.

    Raises
    ------
    InputError
        If a sample time differs.
    """
    for number, record in enumerate(validation, 1):
        if not np.isclose(record.dt, dt, rtol=1e-6, atol=0.0):
            raise InputError(
                f"validation record {number} has dt = {record.dt:.6g} s, the training records "
                f"{dt:.6g} s; sampled dynamics hold for one sample time, so give records of it"
            )


def samples_in_flat_runs(at_end: NDArray[np.bool_]) -> int:
    """Count the samples in runs of at least four."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], at_end.astype(np.int8), [0]])))
    lengths = edges[1::2] - edges[::2]
    return int(lengths[lengths >= _RUN].sum())
