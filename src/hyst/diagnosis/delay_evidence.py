"""What records say of the delay between input and output, before any model."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.compatible_delays import (
    CompatibleDelays,
    Costs,
    compatible_delays,
    lowest_between,
)
from hyst.diagnosis.costs_by_record import CostsByRecord
from hyst.diagnosis.delay_costs import DelayCosts, clean_output, span_of
from hyst.diagnosis.repetition import noise_by_repetition
from hyst.signals import Record, estimate_noise, reversals

Flags = NDArray[np.bool_]
Indices = NDArray[np.intp]

_SMALLEST_TURN = 0.05
"""Of an input's range."""

_ONE_AMPLITUDE = 0.1
"""Strokes that differ by less, as a part of the longest, are of one amplitude."""

_SAME_RATE = 1.3
"""Mean rates of inputs whose ratio is less are alike."""

_FEWEST_ROWS = 16
_AS_WELL = 0.1
"""By how much more squares, as a part, plays alone may leave to be asked for the delay."""

_LEAST_OF_TURNS = 0.1
_LEAST_LEAD, _LEAST_LAG, _LEAST_OF_ONE_AMPLITUDE = 0.5, 0.2, 0.5
"""Samples: what is steep between two samples looks like less than that, and more so where all
strokes are sampled at the same levels."""

_SURELY = 3.0
"""Standard deviations of noise by which an output must have moved between the turns."""

_WHOLE = 0.15
"""Samples, or as a part of a wider interval: an estimate so near a whole number is taken for it."""


@dataclass(frozen=True)
class DelayEvidence:
    """The delay of an output, with what it is known by.

    Parameters
    ----------
    delay
        Samples of the first record, > 0 where the output lags; 0 unless the records exclude it,
        ``stated`` says how surely.
    low, high
        Its 95 % interval, samples.
    limit
        Delays from ``-limit`` to ``limit`` were tried, samples.
    residual_rms
        What general loops leave at the best delay, output units.
    noise_rms
        What an output does not repeat when its drive does; where no drive repeats, what is rough
        in it; output units. None if there was nothing to measure it by.
    describes
        Whether what the loops leave is that noise.
    excludes_zero
        Whether the records exclude that there is no delay.
    one_amplitude
        Whether all strokes are equally long: then a delay and a small radius are much alike.
    rate_or_lag
        Whether records at several rates show a lag that loops growing with the rate explain as
        well: then no delay is taken, though ``high`` tells how much there may be.
    """

    delay: float
    low: float
    high: float
    limit: float
    residual_rms: float
    noise_rms: float | None
    describes: bool
    excludes_zero: bool
    one_amplitude: bool
    rate_or_lag: bool = False

    def undecided(self) -> DelayEvidence:
        """Give the same where general loops have no say: 0, and an interval that holds it."""
        low, high = min(self.low, 0.0), max(self.high, 0.0)
        return replace(self, delay=0.0, low=low, high=high, excludes_zero=False)

    @property
    def wide(self) -> bool:
        """Whether the interval is wider than a sample."""
        return self.high - self.low > 1.0

    @property
    def stated(self) -> tuple[float, float]:
        """Lowest and highest delay to tell: one that misfit may have bought does not exclude none.

        In strokes of one amplitude a delay stands in for what loops of every kind lack, as the
        saturation of a switching material, and its interval says nothing of that.
        """
        if self.delay > 0.0 and self.one_amplitude and not self.describes:
            return min(self.low, 0.0), self.high
        return self.low, self.high

    @property
    def turns_early(self) -> bool:
        """Whether the output turns before its input, though as no mere lead explains."""
        return not self.describes and self.low < 0.0 and self.high <= 0.0 and not self.delay

    def said(self, dt: float) -> str:
        """Give a sentence for people.

        Parameters
        ----------
        dt
            Sample time of the first record, s.
        """
        interval = f"{_number(self.low)} to {_number(self.high)}"
        if self.excludes_zero:
            amount = abs(self.delay)
            ends = sorted((abs(self.low), abs(self.high)))
            how = f"{_samples(amount)} ({_number(ends[0])} to {_number(ends[1])}), "
            how += f"{amount * dt:.3g} s"
            if self.delay > 0.0:
                slow = "" if self.describes else ", or follows slowly, as by creep or dynamics"
                return f"the output lags by {how}{slow}"
            return (
                f"the output is ahead of the input by {how}, which no actuator is: the channels "
                "are not aligned"
            )
        if self.turns_early:
            return (
                "the output turns before its input: it follows the input's rate, as a viscous "
                "force does, or the channels are not aligned; no delay is taken"
            )
        if self.rate_or_lag:
            return (
                f"a delay of up to {_number(self.high)} samples or loops that grow with the rate "
                "explain the records alike; no delay is taken unless a model tells them apart"
            )
        if self.limit == 0.0:
            return "nothing can be said of a delay: the records are too short, or show no turns"
        if not self.describes and self.wide:
            return (
                "nothing certain can be said of a delay: general loops leave more than the noise, "
                f"and with {interval} samples they leave hardly more or less"
            )
        if self.one_amplitude and self.wide:
            return (
                "delay and radius cannot be told apart by strokes of one amplitude: "
                f"{interval} samples are as good as none"
            )
        return f"no delay is needed: {interval} samples are as good"


def evidence_of_delay(
    records: Sequence[Record], starts: Sequence[int], kept: Sequence[Flags | None] = ()
) -> DelayEvidence:
    """Find the delays that records leave possible, and the one to use.

    General loops that turn where their input turns (see ``TurningLoops``) are fitted for many
    delays, parts of a sample and negative ones among them. A delay is possible while its residual
    exceeds the least by no more than noise and misfit explain. It is 0 if 0 is possible. If not,
    and plays alone describe the records as well, it is their best one within the interval.

    Parameters
    ----------
    records
        One or more; the delay in seconds is common to all.
    starts
        First sample of each that can be used: from there its memory is known.
    kept
        For each record, shape (N,), which samples are measurements, or None for all; empty if all
        of all are.

    Returns
    -------
    DelayEvidence
    """
    turns = [
        reversals(each.u, _SMALLEST_TURN * float(np.ptp(each.u))).astype(np.intp)
        for each in records
    ]
    longest = _longest(records, starts, turns)
    flags = tuple(kept) or (None,) * len(records)
    if longest < 1 or not _turns_are_seen(turns, flags):
        return DelayEvidence(0.0, 0.0, 0.0, 0.0, 0.0, None, False, False, False)
    outputs = [clean_output(each, own) for each, own in zip(records, flags, strict=True)]
    unit = span_of(outputs)
    one = _one_amplitude(records, starts, turns)

    def costs_of(chosen: slice) -> DelayCosts:
        return DelayCosts.of(
            records[chosen],
            outputs[chosen],
            starts[chosen],
            flags[chosen],
            float(longest),
            [each.size for each in turns[chosen]],
            bends=not one,
            dt=records[0].dt,
            y_range=unit,
        )

    together = costs_of(slice(None))
    costs: Costs = together
    noise = _noise_of_all(records, outputs, [p.loops.rows.size for p in together.parts])
    if costs.rows < _FEWEST_ROWS:
        return DelayEvidence(0.0, 0.0, 0.0, 0.0, 0.0, noise or None, False, False, False)
    found = compatible_delays(costs, longest, noise / unit)
    certain = found.describes and found.low <= 0.0 <= found.high
    if not certain and _rates_differ(records):
        # What changes with the rate must not pass for a delay: every record has its own loops.
        costs = CostsByRecord(tuple(costs_of(slice(i, i + 1)) for i in range(len(records))))
        found = compatible_delays(costs, longest, noise / unit)
    delay, low, high = _judged(costs, found, longest, one)
    bought = one and (delay < 0.0 or (delay > 0.0 and not found.describes))
    if bought and not _turns_apart(records, outputs, turns, delay, noise):
        delay, low, high = 0.0, min(low, 0.0), max(high, 0.0)
    rate_or_lag = delay > 0.0 and _rates_differ(records)
    if rate_or_lag:
        delay, low = 0.0, 0.0
    return DelayEvidence(
        delay=delay,
        low=low,
        high=high,
        limit=float(longest),
        residual_rms=found.residual * unit,
        noise_rms=noise or None,
        describes=found.describes,
        excludes_zero=not low <= 0.0 <= high,
        one_amplitude=one,
        rate_or_lag=rate_or_lag,
    )


def _judged(
    costs: Costs, found: CompatibleDelays, longest: int, one_amplitude: bool
) -> tuple[float, float, float]:
    """Give the delay to use and the interval to tell."""
    low, high = found.low, found.high
    if low <= 0.0 <= high:
        return 0.0, low, high
    if high < 0.0 and not found.describes:
        # Loops of another kind, as those of a force that follows the speed, turn early as well.
        return 0.0, -float(longest), 0.0
    if high > -_LEAST_LEAD and low < (_LEAST_OF_ONE_AMPLITUDE if one_amplitude else _LEAST_LAG):
        return 0.0, min(low, 0.0), max(high, 0.0)
    inside = np.arange(math.ceil(low * 4.0), math.floor(high * 4.0) + 1) / 4.0
    about = min(inside.tolist(), key=lambda d: costs.cost(d, plain=True), default=found.best)
    plain = costs.cost(about, plain=True) <= (1.0 + _AS_WELL) * costs.cost(found.best)
    delay = lowest_between(costs, about if plain else found.best, plain)
    delay = min(max(delay, low), high)
    whole = float(round(delay))
    close = abs(delay - whole) <= _WHOLE * max(1.0, high - low) and low <= whole <= high
    return (whole if close else delay), low, high


def _turns_apart(
    records: Sequence[Record],
    outputs: Sequence[NDArray[np.float64]],
    turns: Sequence[Indices],
    delay: float,
    noise: float,
) -> bool:
    """Tell whether outputs are seen to turn after their inputs, or before them, by a delay.

    Late ones go on after the input has turned, early ones go back before it does. Strokes of one
    amplitude that end where a material is saturated show neither; a delay then only stands in for
    the shape of a loop.
    """
    moved = []
    for record, y, places in zip(records, outputs, turns, strict=True):
        off = round(delay * records[0].dt / record.dt)
        seen = places[(places >= -off) & (places + off < y.size)]
        way = np.sign(y[seen] - y[np.maximum(seen - 4 * abs(off), 0)])
        moved += (way * (y[seen + off] - y[seen])).tolist()
    sure = _SURELY * noise * math.sqrt(2.0 / max(len(moved), 1))
    return len(moved) > 0 and float(np.mean(moved)) > sure


def _noise_of_all(
    records: Sequence[Record], outputs: Sequence[NDArray[np.float64]], rows: Sequence[int]
) -> float:
    noises = [_noise(r, y) for r, y in zip(records, outputs, strict=True)]
    squares = sum(n * s**2 for n, s in zip(rows, noises, strict=True))
    return math.sqrt(squares / max(sum(rows), 1))


def _turns_are_seen(turns: Sequence[Indices], flags: Sequence[Flags | None]) -> bool:
    """Whether turns of the input were measured: a sensor at both its ends shows none of them."""
    seen = [
        places.size if own is None else int(own[places].sum())
        for places, own in zip(turns, flags, strict=True)
    ]
    return sum(seen) > _LEAST_OF_TURNS * sum(places.size for places in turns)


def _rates_differ(records: Sequence[Record]) -> bool:
    rates = [float(np.abs(np.diff(each.u)).mean()) / each.dt for each in records]
    return max(rates) > _SAME_RATE * min(rates)


def _noise(record: Record, clean: NDArray[np.float64]) -> float:
    repeated = noise_by_repetition(record)
    return estimate_noise(clean) if repeated is None else repeated


def _longest(records: Sequence[Record], starts: Sequence[int], turns: Sequence[Indices]) -> int:
    """Give a quarter of the shortest usual stroke, but an eighth of the shortest record's use."""
    most = math.inf
    for record, start, places in zip(records, starts, turns, strict=True):
        if places.size < 2 or np.ptp(record.y) == 0.0:
            return 0
        own = min((len(record) - start) / 8.0, float(np.median(np.diff(places))) / 4.0)
        most = min(most, own * record.dt / records[0].dt)
    return int(most)


def _one_amplitude(
    records: Sequence[Record], starts: Sequence[int], turns: Sequence[Indices]
) -> bool:
    strokes = [
        np.abs(np.diff(record.u[places[places >= start]]))
        for record, start, places in zip(records, starts, turns, strict=True)
    ]
    together = np.concatenate(strokes)
    if together.size == 0:
        return True
    return bool(together.min() > (1.0 - _ONE_AMPLITUDE) * together.max())


def _number(value: float) -> str:
    return f"{value:.2g}" if abs(value) < 1.0 else f"{value:.3g}"


def _samples(amount: float) -> str:
    return "1 sample" if amount == 1.0 else f"{amount:.3g} samples"
