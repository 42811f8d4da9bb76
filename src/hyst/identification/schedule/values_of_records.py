"""Records by the value of a second signal at which they were taken."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from hyst.checks.arrays import as_constants
from hyst.errors import InputError
from hyst.identification.options import listed
from hyst.signals import Record


@final
@dataclass(frozen=True)
class AtValue:
    """The records taken at one value.

    Parameters
    ----------
    value
        Of the second signal.
    records
        At least one.
    places
        Where each stands among the records given, from 0.
    """

    value: float
    records: tuple[Record, ...]
    places: tuple[int, ...]


def by_value(records: Any, at: Any, what: str = "record") -> tuple[AtValue, ...]:
    """Sort records by the value at which each was taken; those of one value belong together.

    Parameters
    ----------
    records
        Of one actuator.
    at
        A value for each.
    what
        What messages call a record.

    Raises
    ------
    InputError
        If something is no record, or there is not one finite value for each.
    """
    given = listed(records, what)
    values = as_constants(at, f"values of the {what}s")
    if values.size != len(given):
        raise InputError(
            f"{len(given)} {what}(s) but {values.size} values of the second signal; give one for "
            "each"
        )
    return tuple(
        AtValue(
            float(value),
            tuple(given[i] for i in places),
            tuple(int(i) for i in places),
        )
        for value in np.unique(values)
        for places in (np.flatnonzero(values == value),)
    )


def require_several(groups: Sequence[AtValue]) -> None:
    """Refuse records that were all taken at one value.

    Parameters
    ----------
    groups
        By value.

    Raises
    ------
    InputError
        If there are fewer than two values.
    """
    if len(groups) < 2:
        at = "no value" if not groups else f"the one value {groups[0].value:.6g}"
        raise InputError(
            f"the records are of {at}; give records at two values of the second signal or more, or "
            "use hyst.identify"
        )
