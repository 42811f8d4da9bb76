"""A first-order lag of the drive as a stage of the model that a search has found without it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Literal

import numpy as np

from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.families.drive_noise import told_of_drives
from hyst.identification.families.family import Family
from hyst.identification.families.option import AUTO
from hyst.identification.lag.lag_or_delay import LagOrDelay, Search
from hyst.identification.lag.lagging_family import LaggingFamily
from hyst.identification.lag.stage import LONGEST, lagged, lagging
from hyst.identification.options import Options
from hyst.identification.record_use.cleaned import Cleaned
from hyst.identification.record_use.smoothed_drive import Smoother, driven_by
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
        return _with_lag_held(search, records, options, wanted, families)
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
    search: Search, found: Found, wanted: Wanted, options: Options, families: Sequence[Family] = ()
) -> tuple[Search, Options]:
    """Give how to search again for what else there is, as creep, with the lag that was found.

    Parameters
    ----------
    search
        Identifies without a lag.
    found
        What was found with a lag, or without.
    wanted, options, families
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
        return _with_lag_held(search, records, how, tau, families, free)

    return again, replace(options, delay=found.data.lag) if free else options


def _with_lag_held(
    search: Search,
    records: Cleaned,
    options: Options,
    time_constant: float,
    families: Sequence[Family],
    free: bool = False,
) -> Found:
    """Search behind a lag that is known.

    Noise of a measured drive is looked for before the lag, behind which it is white no more.
    """
    drives, smoothers = _without_noise(records.records, families, options)
    found = search(lagged(replace(records, records=drives), time_constant), options)
    if any(smoothers):
        found = replace(
            found,
            data=replace(found.data, smoothers=smoothers),
            notes=(*told_of_drives(smoothers), *found.notes),
        )
    elif any(found.data.smoothers):
        drives = tuple(map(driven_by, drives, found.data.smoothers))
    return _held(found, drives, time_constant, free)


def _without_noise(
    records: tuple[Record, ...], families: Sequence[Family], options: Options
) -> tuple[tuple[Record, ...], tuple[Smoother | None, ...]]:
    """Smooth drives as the one family does that is named, if it chooses by itself how strongly.

    A low-pass of a given time constant may as well follow the lag.
    """
    if len(families) != 1:
        return records, ()
    data, _ = families[0].records_to_use(records, options.start)
    chosen = any(each is not None and each.time_constant is None for each in data.smoothers)
    return (data.records, data.smoothers) if chosen else (records, ())


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
