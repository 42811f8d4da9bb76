"""What a record read from a file is compared with."""

from __future__ import annotations

import numpy as np

from hyst.signals import Record


def same_signals(record: Record, u: np.ndarray, y: np.ndarray) -> None:
    """Four decimals were written, and the doubles next to them are read."""
    assert np.array_equal(record.u, np.round(u, 4))
    assert np.array_equal(record.y, np.round(y, 4))
