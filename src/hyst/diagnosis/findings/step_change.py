"""A gain or an offset that changes once, within the record."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.repetition import Repetition, changes
from hyst.diagnosis.wording import amount, of_record, percent
from hyst.signals import Record

Array = NDArray[np.float64]

NAME = "step change"
_FEWEST_PAIRS = 4
_LEAST_GAIN = 0.005
_LEAST_OFFSET = 0.003  # of the range
# Of the scatter that there is without the step.
_LEAST_SCATTERS = 6.0
_EXPLAINED = 0.7


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
        if repetition is None:
            continue
        pairs = _pairs(repetition, record)
        gain = _step(pairs, pairs[:, 3] - 1.0, drifts=False)
        where = of_record(evidence, number)
        if gain is not None and abs(gain.size) >= _LEAST_GAIN:
            words = f"the gain changes by {percent(gain.size)}"
            yield _finding(number, where, words, gain, "gain")
            continue
        offset = _step(pairs, pairs[:, 2], drifts=True)
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


def _pairs(repetition: Repetition, record: Record) -> Array:
    """Rows of middle before, middle now, mean change and gain of the output against before."""
    rows = []
    for start, stop, lag in repetition.segments:
        half = 0.5 * repetition.period
        count = max(int((stop - start) / half), 1) if half > 0.0 else 1
        edges = [start + round(which * (stop - start) / count) for which in range(count + 1)]
        for begin, end in zip(edges[:-1], edges[1:], strict=True):
            _, change, _ = changes(record, begin, end, lag)
            now = record.y[begin:end]
            before = now - change
            centred = before - before.mean()
            energy = float(centred @ centred)
            gain = float(centred @ (now - now.mean())) / energy if energy > 0.0 else 1.0
            middle = 0.5 * (begin + end)
            rows.append((middle - lag, middle, float(change.mean()), gain))
    return np.array(rows).reshape(-1, 4)


def _step(pairs: Array, values: Array, *, drifts: bool) -> Step | None:
    """Find the one sample across which values are another, beyond chance; None if there is none."""
    if values.size < _FEWEST_PAIRS:
        return None
    before, now = pairs[:, 0], pairs[:, 1]
    if drifts:
        # The drift of most comparisons, which a few that jump do not move.
        values = values - float(np.median(values / (now - before))) * (now - before)
    energy = float(values @ values)
    best: tuple[float, float, float] | None = None
    moments = np.unique(np.concatenate([before, now]))
    for moment in 0.5 * (moments[:-1] + moments[1:])[:: max(moments.size // 300, 1)]:
        across = (before < moment) & (now > moment)
        # What is one on either side of the step, and the step itself more than once.
        if across.sum() < 2 or not (now < moment).any() or not (before > moment).any():
            continue
        size = float(values[across].mean())
        left = energy - float(across.sum()) * size**2
        if best is None or left < best[0]:
            best = (left, float(moment), size)
    if best is None or best[0] > (1.0 - _EXPLAINED) * energy:
        return None
    left, moment, size = best
    across = (before < moment) & (now > moment)
    scatter = math.sqrt(float(np.mean(np.square(values[~across]))))
    # A scatter told by few comparisons may be too small by chance.
    if abs(size) < _LEAST_SCATTERS * (1.0 + 4.0 / int((~across).sum())) * scatter:
        return None
    return Step(round(moment), size)
