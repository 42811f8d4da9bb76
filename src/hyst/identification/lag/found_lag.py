"""A first-order lag of the drive as a stage of the model that a search has found without it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Literal

import numpy as np

from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.families.family import Family
from hyst.identification.families.option import AUTO
from hyst.identification.lag.lag_or_delay import LagOrDelay, Search
from hyst.identification.lag.lagging_family import LaggingFamily
from hyst.identification.lag.stage import LONGEST, lagged, lagging
from hyst.identification.options import Options
from hyst.identification.record_use.cleaned import Cleaned
from hyst.identification.search import Found
from hyst.signals import Record

Wanted = float | Literal["auto"] | None


def as_lag(lag: Any) -> Wanted:
    """Check what is to be done about a lag.

    Parameters
    ----------
    lag
        ``"auto"``, a time constant in seconds, or None.

    Raises
    ------
    InputError
        If it is something else.
    """
    if lag is None or (isinstance(lag, str) and lag == AUTO):
        return lag  # type: ignore[return-value]
    number = isinstance(lag, int | float | np.number) and not isinstance(lag, bool)
    if not number or not (math.isfinite(lag) and lag > 0.0):
        raise InputError(
            f"lag is {lag!r}; give 'auto', a time constant in seconds, above 0, or None for none"
        )
    return float(lag)


def found_with_lag(
    search: Search,
    records: Cleaned,
    wanted: Wanted,
    options: Options,
    families: Sequence[Family] = (),
) -> Found:
    """Search, and give the model the lag that is asked for.

    A time constant that is given is held: everything is chosen for the drive as it comes out of
    the lag. ``"auto"``: what the search takes for a delay is fitted as a lag, as a delay and as
    both, and what leaves least is taken.

    Parameters
    ----------
    search
        Identifies without a lag.
    records
        What from.
    wanted
        As of ``identify``.
    options
        What the user wants.
    families
        That are named.

    Raises
    ------
    InputError
        If a time constant is no lag of records of their sample times.
    NotIdentifiableError
        If the family has dynamics of its own.
    """
    if wanted is None:
        return search(records, options)
    if isinstance(wanted, float):
        _require_place(families)
        found = search(lagged(records, wanted), options)
        return _held(found, records.records, wanted)
    found = search(records, options)
    if found.fit.family.answers_late:
        return found
    options.say("lag")
    work = LagOrDelay.of(found, options)
    return work.told(work.from_guesses(search, records))


def _require_place(families: Sequence[Family]) -> None:
    for each in families:
        if each.answers_late:
            raise NotIdentifiableError(
                f"{each.name} has linear dynamics of its own, which hold any lag; leave out lag, "
                "or choose another family"
            )


def search_beside_lag(
    search: Search, found: Found, wanted: Wanted, options: Options
) -> tuple[Search, Options]:
    """Give how to search again for what else there is, as creep, with the lag that was found.

    Parameters
    ----------
    search
        Identifies without a lag.
    found
        What was found with a lag, or without.
    wanted, options
        As of ``found_with_lag``.

    Returns
    -------
    Search
        Gives models with that lag, free where it was estimated.
    Options
        With the delay that was found beside a free lag: both free are one too many.
    """
    if not isinstance(found.fit.family, LaggingFamily):
        return search, options
    tau, free = float(found.fit.solution.theta[-1]), wanted == AUTO

    def again(records: Cleaned, how: Options) -> Found:
        return _held(search(lagged(records, tau), how), records.records, tau, free)

    return again, replace(options, delay=found.data.lag) if free else options


def _held(
    found: Found, records: Sequence[Record], time_constant: float, free: bool = False
) -> Found:
    """Give the model a lag that is known, and the records their own drive again."""
    data = found.data
    whole = tuple(replace(each, u=own.u) for each, own in zip(data.records, records, strict=True))
    data = replace(data, records=whole, measured_inputs=(), keeps_corners=False).delayed(data.lag)
    longest = LONGEST * time_constant
    fits = [
        lagging(each, data.records[0].dt, time_constant, held=not free, longest=longest)
        for each in (found.fit, *found.rivals)
    ]
    return replace(found, data=data, fit=fits[0], rivals=tuple(fits[1:]))
