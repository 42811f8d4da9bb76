"""A record that is read in chunks, as often as it is wanted."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray


@runtime_checkable
class RecordStream(Protocol):
    """What identification needs of a record in a file, which ``hyst.io.open_record`` gives.

    Parameters
    ----------
    dt
        Time between samples, s.
    u_unit, y_unit
        Units as text; empty if unknown.
    """

    @property
    def dt(self) -> float:
        """Time between samples, s."""

    @property
    def u_unit(self) -> str:
        """Unit of the input."""

    @property
    def y_unit(self) -> str:
        """Unit of the output."""

    def __len__(self) -> int:
        """Give the number of samples N."""

    def chunks(self, samples: int) -> Iterator[tuple[NDArray[np.float64], NDArray[np.float64]]]:
        """Read the record from its start, so many samples at a time.

        Parameters
        ----------
        samples
            How many in each chunk; the last one may be shorter.
        """
