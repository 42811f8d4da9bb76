"""The table of a driver: which volts belong to the codes that it is commanded with."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_reals
from hyst.checks.numbers import as_number, whole_number
from hyst.errors import InputError
from hyst.operators.driver.points import Points
from hyst.operators.driver.table_rows import as_ends, as_rows, unresolved_row
from hyst.operators.plain_data import as_text

LOWEST_CODE = -(2**31)
HIGHEST_CODE = 2**31 - 1


@final
@dataclass(frozen=True, repr=False)
class Driver:
    """Codes of a converter or an amplifier, and the volts that they give.

    ``volt(c) = V_i + (V_(i+1) - V_i) / (C_(i+1) - C_i) (c - C_i)`` between the points of a table.

    Between neighbouring codes there is nothing: a drive that is wanted is given by the code whose
    volts are nearest, of two that are as near by the lower code, so it is off by half a step at
    most.

    Parameters
    ----------
    table_codes
        Codes of the points of the table, whole numbers, all rising or all falling (kept rising),
        shape (n,), 2 <= n <= 65536, from -2147483648 to 2147483647.
    table_volts
        Volts that belong to them, all rising or all falling, in ``unit``.
    unit
        Of the volts, as text.

    Raises
    ------
    InputError
        If there are less than two rows or more than 65536, a code is not whole, out of 32 bits or
        there twice, codes or volts do not go one way, volts are not finite, or move by less from
        code to code than numbers resolve; the first bad row is named, counted from 1.

    Examples
    --------
    >>> driver = Driver.linear(0.5, -1.0, 0, 8)
    >>> driver.volts([0, 1, 8])
    array([-1. , -0.5,  3. ])
    >>> driver.codes([-7.0, -0.7, 0.25, 0.26])
    array([0, 1, 2, 3])
    >>> driver.codes([-7.0, 2.9], limits=(-0.8, 2.8))
    array([1, 7])
    """

    table_codes: tuple[int, ...]
    table_volts: tuple[float, ...]
    unit: str = "V"

    def __post_init__(self) -> None:
        codes, volts = as_rows(self.table_codes, self.table_volts)
        object.__setattr__(self, "table_codes", codes)
        object.__setattr__(self, "table_volts", volts)
        object.__setattr__(self, "unit", as_text("unit of a driver", self.unit))
        self.require_resolved()

    def __repr__(self) -> str:
        return f"Driver({self.told()})"

    @classmethod
    def from_table(cls, codes: ArrayLike, volts: ArrayLike, unit: str = "V") -> Driver:
        """Give the driver of a table; codes may fall from row to row.

        Parameters
        ----------
        codes, volts
            Shape (n,), a row each; see the class.
        unit
            Of the volts.

        Raises
        ------
        InputError
            As of the class.

        Examples
        --------
        >>> Driver.from_table([0, 2, 6], [0.0, 1.0, 5.0]).volts([1, 2, 3])
        array([0.5, 1. , 2. ])
        """
        return cls(*as_rows(codes, volts), unit)

    @classmethod
    def linear(
        cls, volts_per_code: float, offset: float, low_code: int, high_code: int, unit: str = "V"
    ) -> Driver:
        """Give the driver of a scale and an offset, ``volt(c) = offset + volts_per_code c``.

        Parameters
        ----------
        volts_per_code
            Not 0; negative where volts fall while codes rise.
        offset
            Volts of code 0.
        low_code, high_code
            First and last code there is.
        unit
            Of the volts.

        Raises
        ------
        InputError
            If a number is not finite, a code is not whole or out of 32 bits, the last code is not
            above the first, or volts do not move.
        """
        scale = as_number(volts_per_code, "volts_per_code")
        zero = as_number(offset, "offset")
        low = whole_number(low_code, "low_code", LOWEST_CODE, HIGHEST_CODE)
        high = whole_number(high_code, "high_code", LOWEST_CODE, HIGHEST_CODE)
        if high <= low:
            raise InputError(f"low_code is {low} and high_code {high}; give the lower code first")
        if scale == 0.0:
            raise InputError("volts_per_code is 0; give the volts by which a code moves the drive")
        return cls((low, high), (zero + scale * low, zero + scale * high), unit)

    @property
    def code_range(self) -> tuple[int, int]:
        """Lowest and highest code of the table."""
        return self.table_codes[0], self.table_codes[-1]

    @property
    def volt_range(self) -> tuple[float, float]:
        """Lowest and highest volt of the table."""
        ends = self.table_volts[0], self.table_volts[-1]
        return min(ends), max(ends)

    @property
    def steps(self) -> tuple[float, float]:
        """Smallest and largest way of the volts from one code to the next."""
        sizes = abs(self.points.slopes)
        return float(sizes.min()), float(sizes.max())

    @cached_property
    def points(self) -> Points:
        """The table in double, as the kernel has it."""
        return Points.of(self.table_codes, self.table_volts)

    def volts(self, codes: ArrayLike) -> NDArray[np.float64]:
        """Give the volts of codes.

        Parameters
        ----------
        codes
            Whole numbers of any shape, from the first code of the table to the last.

        Returns
        -------
        numpy.ndarray
            Volts, of the same shape.

        Raises
        ------
        InputError
            If one is not whole or beyond the table; the first such index is named.
        """
        given = as_reals(codes, "codes")
        low, high = self.code_range
        wrong = ~((given >= low) & (given <= high) & (given == np.floor(given)))
        if wrong.any():
            first = np.argwhere(wrong)[0].tolist() if given.ndim else []
            where = f" at index {first[0] if len(first) == 1 else tuple(first)}" if first else ""
            value = float(given[tuple(first)])
            raise InputError(
                f"the code{where} is {value:.17g}; the driver takes whole codes from {low} to "
                f"{high}"
            )
        volts: NDArray[np.float64] = self.points.volts_of(given.astype(np.int64))
        return volts

    def codes(
        self, volts: ArrayLike, limits: tuple[float, float] | None = None
    ) -> NDArray[np.int64]:
        """Give the codes whose volts are nearest; of two as near, the lower code.

        Parameters
        ----------
        volts
            Finite, of any shape; beyond the table, or the limits, the last code within is given.
        limits
            Lowest and highest volts that a code may give; those of the table if left out.

        Returns
        -------
        numpy.ndarray
            Codes, int64, of the same shape.

        Raises
        ------
        InputError
            If a volt is not finite, limits are no two numbers, or no code is within them.
        """
        wanted = as_reals(volts, "volts")
        if not np.isfinite(wanted).all():
            raise InputError("a volt is not finite; give finite volts")
        low, high = self.code_range if limits is None else self.codes_within(*as_ends(limits))
        return self.points.codes_of(wanted, low, high)

    def quantized(
        self, volts: ArrayLike, limits: tuple[float, float] | None = None
    ) -> NDArray[np.float64]:
        """Give the volts of the nearest codes.

        Parameters
        ----------
        volts, limits
            As of ``codes``, which also says what is refused.
        """
        return self.volts(self.codes(volts, limits))

    def codes_within(self, low: float, high: float, *, single: bool = False) -> tuple[int, int]:
        """Give the lowest and the highest code whose volts are within limits.

        Parameters
        ----------
        low, high
            Lowest and highest volts.
        single
            Whether volts are those of single precision, as on a target.

        Raises
        ------
        InputError
            If they are no numbers, or no code is within them.
        """
        low, high = as_ends((low, high))
        points = Points.of(self.table_codes, self.table_volts, True) if single else None
        points = points or self.points
        ends = np.array([low, high], dtype=points.volts.dtype)
        if points.falls:
            ends = ends[::-1]
        first, last = points.codes_of(ends, *self.code_range)
        sign = -1.0 if points.falls else 1.0
        # The nearest code may be the one just outside.
        if sign * points.volts_of(first) < sign * ends[0]:
            first += 1
        if sign * points.volts_of(last) > sign * ends[1]:
            last -= 1
        if first > last or not low <= high:
            raise InputError(
                f"no code of the driver gives volts from {low:.6g} to {high:.6g}; its codes give "
                f"{self.volt_range[0]:.6g} to {self.volt_range[1]:.6g} in steps of up to "
                f"{self.steps[1]:.3g}; give other limits"
            )
        return int(first), int(last)

    def require_resolved(self, single: bool = False) -> None:
        """Refuse volts that move by less from code to code than numbers resolve.

        Parameters
        ----------
        single
            Whether numbers are single precision.

        Raises
        ------
        InputError
            If they do.
        """
        points = Points.of(self.table_codes, self.table_volts, single)
        if not np.isfinite(points.volts).all():
            raise InputError(
                f"the driver's volts go from {self.volt_range[0]:.6g} to {self.volt_range[1]:.6g}, "
                "beyond single precision; export in double"
            )
        row = unresolved_row(points)
        if row is not None:
            kind = "single" if single else "double"
            raise InputError(
                f"after row {row + 1} of the driver's table volts move by "
                f"{abs(float(points.slopes[row])):.3g} a code, which {kind} precision does not "
                "resolve beside its largest volts"
                + ("; export in double" if single else "; correct the table")
            )

    def told(self) -> str:
        """Say in a line what the driver is."""
        low, high = self.code_range
        small, large = (f"{each:.4g}" for each in self.steps)
        step = large if small == large else f"{small} to {large}"
        count = len(self.table_codes)
        return (
            f"codes {low} to {high} give {self.table_volts[0]:.6g} to "
            f"{self.table_volts[-1]:.6g}{f' {self.unit}' if self.unit else ''}, {step} a code"
            + (f" (table of {count} points)" if count > 2 else "")
        )

    def to_dict(self) -> dict[str, Any]:
        """Give the table as plain data."""
        return {
            "codes": list(self.table_codes),
            "volts": list(self.table_volts),
            "unit": self.unit,
        }

    @classmethod
    def from_dict(cls, data: Any) -> Driver:
        """Rebuild a driver from ``to_dict()``.

        Parameters
        ----------
        data
            What it gave, or the same read from a file.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        if not isinstance(data, Mapping) or set(data) != {"codes", "volts", "unit"}:
            raise InputError("a driver has the entries 'codes', 'volts' and 'unit' and no others")
        for name in ("codes", "volts"):
            if not isinstance(data[name], list | tuple):
                raise InputError(f"the {name} of a driver are a list of numbers")
        return cls(data["codes"], data["volts"], data["unit"])
