"""Codes of an instrument in signals that come piece by piece."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from hyst.diagnosis.values.codes import Code
from hyst.io.chunked.pieces import Piece
from hyst.io.codes_in_rows import codes_of_both, refuse_codes
from hyst.io.table import Table

_FAR = 10.0


@dataclass(frozen=True, eq=False)
class _Found:
    """A value far outside all others of its piece."""

    table: Table
    column: int
    code: Code


class CodesCheck:
    """Looks for codes within each piece, and keeps those that stand far outside the whole record.

    Parameters
    ----------
    columns
        Those of input and output.
    """

    def __init__(self, columns: list[int]) -> None:
        self._columns = (columns[0], columns[1])
        self._found: list[_Found] = []
        self._low = [np.inf, np.inf]
        self._high = [-np.inf, -np.inf]

    def add(self, table: Table, piece: Piece) -> None:
        """Look at more rows, without flaws.

        Parameters
        ----------
        table
            Where they are, see ``Piece.placed``.
        piece
            Input and output first.
        """
        signals = dict(zip(self._columns, piece.values, strict=False))
        none = np.empty(0)
        whole = replace(table, columns=tuple(signals.get(k, none) for k in range(len(table.names))))
        codes = codes_of_both(whole, *self._columns, np.arange(piece.size))
        for k, (column, found) in enumerate(zip(self._columns, codes, strict=True)):
            good = np.ones(piece.size, dtype=bool)
            for code in found:
                good[code.samples] = False
                at = replace(code, samples=piece.rows()[code.samples])
                self._found.append(_Found(table, column, at))
            rest = signals[column][good] if found else signals[column]
            self._low[k] = min(self._low[k], float(rest.min()))
            self._high[k] = max(self._high[k], float(rest.max()))

    def refuse(self, remedy: str) -> None:
        """Refuse the record if it has codes.

        Parameters
        ----------
        remedy
            What to do about it, for the message.

        Raises
        ------
        InputError
            If so; the first one is named.
        """
        for each in self._found:
            k = self._columns.index(each.column)
            low, high = self._low[k], self._high[k]
            beyond = max(each.code.value / 4.0 - high / 4.0, low / 4.0 - each.code.value / 4.0)
            if beyond > _FAR * (high / 4.0 - low / 4.0):
                refuse_codes(each.table, each.column, (each.code,), remedy)
