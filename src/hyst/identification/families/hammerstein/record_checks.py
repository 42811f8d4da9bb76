"""What one should know of a record before dynamics are identified: whether its tops are flat."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hyst.errors import NotIdentifiableError
from hyst.identification.record_use.used_samples import Data
from hyst.signals import Record

Array = NDArray[np.float64]

_RUN = 4  # samples that rest at an extreme of the record before that looks like a limit
_SHARE = 1e-3

FEWEST_SAMPLES = 40
"""That can tell a few plays and one pole apart."""


def flat_tops(records: Sequence[Record]) -> tuple[str, ...]:
    """Report outputs cut off at the ends of a sensor's range.

    Parameters
    ----------
    records
        To be identified from.

    Returns
    -------
    tuple of str
        A sentence for each record with flat tops.
    """
    notes: list[str] = []
    for number, record in enumerate(records, 1):
        for end, value in (("top", float(record.y.max())), ("bottom", float(record.y.min()))):
            flat = samples_in_flat_runs(record.y == value)
            if flat >= max(_RUN, _SHARE * len(record)):
                notes.append(
                    f"record {number} rests at its {end}, {value:.6g}, for {flat} samples: the "
                    "sensor or converter looks saturated, which bends the model; lower the drive "
                    "or the sensor's gain"
                )
    return tuple(notes)


def samples_in_flat_runs(at_end: NDArray[np.bool_]) -> int:
    """Count the samples in runs of at least four."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], at_end.astype(np.int8), [0]])))
    lengths = edges[1::2] - edges[::2]
    return int(lengths[lengths >= _RUN].sum())


def require_samples(data: Data) -> None:
    """Refuse records too short to tell dynamics from hysteresis.

    Parameters
    ----------
    data
        The records as they are used.

    Raises
    ------
    NotIdentifiableError
        If there are fewer than forty samples.
    """
    count = sum(window.stop - window.start for window in data.windows())
    if count < FEWEST_SAMPLES:
        raise NotIdentifiableError(
            f"{count} usable samples are too few to tell dynamics from hysteresis; give at least "
            f"{FEWEST_SAMPLES}"
        )
