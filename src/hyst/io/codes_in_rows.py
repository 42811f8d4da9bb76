"""Codes of instruments in the rows of a table, as diagnosis tells them from measurements."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.values.codes import Code
from hyst.diagnosis.values.codes_of_record import codes_of_record
from hyst.io.table import Table


def codes_in_rows(
    table: Table, input: int, output: int, rows: NDArray[np.intp]
) -> tuple[tuple[Code, ...], tuple[Code, ...]]:
    """Give the codes of two columns in some rows, by the rows of the table.

    Parameters
    ----------
    table
        Where to look.
    input, output
        Their columns.
    rows
        Where both have a finite number.

    Returns
    -------
    tuple
        Those of the input and those of the output.
    """
    of_input, of_output = codes_of_record(table.columns[input][rows], table.columns[output][rows])
    return _at(rows, of_input), _at(rows, of_output)


def what_it_is(code: Code) -> str:
    """Say that a value is no measurement, and what it is known to stand for."""
    known = f" ({code.meaning})" if code.meaning else ""
    return f"a code of the instrument and no measurement{known}"


def _at(rows: NDArray[np.intp], codes: tuple[Code, ...]) -> tuple[Code, ...]:
    return tuple(replace(each, samples=rows[each.samples]) for each in codes)
