"""The last stage of an export whose drive is given in codes of a driver, or the first one."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, final

import numpy as np

from hyst.control.drive_limits import Limits
from hyst.errors import InputError
from hyst.export.c.drive_range import DriveRange
from hyst.export.c.exported import Block
from hyst.export.c.numbers import Precision, table
from hyst.operators import Driver, ModelDescription
from hyst.operators.driver.points import Points
from hyst.signals import units_differ

HEADER = "hyst/driver.h"
OF_THE_DRIVER = "the range of the driver's codes"

_AUTO, _NONE = "auto", "none"
_PER_LINE = 8


@final
@dataclass(frozen=True)
class DriverCodes:
    """A driver in the numbers of a target.

    Parameters
    ----------
    driver
        Its table.
    precision
        Of the target.
    is_asked_for
        Whether the export was given it; else it comes from the model, and is left out where it
        cannot be.
    lowest, highest
        Codes that may be given, whose volts are within the limits of the drive.
    """

    driver: Driver
    precision: Precision
    is_asked_for: bool = True
    lowest: int = 0
    highest: int = 0

    @property
    def points(self) -> Points:
        """The table as the target holds it."""
        return Points.of(
            self.driver.table_codes, self.driver.table_volts, self.precision == "single"
        )

    def within(self, limits: Limits | None, source: str) -> tuple[Limits, str]:
        """Give limits that are volts of codes, so that nothing is asked for that no code gives.

        Parameters
        ----------
        limits
            Of the drive; None for any.
        source
            Where they come from.
        """
        low, high = self.driver.volt_range
        if limits is None:
            source = OF_THE_DRIVER
        else:
            low, high = max(low, limits[0]), min(high, limits[1])
            source = f"{source}, to whole codes"
        # What a code gives does not depend on the target: its codes are those of double, and the
        # limits its numbers for their volts.
        codes = self.driver.codes_within(*((low, high) if limits is None or low < high else limits))
        ends = self.points.volts_of(np.array(codes))
        return (float(ends.min()), float(ends.max())), source

    def of(self, drive: DriveRange) -> DriverCodes:
        """Give it with the codes that a ``drive`` with limits may have."""
        assert drive.limits is not None  # asked before
        single = self.precision == "single"
        lowest, highest = self.driver.codes_within(*drive.limits, single=single)
        return replace(self, lowest=lowest, highest=highest)

    def told(self) -> dict[str, Any]:
        """Give what a manifest says."""
        return {**self.driver.to_dict(), "lowest_code": self.lowest, "highest_code": self.highest}

    def row(self) -> str:
        """Give the row of a table."""
        return f"{self.lowest} to {self.highest} ({self.driver.told()})"


def driver_codes(
    driver: Driver | str | None, about: ModelDescription, precision: Precision
) -> DriverCodes | None:
    """Give the driver of an export as it was asked for.

    Parameters
    ----------
    driver
        A driver, ``"auto"`` for that of the description, None or ``"none"`` for none.
    about
        What the numbers of the model mean.
    precision
        Of the target.

    Raises
    ------
    InputError
        If it is something else, gives another unit than the drive has, or its steps are below what
        single precision resolves.
    """
    if driver is None or driver == _NONE:
        return None
    table = about.driver if driver == _AUTO else driver
    if table is None:
        return None
    if not isinstance(table, Driver):
        raise InputError(f"driver is {driver!r}; give a hyst.Driver, 'auto' or 'none'")
    unit = about.output_unit if about.is_inverse else about.input_unit
    if units_differ(table.unit, unit):
        raise InputError(
            f"the driver gives {table.unit!r} but the drive is in {unit!r}; give the table in that"
        )
    table.require_resolved(single=precision == "single")
    return DriverCodes(table, precision, driver != _AUTO)


def with_codes(block: Block, codes: DriverCodes | None) -> Block:
    """Give a block whose drive goes out, or comes in, as codes too.

    Parameters
    ----------
    block
        With its limits.
    codes
        The driver; None for none.

    Raises
    ------
    InputError
        If the driver was asked for and the block has no place for it.
    """
    if codes is None:
        return block
    reason = ""
    if block.is_estimator or block.second or block.drive.side not in ("output", "input"):
        reason = "codes are of an inverse, a model of one input or a controller with limits"
    elif block.drive.limits is None:
        reason = f"codes end, and this drive has no limits ({block.drive.source}); give limits"
    if not reason:
        return replace(block, codes=codes.of(block.drive))
    if codes.is_asked_for:
        raise InputError(f"no driver can be given here: {reason}")
    return block


def declared(block: Block, name: str) -> str:
    """Give what the header of an export of a ``block`` called ``name`` says of codes."""
    codes: DriverCodes | None = block.codes
    if codes is None:
        return ""
    prefix = name.upper()
    return (
        f"\n#define {prefix}_CODE_MIN {_whole(codes.lowest)} /* the lowest code that may be */\n"
        f"#define {prefix}_CODE_MAX {_whole(codes.highest)} /* the highest */\n\n"
        "/* The code whose volts are nearest, of two that are as near the lower one, and volts of\n"
        " * a code; what is beyond the codes that may be is taken as the nearest of them. */\n"
        f"int32_t {name}_code(hyst_real volt);\n"
        f"hyst_real {name}_volt(int32_t code);\n\n"
        + _STEP[block.drive.side]
        + _signature(block, name)
        + ";\n"
    )


def tables(block: Block) -> str:
    """Give the driver as constants of the source."""
    codes: DriverCodes | None = block.codes
    if codes is None:
        return ""
    points = codes.points
    count = points.codes.size
    whole = [_whole(int(each)) for each in points.codes]
    lines = ["    " + ", ".join(whole[k : k + _PER_LINE]) for k in range(0, count, _PER_LINE)]
    volts = table(points.volts.tolist(), codes.precision, "volt of the driver")
    slopes = table(points.slopes.tolist(), codes.precision, "volts a code")
    return (
        f"static const int32_t driver_code[{count}] = {{\n" + ",\n".join(lines) + "};\n"
        f"static const hyst_real driver_volt[{count}] = {volts};\n"
        f"static const hyst_real driver_slope[{count - 1}] = {slopes};\n"
        f"static const hyst_driver driver = {{{count}u, driver_code, driver_volt, driver_slope, "
        f"{_whole(codes.lowest)}, {_whole(codes.highest)}}};\n"
    )


def defined(block: Block, name: str) -> str:
    """Give the functions of codes of an export of a ``block`` called ``name``."""
    if block.codes is None:
        return ""
    arguments = ", ".join(block.inputs)
    step = f"{name}_code({name}_step(state, {arguments}))"
    if block.drive.side == "input":
        step = f"{name}_step(state, {name}_volt(code))"
    prefix = name.upper()
    return (
        f"\nint32_t {name}_code(hyst_real volt)\n{{\n"
        "    return hyst_driver_code(&driver, volt);\n}\n"
        f"\nhyst_real {name}_volt(int32_t code)\n{{\n"
        f"    const int32_t above = code < {prefix}_CODE_MIN ? {prefix}_CODE_MIN : code;\n"
        f"    return hyst_driver_volt(&driver, above > {prefix}_CODE_MAX ? {prefix}_CODE_MAX : "
        "above);\n}\n"
        f"\n{_signature(block, name)}\n{{\n    return {step};\n}}\n"
    )


def words(block: Block) -> str:
    """Give the paragraph of a README that says what there is of codes."""
    if block.codes is None:
        return ""
    return _WORDS[block.drive.side]


def _signature(block: Block, name: str) -> str:
    state = f"{name}_state *state"
    if block.drive.side == "input":
        return f"hyst_real {name}_step_of_code({state}, int32_t code)"
    arguments = ", ".join(f"hyst_real {each}" for each in block.inputs)
    return f"int32_t {name}_step_code({state}, {arguments})"


def _whole(code: int) -> str:
    """Give a code as C, which has no literal for the lowest of 32 bits."""
    if code == -(2**31):
        return "(-2147483647 - 1)"
    return f"({code})" if code < 0 else str(code)


_STEP = {
    "output": "/* One sample, as the step, with the drive as a code: its volts are off by half a\n"
    " * step at most, which the memory does not see and which does not add up. */\n",
    "input": "/* One sample, as the step, of the volts of a code. */\n",
}
_WORDS = {
    "output": """
`@{name}_step_code` takes the same sample and gives the code of the driver whose volts are nearest
to the drive, of two as near the lower one, from `@{NAME}_CODE_MIN` to `@{NAME}_CODE_MAX`. Call it
instead of `@{name}_step`, not beside it. What is given is off the drive by half a step of a code at
most. The memory is that of the drive before it is rounded: that difference does not add up.
""",
    "input": """
`@{name}_step_of_code` takes a code of the driver, from `@{NAME}_CODE_MIN` to `@{NAME}_CODE_MAX`,
instead of its volts. Call it instead of `@{name}_step`, not beside it.
""",
}
