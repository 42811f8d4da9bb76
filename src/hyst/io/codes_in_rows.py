"""Codes of instruments in the rows of a table, as diagnosis tells them from measurements."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.values.codes import Code, codes_in
from hyst.diagnosis.values.codes_of_record import codes_of_record
from hyst.errors import InputError
from hyst.io.table import Table

Codes = tuple[Code, ...]


def codes_of_column(table: Table, column: int, rows: NDArray[np.intp]) -> Codes:
    """Give the codes of one column of a table in rows where it has a finite number."""
    return _at(rows, codes_in(table.columns[column][rows]))


def codes_of_both(
    table: Table, input: int, output: int, rows: NDArray[np.intp]
) -> tuple[Codes, Codes]:
    """Give the codes of input and output in rows of a table where both have a finite number."""
    of_input, of_output = codes_of_record(table.columns[input][rows], table.columns[output][rows])
    return _at(rows, of_input), _at(rows, of_output)


def refuse_codes(table: Table, column: int, codes: Codes, remedy: str) -> None:
    """Refuse a column of a table that has codes; the first line and a remedy are named.

    Raises
    ------
    InputError
        If so.
    """
    for code in codes[:1]:
        more = code.samples.size - 1
        also = f" and in {rows_counted(more)} more" if more else ""
        raise InputError(
            f"{table.source}: {table.names[column]!r} is {code.value:.6g} at "
            f"{table.place(int(code.samples[0]))}{also}, far from all other values: "
            f"{_what_it_is(code)}; correct it{remedy}"
        )


def told_of_codes(table: Table, column: int, codes: Codes) -> list[str]:
    """Say which rows of a table were left out because of codes in a column."""
    return [
        f"left out {rows_counted(code.samples.size)} where {table.names[column]!r} is "
        f"{code.value:.6g}, {_what_it_is(code)}"
        for code in codes
    ]


def codes_in_words(table: Table, column: int, codes: Codes) -> list[str]:
    """Say where a column of a table has codes."""
    return [
        f"{code.value:.6g} at {table.place(int(code.samples[0]))}, {code.samples.size} in all, "
        f"{_what_it_is(code)}"
        for code in codes
    ]


def rows_counted(count: int) -> str:
    """Give a count of rows in words."""
    return "1 row" if count == 1 else f"{count} rows"


def _what_it_is(code: Code) -> str:
    known = f" ({code.meaning})" if code.meaning else ""
    return f"a code of the instrument and no measurement{known}"


def _at(rows: NDArray[np.intp], codes: Codes) -> Codes:
    return tuple(replace(each, samples=rows[each.samples]) for each in codes)
