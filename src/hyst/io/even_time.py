"""The step of a record's time, and its signals on even steps."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.io.coarse_stamps import coarse_stamps
from hyst.io.rounded_stamps import even_steps
from hyst.io.table import Table
from hyst.io.time_axis import TOLERANCE, Gap, first_step_back, resample, worst_gap
from hyst.io.usable_rows import LONGEST_GAP, most_left_out
from hyst.io.wrapped_stamps import counted_on

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Samples:
    """Samples taken from a file: their rows there, and their time in units of so many seconds.

    The time is the rows themselves when the rate is given.

    Parameters
    ----------
    table
        Where they come from.
    rows
        Their rows there.
    time
        Their stamps, shape (N,).
    seconds
        Seconds in the unit of the stamps.
    signals
        Input and output, shape (N,).
    rate_given
        Whether the time is the rows, at a rate that was given.
    """

    table: Table
    rows: NDArray[np.intp]
    time: Array
    seconds: float
    signals: list[Array]
    rate_given: bool

    def place(self, sample: int) -> str:
        """Say where a sample stands in the file."""
        return self.table.place(int(self.rows[sample]))

    def step(self, gap: float) -> float:
        """Turn a gap into seconds; differences of stamps hold 12 digits, and 0.01 is 0.01."""
        step = gap * self.seconds
        return step if self.rate_given else float(f"{step:.12g}")


@dataclass(frozen=True, eq=False)
class OnEvenSteps:
    """Signals on even steps.

    Parameters
    ----------
    dt
        Seconds.
    signals
        Input and output.
    notes
        What was found out or done, one sentence each.
    """

    dt: float
    signals: list[Array]
    notes: tuple[str, ...] = ()


def on_even_steps(samples: Samples, repair: bool, longest_gap: int) -> OnEvenSteps:
    """Give the step of a time axis; with ``repair`` make an uneven one even.

    Parameters
    ----------
    samples
        What was read.
    repair
        Whether to use the mean rate of stamps that repeat, and to interpolate.
    longest_gap
        How many samples may be missing one after the other.

    Returns
    -------
    OnEvenSteps

    Raises
    ------
    InputError
        If time falls or stands, or is uneven, and cannot be repaired or may not be.
    """
    # Stamps too far apart for a double give infinite gaps, which are uneven and thus refused.
    with np.errstate(over="ignore", invalid="ignore"):
        return _on_even_steps(samples, repair, longest_gap)


def _on_even_steps(samples: Samples, repair: bool, longest_gap: int) -> OnEvenSteps:
    wrapped = counted_on(samples.time)
    notes: tuple[str, ...] = ()
    if wrapped is not None:
        notes = (
            f"the time starts again at {wrapped.modulus:.12g} at {samples.place(wrapped.first)}, "
            f"as a counter that is full; it was counted on ({wrapped.times} times)",
        )
        samples = replace(samples, time=wrapped.time)
    back = first_step_back(samples.time)
    if back is not None:
        coarse = _at_mean_rate(samples, repair)
        if coarse is None:
            raise _step_back(samples, back)
        return replace(coarse, notes=(*notes, *coarse.notes))
    found = _increasing(samples, repair, longest_gap)
    return replace(found, notes=(*notes, *found.notes))


def _increasing(samples: Samples, repair: bool, longest_gap: int) -> OnEvenSteps:
    time = samples.time
    gap = worst_gap(time)
    if gap.even:
        mean = float(time[-1] - time[0]) / (time.size - 1)
        return OnEvenSteps(samples.step(mean), samples.signals)
    even = None if samples.rate_given else even_steps(time)
    if even is not None:
        step = samples.step(even.step)
        off, rounded = even.deviation * samples.seconds, even.resolution * samples.seconds
        why = f" (they are rounded to {rounded:.3g} s)" if rounded else ""
        note = (
            f"the stamps are up to {off:.3g} s away from even steps{why}; the samples were taken "
            f"as even, {step:.9g} s apart"
        )
        return OnEvenSteps(step, samples.signals, (note,))
    worst = f"{gap.size * samples.seconds:.6g} s after {samples.place(gap.row)}"
    hindrance = _hindrance(time, gap, longest_gap)
    if not repair:
        raise _uneven(samples, gap, worst, hindrance)
    if hindrance:
        raise InputError(
            f"{samples.table.source}: time is uneven, the worst gap is {worst}; {hindrance}; cut "
            "the record at its gaps, or give a higher longest_gap"
        )
    step = samples.step(gap.median)
    signals = resample(time, samples.signals, gap.median)
    more = signals[0].size - time.size
    filled = f", {more} of {signals[0].size} samples filled in" if more > 0 else ""
    note = f"resampled linearly onto steps of {step:.6g} s{filled}; the worst gap was {worst}"
    return OnEvenSteps(step, signals, (note,))


def _hindrance(time: Array, gap: Gap, longest_gap: int) -> str:
    """Say why interpolation would invent too much; nothing if it would not."""
    lost = np.nan_to_num(np.diff(time) / gap.median - 1.0, nan=np.inf)
    longest = float(lost.max())
    if longest > longest_gap + TOLERANCE * (longest_gap + 1):
        return f"{longest:.6g} samples are missing there, and repair fills in {longest_gap} at most"
    filled = int(np.rint(np.maximum(lost, 0.0)).sum())
    # Whoever asks for longer gaps knows what is filled in.
    most = most_left_out(time.size) if longest_gap <= LONGEST_GAP else filled
    if filled > most:
        return f"{filled} samples are missing, and repair fills in {most} at most"
    return ""


def _uneven(samples: Samples, gap: Gap, worst: str, hindrance: str) -> InputError:
    advice = (
        f"{hindrance}, so cut the record at its gaps, or give a rate instead"
        if hindrance
        else "resample with the option repair, or give a rate instead"
    )
    return InputError(
        f"{samples.table.source}: time is uneven, the worst gap is {worst} and the median gap "
        f"{gap.median * samples.seconds:.6g} s (tolerance {TOLERANCE:.0%}); {advice}"
    )


def _at_mean_rate(samples: Samples, repair: bool) -> OnEvenSteps | None:
    """Take samples as even whose stamps repeat because their clock is slower; None if not so."""
    coarse = coarse_stamps(samples.time)
    if coarse is None:
        return None
    dt, clock = samples.step(coarse.step), coarse.clock * samples.seconds
    often = (
        f"{coarse.fewest}" if coarse.fewest == coarse.most else f"{coarse.fewest} to {coarse.most}"
    )
    what = f"stamps stand {often} times each, for their clock goes on every {clock:.6g} s only"
    mean = f"the mean rate is {1.0 / dt:.9g} Hz"
    if not repair:
        raise InputError(
            f"{samples.table.source}: the stamps are coarser than the samples: {what}; {mean}; "
            f"use it with the option repair, or give rate {1.0 / dt:.9g}"
        )
    return OnEvenSteps(dt, samples.signals, (f"{what}; {mean}, and samples were taken as even",))


def _step_back(samples: Samples, back: int) -> InputError:
    time, seconds = samples.time, samples.seconds
    before, after = time[back - 1] * seconds, time[back] * seconds
    where = f"{samples.table.source}: time goes from {before:.12g} s to {after:.12g} s at "
    where += f"{samples.place(back)}; it must increase"
    rises = np.diff(time[:back])
    if rises.size and after < before and time[back] <= time[0] + 2.0 * float(np.median(rises)):
        return InputError(
            f"{where}; it starts again there, as where one record follows another, so put each "
            "into a file of its own"
        )
    return InputError(f"{where}, so correct the stamps, or give a rate instead")
