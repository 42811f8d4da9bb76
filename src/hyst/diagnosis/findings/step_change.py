"""A gain or an offset that changes once, within the record."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.memory_branches import repeated_segments
from hyst.diagnosis.repetition import Repetition, changes
from hyst.diagnosis.wording import amount, of_record, percent
from hyst.signals import Record

Array = NDArray[np.float64]

NAME = "step change"
_FEWEST_PAIRS, _FEWEST_SAMPLES = 6, 3
_LEAST_GAIN = 0.005
_STANDS = -0.9  # a change of the gain by which nothing of it is left
_LEAST_OFFSET = 0.003  # of the range
# Of the scatter that there is without the step.
_LEAST_SCATTERS = 6.0
_EXPLAINED = 0.6
_ENOUGH_PERIODS = 3.0
_MOST_ERRORS = 4.0  # of the least


@dataclass(frozen=True)
class Step:
    """A value that changes between two samples.

    Parameters
    ----------
    sample
        After which it is another.
    size
        By how much.
    """

    sample: int
    size: float


def find(evidence: Evidence) -> Iterator[Finding]:
    """Warn where the record continues with another gain or offset: two actuators, a moved sensor.

    Parts that ought to repeat are compared with those before them; a step is where only those
    comparisons fail that reach across one sample.
    """
    for number, record in evidence.numbered():
        repetition = evidence.repetition(number)
        if repetition is None or repetition.periods < _ENOUGH_PERIODS:
            # Branches compare over shorter times than whole periods.
            repetition = Repetition(tuple(repeated_segments(record.u)), 0.0, ())
        pairs = _pairs(repetition, record)
        gain = _step(pairs, pairs[:, 3] - 1.0, pairs[:, 5], drifts=False)
        where = of_record(evidence, number)
        if gain is not None and gain.size < _STANDS:
            yield _stands(number, where, gain)
            continue
        if gain is not None and abs(gain.size) >= _LEAST_GAIN:
            words = f"the gain changes by {percent(gain.size)}"
            yield _finding(number, where, words, gain, "gain")
            continue
        offset = _step(pairs, pairs[:, 2], pairs[:, 4], drifts=True)
        if offset is not None and abs(offset.size) >= _LEAST_OFFSET * float(np.ptp(record.y)):
            words = f"the output jumps by {amount(offset.size, record.output_unit)}"
            yield _finding(number, where, words, offset, "offset")


def _finding(number: int, where: str, words: str, step: Step, which: str) -> Finding:
    return Finding(
        NAME,
        "warning",
        f"{where}{words} about sample {step.sample} and stays there.",
        "One model cannot be both: cut the record there (another actuator, load, sensor range or "
        "mount?) and identify the parts on their own.",
        record=number,
        samples=np.array([step.sample], dtype=np.intp),
        amounts={which: step.size},
    )


def _stands(number: int, where: str, step: Step) -> Finding:
    """Give no end: what comes later has nothing to be compared with."""
    return Finding(
        NAME,
        "warning",
        f"{where}the output stops following the input about sample {step.sample}, for a while or "
        "for good.",
        "Look for a sensor or a transfer that was lost there, and cut that part out.",
        record=number,
        samples=np.array([step.sample], dtype=np.intp),
        amounts={"gain": step.size},
    )


def _pairs(repetition: Repetition, record: Record) -> Array:
    """Rows of middle before and now, mean change and gain against before, and their errors."""
    parts = []
    for start, stop, lag in repetition.segments:
        part = 0.25 * repetition.period
        count = max(int((stop - start) / part), 1) if part > 0.0 else 1
        edges = [start + round(which * (stop - start) / count) for which in range(count + 1)]
        for begin, end in pairwise(edges):
            if end - begin >= _FEWEST_SAMPLES:
                _, change, _ = changes(record, begin, end, lag)
                parts.append((0.5 * (begin + end), lag, record.y[begin:end] - change, change))
    if not parts:
        return np.empty((0, 6))
    # Of most parts, for a step is in few of them.
    noise = float(np.median([np.std(change) for *_, change in parts]))
    rows = [_compared(*part, noise) for part in parts]
    return np.array([row for row in rows if row is not None]).reshape(-1, 6)


def _compared(
    middle: float, lag: float, before: Array, change: Array, noise: float
) -> tuple[float, ...] | None:
    """Give the row of one part; None where the output moves less than its noise."""
    centred = before - before.mean()
    # The noise of what was before adds to its energy and not to the product.
    energy = float(centred @ centred) - 0.5 * before.size * noise**2
    if energy <= 0.0:
        return None
    gain = float(centred @ (before + change)) / energy
    errors = (noise / math.sqrt(before.size), noise / math.sqrt(energy))
    return (middle - lag, middle, float(change.mean()), gain, *errors)


def _step(pairs: Array, values: Array, errors: Array, *, drifts: bool) -> Step | None:
    """Find the one sample across which values are another, beyond chance; None if there is none."""
    # Short branches tell a gain badly.
    telling = errors <= _MOST_ERRORS * float(np.min(errors, initial=np.inf))
    pairs, values, errors = pairs[telling], values[telling], errors[telling]
    before, now = pairs[:, 0], pairs[:, 1]
    if values.size < _FEWEST_PAIRS:
        return None
    if drifts:
        # The drift of most comparisons, which a few that jump do not move.
        values = values - float(np.median(values / (now - before))) * (now - before)
    best, least = None, 1.0 - _EXPLAINED
    moments = np.unique(np.concatenate([before, now]))
    for moment in (0.5 * (moments[:-1] + moments[1:]))[:: max(moments.size // 300, 1)]:
        across = (before < moment) & (now > moment)
        # What is one on either side of the step, and the step itself more than once.
        if min(across.sum(), (now < moment).sum(), (before > moment).sum()) < 2:
            continue
        # Two parts may hold the step inside, and are then out of all proportion.
        size = float(np.median(values[across]))
        whole = float(np.minimum(np.abs(values), abs(size)).sum())
        left = float(np.sort(np.minimum(np.abs(values - size * across), abs(size)))[:-2].sum())
        if left < least * whole:
            best, least = float(moment), left / whole
    if best is None:
        return None
    across = (before < best) & (now > best)
    size = float(np.median(values[across]))
    alike = np.abs(values[across] - size) < 0.4 * abs(size)
    if alike.sum() < max(2.0, 0.5 * across.sum()):
        return None
    scatter = 1.4826 * float(np.median(np.abs(values[~across])))
    # A scatter told by few comparisons may be too small by chance.
    scatter *= 1.0 + 4.0 / int((~across).sum())
    if abs(size) < _LEAST_SCATTERS * max(scatter, float(np.median(errors[across]))):
        return None
    return Step(round(best), size)
