"""Records that do not agree although they were driven alike: another actuator, another mount."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.loops import Loop, mean_loop
from hyst.diagnosis.wording import percent

Array = NDArray[np.float64]

NAME = "records that differ"
_SAME_RATE = 1.2
_LEAST = 0.005  # of the height of the loop, rms
_LEAST_NOISES = 6.0
# One record is named alone if it is this much further from the others than they from another.
_STANDS_OUT = 3.0
_MOST_RECORDS = 100


@dataclass(frozen=True, eq=False)
class Shape:
    """The loop of one record over the range that is compared.

    Parameters
    ----------
    record
        Which, counted from 1.
    curve
        Rising and falling branch without offset.
    noise
        rms error of the curve.
    gain
        Slope of its middle.
    width
        Widest opening over its height.
    height
        Range of the output.
    """

    record: int
    curve: Array
    noise: float
    gain: float
    width: float
    height: float


def find(evidence: Evidence) -> Iterator[Finding]:
    """Name records whose loops differ from those of the others at the same range and rate."""
    shapes = _shapes(evidence)
    if len(shapes) < 2:
        return
    height = float(np.median([each.height for each in shapes]))
    distances = _distances(shapes)
    noise = max(each.noise for each in shapes)
    least = max(_LEAST * height, _LEAST_NOISES * noise)
    nearest = np.median(distances, axis=1)  # of the others, and of itself at 0
    if len(shapes) > 2:
        odd = int(np.argmax(nearest))
        others = np.delete(np.delete(distances, odd, 0), odd, 1)
        among = float(others.max())
        apart = float(np.delete(distances[odd], odd).min())
        if apart > least and apart > _STANDS_OUT * among:
            yield _one(shapes, odd, apart / height)
            return
    furthest = float(distances.max())
    if furthest > least:
        yield _all(shapes, furthest / height)


def _one(shapes: list[Shape], odd: int, share: float) -> Finding:
    shape = shapes[odd]
    others = [each for each in shapes if each is not shape]
    gain = shape.gain / float(np.median([each.gain for each in others]))
    width = float(np.median([each.width for each in others]))
    return Finding(
        NAME,
        "warning",
        f"record {shape.record} differs from the {len(others)} others driven alike by "
        f"{percent(share)} of the output's range (rms): its gain is {gain:.4g} times theirs, its "
        f"loop {percent(shape.width)} wide and theirs {percent(width)}.",
        "It may be another actuator, load or mount: leave it out, or identify it on its own.",
        record=shape.record,
        amounts={"share": share, "gain": gain, "width": shape.width, "width of others": width},
    )


def _all(shapes: list[Shape], share: float) -> Finding:
    widths = [each.width for each in shapes]
    gains = [abs(each.gain) for each in shapes]
    names = ", ".join(str(each.record) for each in shapes[:12])
    return Finding(
        NAME,
        "warning",
        f"records {names}{', ...' if len(shapes) > 12 else ''} were driven alike and differ by up "
        f"to {percent(share)} of the output's range (rms): gains differ by "
        f"{percent(max(gains) / min(gains) - 1.0)}, and widths run from {percent(min(widths))} to "
        f"{percent(max(widths))}.",
        "One model for all of them would be a mean of several actuators or states: identify each "
        "on its own and compare.",
        amounts={"share": share, "narrowest": min(widths), "widest": max(widths)},
    )


def _shapes(evidence: Evidence) -> list[Shape]:
    """Give the loops of the range and rate that most records share."""
    numbers = [number for number, _ in evidence.numbered()][:_MOST_RECORDS]
    if len(numbers) < 2:
        return []
    loops = {number: evidence.loops(number) for number in numbers}
    references = [
        max(each, key=lambda loop: loop.high - loop.low) for each in loops.values() if each
    ]
    best: list[Shape] = []
    for reference in references:
        shapes = []
        for number in numbers:
            alike = tuple(each for each in loops[number] if _comparable(each, reference))
            if alike:
                shapes.append(_shape(number, alike, evidence.noise(number)))
        if len(shapes) > len(best):
            best = shapes
        if len(best) == len(numbers):
            break
    return best


def _comparable(loop: Loop, other: Loop) -> bool:
    return loop.comparable(other) and 1.0 / _SAME_RATE < loop.rate / other.rate < _SAME_RATE


def _shape(number: int, loops: tuple[Loop, ...], noise: float | None) -> Shape:
    up, down = mean_loop(loops)
    cells = float(np.mean([each.samples for each in loops])) * len(loops)
    height = float(np.mean([each.height for each in loops]))
    return Shape(
        number,
        np.concatenate([up, down]),
        (noise or 0.0) / math.sqrt(max(cells, 1.0)),
        float(np.mean([each.gain for each in loops])),
        float(np.abs(down - up).max()) / height if height > 0.0 else 0.0,
        height,
    )


def _distances(shapes: list[Shape]) -> Array:
    """Root mean square differences between all pairs of curves."""
    curves = np.array([each.curve for each in shapes])
    return np.sqrt(np.mean((curves[:, None, :] - curves[None, :, :]) ** 2, axis=2))
