"""The options of every identification, whatever the family."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from hyst.checks.numbers import whole_number
from hyst.errors import InputError, SolverError
from hyst.identification.families.family import Fit
from hyst.identification.families.option import AUTO
from hyst.identification.fit.bounded_least_squares import CONVERGED
from hyst.identification.record_use.used_samples import Data
from hyst.signals import Record


@dataclass(frozen=True, eq=False)
class Options:
    """The keyword arguments of ``identify`` that no family owns.

    Parameters
    ----------
    validation
        Records that take no part.
    say
        Told what is being done.
    delay, start, max_iterations, allow_unconverged
        As of ``identify``; delay and start are checked with the records.
    """

    validation: tuple[Record, ...]
    say: Callable[[str], None]
    delay: int | str = AUTO
    start: int | Literal["auto"] = "auto"
    max_iterations: int = 200
    allow_unconverged: bool = False

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
            raise InputError(f"{name} {number} is {type(record).__name__}; give a hyst.Record")
    return given


def silent(_: str) -> None:
    """Report progress to nobody."""


def as_delay(delay: int | str, data: Data, more: str = ", or 'auto'") -> int:
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
        If it is no number of samples a record has.
    """
    shortest = min(len(r) - s for r, s in zip(data.records, data.starts, strict=True))
    return whole_number(delay, "delay", 0, shortest - 1, f" samples{more}")


def require_sample_time(validation: Sequence[Record], data: Data) -> None:
    """Refuse to apply a delay in samples to records of another sample time.

    Parameters
    ----------
    validation
        Records to judge by.
    data
        The training records with their delay.

    Raises
    ------
    InputError
        If a record has another sample time and the delay is not 0.
    """
    dt = data.records[0].dt
    for number, record in enumerate(validation, 1):
        if data.delay and not np.isclose(record.dt, dt, rtol=1e-6, atol=0.0):
            raise InputError(
                f"validation record {number} has dt = {record.dt:.6g} s, the training records "
                f"{dt:.6g} s; the delay of {data.delay} samples means another time there, so give "
                "records of one sample time"
            )
