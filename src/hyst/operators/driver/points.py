"""The points of a driver's table, and what lies between them, as core/src/driver.c does it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

Codes = NDArray[np.int64]
Reals = NDArray[Any]  # of the precision of the points


@final
@dataclass(frozen=True, eq=False)
class Points:
    """Points of a table in one precision, with what ``hyst_driver`` holds of them.

    Parameters
    ----------
    codes
        Strictly rising, shape (n,), n >= 2.
    volts
        Strictly rising or falling, float64 or float32.
    slopes
        Volts a code of each piece, shape (n - 1,), of the same type.
    """

    codes: Codes
    volts: Reals
    slopes: Reals

    @classmethod
    def of(cls, codes: tuple[int, ...], volts: tuple[float, ...], single: bool = False) -> Points:
        """Give the points with slopes formed in double, then rounded with the volts.

        Parameters
        ----------
        codes, volts
            Of a table that was checked.
        single
            Whether they are kept in single precision.
        """
        whole, real = np.array(codes, dtype=np.int64), np.array(volts)
        slopes = np.diff(real) / np.diff(whole).astype(np.float64)
        kind = np.float32 if single else np.float64
        with np.errstate(over="ignore"):  # refused by unresolved_row
            return cls(whole, real.astype(kind), slopes.astype(kind))

    @property
    def falls(self) -> bool:
        """Whether volts fall while codes rise."""
        return bool(self.volts[0] > self.volts[1])

    def volts_of(self, codes: Codes) -> Reals:
        """Give the volts of codes; of those beyond the table those of its ends."""
        inside = np.clip(codes, self.codes[0], self.codes[-1])
        piece = np.searchsorted(self.codes, inside, side="right") - 1
        piece = np.minimum(piece, self.codes.size - 2)
        return self._in_piece(piece, inside - self.codes[piece])

    def codes_of(self, volts: Reals, lowest: int, highest: int) -> Codes:
        """Give codes nearest to ``volts``, ``lowest`` to ``highest``, of two the lower one."""
        volts = np.asarray(volts, dtype=self.volts.dtype)
        piece = self._piece_of(volts)
        first: Codes = self.codes[piece]
        most = self.codes[piece + 1] - first
        codes = self._passed(piece, volts, most)
        up = np.minimum(codes + 1, most)
        with np.errstate(invalid="ignore"):
            further = abs(volts - self._in_piece(piece, up)) < abs(
                volts - self._in_piece(piece, codes)
            )
        nearest: Codes = np.clip(first + np.where(further, up, codes), lowest, highest)
        return nearest

    def _in_piece(self, piece: NDArray[np.intp], codes: Codes) -> Reals:
        """Give the volts so many codes after the start of a piece, never beyond its end."""
        end = self.volts[piece + 1]
        volts = self.volts[piece] + self.slopes[piece] * codes.astype(self.volts.dtype)
        kept = np.maximum(volts, end) if self.falls else np.minimum(volts, end)
        whole = codes >= self.codes[piece + 1] - self.codes[piece]
        given: Reals = np.where(whole, end, kept)
        return given

    def _piece_of(self, volts: Reals) -> NDArray[np.intp]:
        sign = self.volts.dtype.type(-1.0 if self.falls else 1.0)
        found = np.searchsorted(sign * self.volts, sign * volts, side="right") - 1
        piece: NDArray[np.intp] = np.clip(found, 0, self.codes.size - 2)
        return piece

    def _passed(self, piece: NDArray[np.intp], volts: Reals, most: Codes) -> Codes:
        """Give the last codes of the pieces that the volts have passed, 0 where none is."""

        def is_before(codes: Codes) -> NDArray[np.bool_]:
            there = self._in_piece(piece, codes)
            return volts > there if self.falls else volts < there

        with np.errstate(over="ignore"):
            about = (volts - self.volts[piece]) / self.slopes[piece]
        # Numbers of codes are exact in double, so that none beyond is made an integer.
        codes = np.clip(about.astype(np.float64), 0.0, most.astype(np.float64)).astype(np.int64)
        # Division and product round: the volts themselves decide.
        while (back := (codes > 0) & is_before(codes)).any():
            codes = codes - back
        while (on := (codes < most) & ~is_before(codes + 1)).any():
            codes = codes + on
        return codes
