"""Files with the table of a driver: codes and the volts that they give."""

from __future__ import annotations

import os
from pathlib import Path

from hyst.errors import InputError
from hyst.io.columns import refuse_flaws
from hyst.io.formats import read_table
from hyst.io.table import Table
from hyst.operators import Driver

_CODES = ("code", "codes")
_VOLTS = ("volt", "volts", "voltage")


def read_driver(path: str | os.PathLike[str]) -> Driver:
    r"""Read the table of a driver.

    Parameters
    ----------
    path
        A file of any format of ``read_table`` with the columns ``code`` and ``volt``, the latter
        with its unit where that is not V; or with two columns without names, codes first. A row a
        point: between them volts are a straight line in the code.

    Returns
    -------
    Driver

    Raises
    ------
    InputError
        If the file cannot be read, has no such columns, an entry is no finite number, or the table
        is not one of a driver; the first bad row is named.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "driver.csv"
    >>> _ = path.write_text("code,volt\n0,-10\n4095,10\n")
    >>> read_driver(path).volts([0, 4095])
    array([-10.,  10.])
    """
    table = read_table(path)
    codes, volts = _columns(table, Path(path).name)
    for column in (codes, volts):
        refuse_flaws(table, column, "correct it or take the row out")
    try:
        return Driver.from_table(
            table.columns[codes], table.columns[volts], table.units[volts] or "V"
        )
    except InputError as refusal:
        raise InputError(f"{Path(path).name}: {refusal}") from None


def _columns(table: Table, name: str) -> tuple[int, int]:
    """Find codes and volts by their names; two columns without names are those."""
    names = [each.strip().lower() for each in table.names]
    found = [
        [index for index, each in enumerate(names) if each in known] for known in (_CODES, _VOLTS)
    ]
    if all(len(each) == 1 for each in found):
        return found[0][0], found[1][0]
    if len(names) == 2 and all(each.startswith("column ") for each in names):
        return 0, 1
    raise InputError(
        f"{name} has the columns {', '.join(map(repr, table.names))}; a driver's table has one "
        "called 'code' and one called 'volt'"
    )
