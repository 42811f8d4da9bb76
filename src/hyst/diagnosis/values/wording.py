"""How findings on values name samples, amounts and channels."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.evidence import Evidence

_NAMED = 12


def amount(value: float, unit: str) -> str:
    """Give a ``value`` in four digits with its ``unit``."""
    return f"{value:.4g} {unit}".rstrip()


def samples_counted(count: int) -> str:
    """Give a number of samples in words that fit it."""
    return "1 sample" if count == 1 else f"{count:,} samples"


def indices(samples: NDArray[np.intp]) -> str:
    """Name samples by their indices, neighbours together, at most a dozen of them."""
    ends = np.flatnonzero(np.diff(samples) > 1)
    first = samples[np.concatenate(([0], ends + 1))]
    last = samples[np.concatenate((ends, [samples.size - 1]))]
    parts = [
        f"{begin}" if begin == stop else f"{begin} to {stop}"
        for begin, stop in zip(first[:_NAMED].tolist(), last[:_NAMED].tolist(), strict=True)
    ]
    if first.size > _NAMED:
        return f"index {', '.join(parts)} and {first.size - _NAMED} more places"
    return "index " + (" and ".join(filter(None, (", ".join(parts[:-1]), parts[-1]))))


def subject(evidence: Evidence, number: int, channel: str) -> str:
    """Begin a sentence on a ``channel``, of the ``number`` that it has if ``evidence`` has more."""
    return f"the {channel}" if len(evidence.records) == 1 else f"the {channel} of record {number}"
