"""The options of every identification, whatever the family."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from hyst.checks.numbers import whole_number
from hyst.errors import InputError, SolverError
from hyst.identification.families.family import Fit
from hyst.identification.families.option import AUTO
from hyst.identification.fit.bounded_least_squares import CONVERGED
from hyst.identification.progress import Progress
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.signals import Record, RecordStream


@dataclass(frozen=True, eq=False)
class Options:
    """The keyword arguments of ``identify`` that no family owns.

    Parameters
    ----------
    validation
        Records that take no part.
    say
        Told each step before it is made.
    delay, start, max_iterations, allow_unconverged
        As of ``identify``; delay and start are checked with the records.
    known
        What one search of records found out about them, for the next one of the same records.
    """

    validation: tuple[Record, ...]
    say: Progress
    delay: float | str = AUTO
    start: int | Literal["auto"] = "auto"
    max_iterations: int = 200
    allow_unconverged: bool = False
    known: dict[Hashable, Overview] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        whole_number(self.max_iterations, "max_iterations", 0)

    def converged(self, fit: Fit) -> Fit:
        """Give a fit that converged, or one that need not have.

        Parameters
        ----------
        fit
            The fit.

        Raises
        ------
        SolverError
            If it did not converge, and that is not allowed.
        """
        if fit.solution.status != CONVERGED and not self.allow_unconverged:
            raise SolverError(
                f"the fit of {fit.family.named_size(fit.size)} did not converge in "
                f"{fit.solution.iterations} iterations; raise max_iterations, give fewer plays, or "
                "accept it with allow_unconverged"
            )
        return fit


def listed(records: Record | Sequence[Record], name: str = "record") -> tuple[Record, ...]:
    """Give one or more records as a tuple.

    Parameters
    ----------
    records, name
        The records, and what messages call one.

    Raises
    ------
    InputError
        If they are something else.
    """
    if isinstance(records, Record):
        return (records,)
    if not isinstance(records, Iterable):
        raise InputError(
            f"{name} is of type {type(records).__name__}; give a hyst.Record or a list of them"
        )
    given = tuple(records)
    for number, record in enumerate(given, 1):
        if not isinstance(record, Record):
            raise InputError(
                f"{name} {number} is {type(record).__name__}; give a hyst.Record"
                + (", or u, y and dt" if name == "record" else "")
            )
    return given


def records_of(records: Any, y: Any, dt: float | None) -> Any:
    """Give records as they are, or the one that an input, an output and a time make.

    Parameters
    ----------
    records, y, dt
        As of ``identify``.

    Raises
    ------
    InputError
        If an input comes without output or time, or a record with either.
    """
    several = isinstance(records, Sequence) and any(isinstance(each, Record) for each in records)
    if isinstance(records, Record | RecordStream) or several:
        if y is not None or dt is not None:
            raise InputError(
                f"{'y' if y is not None else 'dt'} is given beside records, which have their own; "
                "leave it out"
            )
        return records
    if y is None and dt is None:
        return records
    if y is None or dt is None:
        missing = "y, the output" if y is None else "dt, the time between samples in s"
        raise InputError(f"u comes without {missing}; give u, y and dt, or a hyst.Record")
    return Record(records, y, dt)


def as_delay(delay: float | str, data: Data, more: str = ", or 'auto'") -> float:
    """Check a delay that is given.

    Parameters
    ----------
    delay
        As of ``identify``, not ``"auto"``.
    data
        The records.
    more
        What else may be given, for the message.

    Raises
    ------
    InputError
        If it is no number, or so large that a record has no samples left.
    """
    shortest = min(len(r) - s for r, s in zip(data.records, data.starts, strict=True))
    if isinstance(delay, bool | str) or not isinstance(delay, int | float | np.number):
        raise InputError(f"delay is {delay!r}; give a number of samples{more}")
    lag = float(delay)
    if not abs(lag) <= shortest - 1:
        raise InputError(
            f"delay is {delay}; give {1 - shortest} to {shortest - 1} samples, parts of one "
            f"included{more}"
        )
    return int(lag) if lag.is_integer() else lag
