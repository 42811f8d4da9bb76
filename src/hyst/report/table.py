"""A table of text, the same for the terminal and for the page."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Table:
    """Rows of text under headings.

    Parameters
    ----------
    title
        What the table shows.
    header
        One heading a column.
    rows
        One text a column.
    marked
        Index of the row to stand out, if any.
    """

    title: str
    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    marked: int | None = None


def number(value: float, digits: int = 4) -> str:
    """Write a value for reading.

    Parameters
    ----------
    value
        To write; NaN stands for none.
    digits
        Significant digits, at least 1.

    Returns
    -------
    str
        A dash for NaN.

    Examples
    --------
    >>> number(1234567.0), number(0.00012345), number(3.0), number(float("nan"))
    ('1.235e+06', '0.0001234', '3', '-')
    """
    return "-" if math.isnan(value) else f"{value:.{digits}g}"


def with_unit(text: str, unit: str) -> str:
    """Put a unit behind a text, if there is one.

    Examples
    --------
    >>> with_unit("3", "um"), with_unit("3", "")
    ('3 um', '3')
    """
    return f"{text} {unit}" if unit else text
