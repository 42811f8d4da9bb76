"""A measured record: input, output and the time between samples."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.checks.arrays import finite_vector, same_length
from hyst.checks.numbers import as_sample_time
from hyst.errors import InputError


@dataclass(frozen=True, eq=False)
class Record:
    """Input u and output y of a system, sampled every dt seconds.

    ``u[k]`` and ``y[k]`` were taken at ``k dt``. The arrays are read-only copies, so a record
    can be shared without fear. Two records are equal when their signals, ``dt``, names and
    units are equal; the notes do not count.

    Parameters
    ----------
    u
        Input, shape (N,), N >= 1, finite, in ``input_unit``.
    y
        Output, shape (N,), finite, in ``output_unit``.
    dt
        Time between samples, s, finite and > 0.
    input_name, output_name
        What the two signals are called in tables and figures.
    input_unit, output_unit
        Units as text; empty if unknown. They are never converted.
    notes
        What was done to the data before they came here, one sentence each (for instance that
        rows were dropped and the record resampled).

    Raises
    ------
    InputError
        If a signal is empty, not one-dimensional, not real or not finite (the first bad index
        is named), if the lengths differ, or if ``dt`` is not a positive finite number.

    Examples
    --------
    >>> record = Record([0.0, 1.0, 2.0], [0.0, 0.5, 1.5], dt=0.01, input_unit="V")
    >>> record.samples, record.duration, record.rate
    (3, 0.02, 100.0)
    >>> record.slice(1, 3).u
    array([1., 2.])
    """

    u: NDArray[np.float64]
    y: NDArray[np.float64]
    dt: float
    input_name: str = "u"
    output_name: str = "y"
    input_unit: str = ""
    output_unit: str = ""
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        u = finite_vector(self.u, f"input {self.input_name!r}")
        y = finite_vector(self.y, f"output {self.output_name!r}")
        same_length(u, y, f"input {self.input_name!r} and output {self.output_name!r}")
        object.__setattr__(self, "u", u)
        object.__setattr__(self, "y", y)
        object.__setattr__(self, "dt", as_sample_time(self.dt))
        object.__setattr__(self, "notes", tuple(self.notes))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Record):
            return NotImplemented
        return (
            self._labels() == other._labels()
            and np.array_equal(self.u, other.u)
            and np.array_equal(self.y, other.y)
        )

    def __len__(self) -> int:
        return self.samples

    @property
    def samples(self) -> int:
        """Number of samples N."""
        return int(self.u.size)

    @property
    def duration(self) -> float:
        """Time from the first sample to the last, (N - 1) dt, s."""
        return (self.samples - 1) * self.dt

    @property
    def rate(self) -> float:
        """Samples per second, 1 / dt, Hz."""
        return 1.0 / self.dt

    @property
    def time(self) -> NDArray[np.float64]:
        """Time of every sample, k dt, s, shape (N,)."""
        return np.arange(self.samples, dtype=np.float64) * self.dt

    def slice(self, start: int, stop: int) -> Record:
        """Cut out samples ``start`` to ``stop``, the latter excluded.

        Parameters
        ----------
        start, stop
            Sample numbers with 0 <= start < stop <= N.

        Returns
        -------
        Record
            The samples ``u[start:stop]`` and ``y[start:stop]``; everything else is kept.

        Raises
        ------
        InputError
            If the range is empty or reaches outside the record.

        Examples
        --------
        >>> len(Record([0.0, 1.0, 2.0], [0.0, 0.5, 1.5], dt=0.01).slice(0, 2))
        2
        """
        if not 0 <= start < stop <= self.samples:
            raise InputError(
                f"cannot cut samples {start} to {stop} out of a record of {self.samples}; "
                f"choose 0 <= start < stop <= {self.samples}"
            )
        return replace(self, u=self.u[start:stop], y=self.y[start:stop])

    def _labels(self) -> tuple[float | str, ...]:
        return (self.dt, self.input_name, self.output_name, self.input_unit, self.output_unit)
