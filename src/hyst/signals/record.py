"""A measured record: input, output and the time between samples."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np
from numpy.typing import NDArray

from hyst._above import FRAMES, PAGES, PLOTS, above
from hyst.checks.arrays import finite_vector, same_length
from hyst.checks.numbers import as_sample_time
from hyst.errors import InputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from hyst.report.shown.axes import Panels


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

    @classmethod
    def from_dataframe(
        cls,
        frame: Any,
        input: int | str,
        output: int | str,
        *,
        time: int | str | None = None,
        rate: float | None = None,
        **how: Any,
    ) -> Record:
        """Take a record from two columns of a data frame, as pandas or polars have them.

        Columns are looked up, units found, time checked and rows repaired as in
        ``hyst.read_record``; nothing but the columns is read, so any table will do that has
        ``columns`` and gives one by its name.

        Parameters
        ----------
        frame
            The data frame. Units stand in the names of the columns (``drive [V]``), or in the
            frame's ``attrs["units"]``, a dictionary by name of column.
        input, output
            Columns of the input and of the output, by name or 0-based index.
        time
            Column of the time, s unless its name says otherwise, or dates or durations. If neither
            it nor ``rate`` is given, the index of the frame where that is dates, durations or
            floating-point numbers, which are s.
        rate
            Samples per second, Hz, > 0.
        **how
            Further options of ``hyst.read_record``: time_unit, repair, dead_band, longest_gap,
            one_way.

        Returns
        -------
        Record
            Its notes tell what was found out, left out and repaired.

        Raises
        ------
        InputError
            If it is no data frame, a column is missing, given twice, or holds text, NaN or
            infinity; if time is not known, does not increase or is uneven; if a signal is
            constant, or the input neither turns twice nor goes through one whole loop.

        Examples
        --------
        ::

            record = hyst.Record.from_dataframe(frame, "drive", "position", rate=1000)
        """
        found: Record = above(FRAMES, "record_of_frame")(frame, input, output, time, rate, how)
        return found

    @classmethod
    def from_xarray(
        cls,
        data: Any,
        input: str,
        output: str,
        *,
        time: str = "time",
        rate: float | None = None,
        **how: Any,
    ) -> Record:
        """Take a record from two variables of a Dataset of xarray, or two channels of a DataArray.

        Parameters
        ----------
        data
            A Dataset whose variables have ``time`` as their only dimension, or a DataArray with
            ``time`` and one more dimension, whose labels are the names of the channels. Units are
            taken from ``attrs["units"]``, or from the names.
        input, output
            Variables, or labels of channels.
        time
            Coordinate of the time: dates, durations, or numbers in its ``attrs["units"]``, s if it
            has none.
        rate
            Samples per second, Hz, > 0, in the place of the coordinate.
        **how
            As of ``from_dataframe``.

        Returns
        -------
        Record

        Raises
        ------
        InputError
            If it is neither, has no such variable, channel or coordinate, more dimensions, or as
            ``from_dataframe``.

        Examples
        --------
        ::

            record = hyst.Record.from_xarray(dataset, "drive", "position")
        """
        found: Record = above(FRAMES, "record_of_arrays")(data, input, output, time, rate, how)
        return found

    @overload
    def plot(  # type: ignore[overload-overlap]
        self, axes: Axes | None = ..., *, what: str = ..., interactive: Literal[False] = ...
    ) -> Axes: ...
    @overload
    def plot(
        self,
        axes: Sequence[Axes] | None = ...,
        *,
        what: Sequence[str],
        interactive: Literal[False] = ...,
    ) -> Panels: ...
    @overload
    def plot(self, axes: None = ..., *, what: Any = ..., interactive: Literal[True]) -> Any: ...
    def plot(
        self, axes: Any = None, *, what: str | Sequence[str] = "loop", interactive: bool = False
    ) -> Any:
        """Draw the loop, or the signals over time.

        A notebook shows what comes back; ``.figure.savefig(path)`` of it writes a file. pyplot is
        neither used nor changed: to have a window, give axes of ``plt.subplots()``.

        Parameters
        ----------
        axes
            Axes of matplotlib to draw on, or a sequence of them for several panels; those of a new
            figure if left out.
        what
            ``"loop"``, the output over the input; ``"input"`` or ``"output"`` over time; or a
            sequence of these.
        interactive
            Give a figure of plotly instead, to zoom into.

        Returns
        -------
        matplotlib.axes.Axes, tuple of them, or plotly.graph_objects.Figure
            The axes drawn on: one where ``what`` is a name, several where it is a sequence.

        Raises
        ------
        InputError
            If there is no such panel, or ``axes`` are no plain axes or as many as panels.
        MissingExtraError
            If plotly is asked for and not installed.

        Examples
        --------
        >>> record = Record([0.0, 1.0, 0.0], [0.0, 0.8, 0.2], dt=0.01, input_unit="V")
        >>> record.plot().get_xlabel()
        'u [V]'
        """
        return above(PLOTS, "plot_record")(self, axes, what, interactive)

    def _repr_html_(self) -> str:
        return str(above(PAGES, "page_of_record")(self))

    def _labels(self) -> tuple[float | str, ...]:
        return (self.dt, self.input_name, self.output_name, self.input_unit, self.output_unit)
