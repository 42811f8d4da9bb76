"""Records of several sample times at the one that divides them all.

Sampled dynamics hold for one sample time. A record that is sampled more slowly has an input that a
converter held between its samples, so it is known at all times; its output is compared where it was
measured, and nowhere else.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data, prepare
from hyst.signals import Record

MOST_FINER = 16
"""Times that a record may be sampled more slowly than what all have in common."""

_CLOCK = 1e-6  # relative: a ratio of clocks is known to this


@dataclass(frozen=True, eq=False)
class AtOneTime:
    """Records at one sample time.

    Parameters
    ----------
    records
        Inputs held, outputs between two measured ones on the line between them.
    factors
        By how many samples each stands for one of its own.
    notes
        A sentence for each record that was taken to another sample time.
    """

    records: tuple[Record, ...]
    factors: tuple[int, ...]
    notes: tuple[str, ...]

    def prepared(self, start: Literal["auto"] | int) -> Data:
        """Give data of these records that count where they were measured.

        Parameters
        ----------
        start
            ``"auto"`` or the first sample to use, counted in samples of each record.
        """
        data = prepare(self.records, start)
        if all(each == 1 for each in self.factors):
            return data
        pairs = zip(self.records, self.factors, strict=True)
        kept = tuple(None if n == 1 else _measured(len(r), n) for r, n in pairs)
        if start == "auto":
            return replace(data, kept=kept)
        starts = tuple(int(start) * n for n in self.factors)
        return replace(data, kept=kept, starts=starts)


def at_one_sample_time(records: tuple[Record, ...], known: float | None = None) -> AtOneTime:
    """Take records to the sample time that divides those of all.

    Parameters
    ----------
    records
        Each with its own sample time.
    known
        Sample time of what is known before and cannot be sampled anew, s; None where nothing is.

    Returns
    -------
    AtOneTime
        The records themselves where they have one sample time.

    Raises
    ------
    InputError
        If no sample time divides all, a record would be more than sixteen times as long at it, or
        it is another one than what is known has.
    """
    times = [record.dt for record in records]
    if known is None and max(times) - min(times) <= _CLOCK * min(times):
        return AtOneTime(records, (1,) * len(records), ())
    dt, factors = _common(times if known is None else [*times, known])
    if known is not None and abs(dt - known) > _CLOCK * known:
        dt, factors = known, [round(each / known) for each in (*times, known)]
        if any(abs(n * dt - each) > _CLOCK * each for n, each in zip(factors, times, strict=False)):
            raise InputError(
                f"the dynamics that are given have the sample time {known:.6g} s, the records "
                f"{_listed(times)} s; give dynamics of a sample time that divides the records', a "
                "system in continuous time, or a frequency response"
            )
    pairs = list(zip(records, factors, strict=False))
    notes = tuple(
        f"record {number}, sampled every {record.dt:.6g} s, was taken to {dt:.6g} s: its input is "
        "held between its samples, as a converter does, and its output compared at its own samples "
        "only"
        for number, (record, n) in enumerate(pairs, 1)
        if n > 1
    )
    lifted = tuple(_lifted(record, n, dt) for record, n in pairs)
    return AtOneTime(lifted, tuple(n for _, n in pairs), notes)


def finest(overview: Overview) -> Overview:
    """Give the records that were measured at every sample; all where none was.

    Parameters
    ----------
    overview
        The records.
    """
    data = overview.data
    if not data.kept:
        return overview
    whole = [i for i, each in enumerate(data.kept) if each is None or not _is_raster(each)]
    if not whole or len(whole) == len(data.records):
        return overview

    def of(parts: tuple) -> tuple:  # type: ignore[type-arg]
        return tuple(parts[i] for i in whole) if parts else parts

    records: tuple[Record, ...] = of(data.records)
    low, high = (min(r.u.min() for r in records), max(r.u.max() for r in records))
    chosen = replace(
        data,
        half_range=float(high - low) / 2.0,
        records=records,
        starts=of(data.starts),
        kept=of(data.kept),
        disturbances=of(data.disturbances),
        measured_inputs=of(data.measured_inputs),
        smoothers=of(data.smoothers),
        past=of(data.past),
    )
    return Overview(chosen, overview.delay, rates_matter=overview.rates_matter)


def marked_at_one_time(
    data: Data, records: tuple[Record, ...], kept: tuple[NDArray[np.bool_] | None, ...]
) -> Data:
    """Leave out what is no measurement of records that were taken to another sample time.

    Parameters
    ----------
    data
        At one sample time.
    records, kept
        As they were, and which of their samples count; None for all.
    """
    if len(data.records) != len(records) or not data.kept or all(each is None for each in kept):
        return data
    marks = []
    for at_one, record, own, counts in zip(data.records, records, data.kept, kept, strict=True):
        n = (len(at_one) - 1) // max(len(record) - 1, 1)
        mark = _measured(len(at_one), n) if own is None else own.copy()
        if counts is not None:
            mark[::n] &= counts
        marks.append(own if counts is None else mark)
    return replace(data, kept=tuple(marks))


def _is_raster(kept: NDArray[np.bool_]) -> bool:
    """Tell whether samples count at most every second time, as those of a slower record."""
    return bool(np.mean(kept) < 0.6)


def _measured(length: int, n: int) -> NDArray[np.bool_]:
    mask = np.zeros(length, dtype=np.bool_)
    mask[::n] = True
    return mask


def _lifted(record: Record, n: int, dt: float) -> Record:
    """Give a record at a sample time n times as short."""
    if n == 1:
        return record if record.dt == dt else replace(record, dt=dt)
    last = len(record) - 1
    at = np.arange(n * last + 1)
    y = np.interp(at, n * np.arange(last + 1), record.y)
    y[::n] = record.y
    return replace(record, u=record.u[at // n], y=y, dt=dt)


def _common(times: list[float]) -> tuple[float, list[int]]:
    """Give the longest time of which all are multiples, and the multiples."""
    shortest = min(times)
    shares = [Fraction(each / shortest).limit_denominator(MOST_FINER) for each in times]
    divisor = math.lcm(*(each.denominator for each in shares))
    factors = [int(each * divisor) for each in shares]
    exact = all(
        abs(float(share) * shortest - each) <= _CLOCK * each
        for share, each in zip(shares, times, strict=True)
    )
    if not exact or max(factors) > MOST_FINER:
        raise InputError(
            f"the records have sample times of {_listed(times)} s; linear dynamics are identified "
            "for one sample time, and none divides all of these with less than "
            f"{MOST_FINER + 1} samples for one; resample the records to one"
        )
    return shortest / divisor, factors


def _listed(times: list[float]) -> str:
    return ", ".join(dict.fromkeys(f"{each:.6g}" for each in times))
