"""The step of time stamps that come piece by piece, or a clear refusal."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.io.chunked.pieces import Array, Piece
from hyst.io.even_time import Samples, on_even_steps
from hyst.io.table import Table
from hyst.io.time_axis import TOLERANCE, first_step_back
from hyst.io.usable_rows import LONGEST_GAP

# So many stamps of the piece before are looked at again, so that the mean step of a short last
# piece is known as well as that of others.
_AGAIN = 1000


class StampsCheck:
    """Checks stamps as ``read_record`` does, piece by piece, and finds their mean step.

    Parameters
    ----------
    seconds
        Seconds in the unit of the stamps.
    """

    def __init__(self, seconds: float) -> None:
        self._seconds = seconds
        self._first, self._last, self._count = 0.0, 0.0, 0
        self._step = 0.0
        self._told = False
        self._before: tuple[Array, NDArray[np.intp]] | None = None

    def add(self, table: Table, piece: Piece, stamps: Array) -> None:
        """Look at more stamps.

        Parameters
        ----------
        table
            Where they are, see ``Piece.placed``.
        piece
            Its rows.
        stamps
            Finite.

        Raises
        ------
        InputError
            If they fall or stand, or their steps are uneven among themselves or from piece to
            piece.
        """
        places = piece.rows() if piece.lines is None else piece.lines
        if self._before is not None:
            stamps_before, places_before = self._before
            stamps = np.concatenate([stamps_before, stamps])
            places = np.concatenate([places_before, places])
        else:
            self._first = float(stamps[0])
        self._last, self._count = float(stamps[-1]), self._count + piece.size
        self._before = stamps[-_AGAIN:], places[-_AGAIN:]
        if stamps.size > 1:
            self._look(self._samples(table, piece, places, stamps))

    def result(self) -> tuple[float, tuple[str, ...]]:
        """Give the mean step, seconds, and what is to be told about the stamps."""
        mean = (self._last - self._first) / max(1, self._count - 1)
        step = float(f"{mean * self._seconds:.12g}")
        if not self._told:
            return step, ()
        return step, (
            "the stamps are rounded or jitter by up to a tenth of a step; the samples were taken "
            f"as even, {step:.9g} s apart",
        )

    def _samples(
        self, table: Table, piece: Piece, places: NDArray[np.intp], stamps: Array
    ) -> Samples:
        if piece.lines is None:
            return Samples(table, places, stamps, self._seconds, [], rate_given=False)
        here = replace(table, lines=places)
        return Samples(here, np.arange(stamps.size), stamps, self._seconds, [], rate_given=False)

    def _look(self, samples: Samples) -> None:
        even = on_even_steps(samples, repair=False, longest_gap=LONGEST_GAP)
        source = samples.table.source
        if first_step_back(samples.time) is not None:
            raise InputError(
                f"{source}: {even.notes[0]}; a record in chunks needs stamps that increase, so "
                "give a rate instead, or read it as a whole with read_record"
            )
        self._told = self._told or bool(even.notes)
        self._step = self._step or even.dt
        if abs(even.dt - self._step) > TOLERANCE * self._step:
            raise InputError(
                f"{source}: time is uneven, the step is {self._step:.6g} s at the start and "
                f"{even.dt:.6g} s at {samples.place(samples.time.size - 1)} (tolerance "
                f"{TOLERANCE:.0%}); give a rate instead, or cut the record there"
            )
