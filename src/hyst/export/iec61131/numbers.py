"""The one array of numbers of a block, and how numbers are written."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import groupby
from typing import Any, final

from hyst.errors import HystError
from hyst.export.iec61131.usage import is_array_of_numbers
from hyst.export.translate.program import Initialiser, Number, Program, Unary


def real_text(value: float, precision: str) -> str:
    """Give a real number in decimal digits that are read back to the same bits.

    Parameters
    ----------
    value
        Finite; a number of that precision.
    precision
        "double" or "single".

    Returns
    -------
    str
        The shortest that is exact; a number of single precision has as many digits as one in double
        needs, so that a compiler that reads it as such does not round twice.

    Raises
    ------
    HystError
        If it is not finite.
    """
    if not math.isfinite(value):
        raise HystError(f"{value} is no constant of structured text")
    mantissa, _, exponent = repr(abs(value)).partition("e")
    text = mantissa if "." in mantissa else f"{mantissa}.0"
    if exponent:
        text += f"E{int(exponent):+d}"
    text = text if precision == "double" else f"REAL#{text}"
    return f"(-{text})" if math.copysign(1.0, value) < 0.0 else text


@final
@dataclass
class Numbers:
    """Places in the array.

    Parameters
    ----------
    precision
        Of the target.
    starts
        Initial values of all places so far.
    """

    precision: str
    starts: list[float] = field(default_factory=list)
    _places: dict[tuple[str, str], int] = field(default_factory=dict)

    def place(self, function: str, name: str, count: int) -> int:
        """Give where ``count`` numbers of a function begin, by ``name``: always the same place."""
        key = (function, name)
        if key not in self._places:
            self._places[key] = len(self.starts)
            self.starts += [0.0] * count
        return self._places[key]

    def take_tables(self, program: Program) -> None:
        """Give every table of real numbers a place."""
        for name, table in program.tables.items():
            if is_array_of_numbers(table.type):
                self.place("", name, 0)
                self.starts += constants(table.value)

    def table(self, name: str) -> int:
        """Give where a table begins."""
        return self._places["", name]

    def initial(self) -> str:
        """Give the initial values as structured text, equal ones counted."""
        parts = []
        for text, run in groupby(
            real_text(each, self.precision).strip("()") for each in self.starts
        ):
            count = len(list(run))
            parts += [f"{count}({text})"] if count > 2 else [text] * count
        return "[" + ", ".join(parts) + "]"


def constants(value: Any) -> list[float]:
    """Give the values of a constant, or of arrays of them."""
    if isinstance(value, Initialiser):
        return [each for inner in value.values for each in constants(inner)]
    return [constant(value)]


def constant(value: Any) -> float:
    """Give the value of a constant.

    Raises
    ------
    HystError
        If it would have to be computed.
    """
    if isinstance(value, Number):
        return float(value.value)
    if isinstance(value, Unary) and value.operator == "-":
        return -constant(value.operand)
    raise HystError("a constant that has to be computed cannot be translated")
