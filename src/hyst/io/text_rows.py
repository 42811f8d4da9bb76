"""Rows of text: what a table says of files, devices or limits, not of signals."""

from __future__ import annotations

import csv
import os
from pathlib import Path

from hyst._files import read_small
from hyst.errors import InputError, MissingExtraError


def read_text_rows(path: str | os.PathLike[str]) -> list[dict[str, str]]:
    r"""Read a table with a header as text, empty where a cell is.

    Parameters
    ----------
    path
        A file of values with commas, semicolons or tabs between them, or of Parquet.

    Returns
    -------
    list of dict
        A row each, by header.

    Raises
    ------
    InputError
        If it cannot be read, has no rows, a header is missing or there twice, or a row has more
        cells than headers.
    MissingExtraError
        If it is of Parquet, and pyarrow is not installed.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "devices.csv"
    >>> _ = path.write_text("file,identifier\na.csv,A\n")
    >>> read_text_rows(path)
    [{'file': 'a.csv', 'identifier': 'A'}]
    """
    file = Path(path)
    try:
        rows = _parquet_rows(file) if file.suffix.lower() == ".parquet" else _csv_rows(file)
    except OSError as error:
        raise InputError(f"{file} cannot be read: {error.strerror or error}") from None
    header, *others = rows or [[]]
    names = [each.strip() for each in header]
    if not others:
        raise InputError(f"{file} has no rows below a header; give one for each device")
    if "" in names or len(set(names)) < len(names):
        raise InputError(f"{file} has headers that are empty or there twice; name each column")
    for number, row in enumerate(others, 2):
        if len(row) > len(names):
            raise InputError(f"{file}, row {number}: {len(row)} cells for {len(names)} headers")
    filled = ([*row, *[""] * (len(names) - len(row))] for row in others)
    return [dict(zip(names, map(str.strip, row), strict=True)) for row in filled]


def _csv_rows(path: Path) -> list[list[str]]:
    try:
        text = read_small(path).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{path} is no text in UTF-8 ({error.reason}); save it as such") from None
    first = text.split("\n", 1)[0]
    delimiter = max(",;\t", key=first.count)
    rows = csv.reader(text.splitlines(), delimiter=delimiter)
    return [row for row in rows if any(cell.strip() for cell in row)]


def _parquet_rows(path: Path) -> list[list[str]]:
    try:
        from pyarrow import ArrowInvalid, parquet
    except ImportError:
        raise MissingExtraError(
            "Parquet is read with pyarrow; install it with pip install 'hyst[files]'"
        ) from None
    try:
        table = parquet.read_table(path)
    except ArrowInvalid as error:
        raise InputError(f"{path} is no Parquet: {error}") from None
    columns = [
        ["" if each is None else str(each) for each in column.to_pylist()] for column in table
    ]
    return [list(table.column_names), *(list(row) for row in zip(*columns, strict=True))]
