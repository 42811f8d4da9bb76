"""How a file is read: which columns, and what else its reader must be told."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from hyst.errors import InputError

ROLES = ("input", "output", "time", "output_time")
"""Of columns: ``output_time`` are stamps of the output where it has its own."""


@dataclass(frozen=True)
class Choice:
    """What the user says of a file.

    Parameters
    ----------
    input, output, time
        Places of columns; None where none is chosen.
    output_time
        Place of the stamps of the output, where it has its own.
    rate
        Samples per second where no column has the time.
    time_unit
        Of the stamps; empty as the file says.
    repair, resample
        As of ``hyst.read_record``.
    table
        Which of several tables, from 1; None for the only one.
    """

    input: int | None = None
    output: int | None = None
    time: int | None = None
    output_time: int | None = None
    rate: float | None = None
    time_unit: str = ""
    repair: bool = False
    resample: bool = False
    table: int | None = None

    def with_role(self, column: int, role: str) -> Choice:
        """Give a column a role, which no other has then; an empty one takes it from it."""
        roles = {each: getattr(self, each) for each in ROLES}
        roles |= {each: None for each, taken in roles.items() if taken == column}
        roles |= {role: column} if role else {}
        return replace(
            self,
            input=roles["input"],
            output=roles["output"],
            time=roles["time"],
            output_time=roles["output_time"],
        )

    def role_of(self, column: int) -> str:
        """Name the role of a column; empty if it has none."""
        return next((each for each in ROLES if getattr(self, each) == column), "")

    def missing(self) -> str:
        """Say what is not chosen yet; empty if nothing is missing."""
        lacking = [each for each in ("input", "output") if getattr(self, each) is None]
        if lacking:
            return f"Choose the column of the {' and that of the '.join(lacking)}."
        if self.time is None and self.rate is None:
            return "Give the samples per second, or choose the column of time stamps."
        return ""

    def arguments(self) -> dict[str, Any]:
        """Give the arguments of ``hyst.read_record``.

        Raises
        ------
        InputError
            If something is missing.
        """
        if self.missing():
            raise InputError(self.missing())
        given: dict[str, Any] = {"input": self.input, "output": self.output, "table": self.table}
        if self.time is None:
            given["rate"] = self.rate
        else:
            given |= {"time": self.time, "time_unit": self.time_unit or None}
            given |= {"output_time": self.output_time}
        return given | {"repair": self.repair, "resample": self.resample}

    def options(self) -> list[str]:
        """Give the same as options of the command line."""
        given = ["--input", str(self.input), "--output", str(self.output)]
        if self.time is None:
            given += ["--rate", f"{self.rate:.12g}"]
        else:
            given += ["--time", str(self.time)]
            given += ["--time-unit", self.time_unit] if self.time_unit else []
            own = self.output_time
            given += [] if own is None else ["--output-time", str(own)]
        given += ["--repair"] if self.repair else []
        given += ["--resample"] if self.resample else []
        return given + ([] if self.table is None else ["--table", str(self.table)])
