"""The first way through a record in a file: what it holds, and which part shows most of it."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.record_use.used_samples import LARGEST_RADIUS
from hyst.signals import Record
from hyst.signals.record_stream import RecordStream

Array = NDArray[np.float64]

CHUNK = 2**16
"""Samples read at a time."""

PART = 2**19
"""Samples of the part on which everything but the constants is found."""

WHOLE_RANGE = 0.99
"""Of the input's range: the first part that covers as much is taken."""


@dataclass(frozen=True, eq=False)
class Survey:
    """What one way through a record found.

    Parameters
    ----------
    samples
        How many there are.
    u_low, u_high, y_low, y_high
        Ends of the ranges.
    y_spread
        Norm of the centred output.
    start
        First sample from which the memory is known, because the input has covered its range; 0 if
        that would leave less than half of the record.
    part
        Which samples show most of the range.
    part_covers
        Share of the input's range in it.
    """

    samples: int
    u_low: float
    u_high: float
    y_low: float
    y_high: float
    y_spread: float
    start: int
    part: slice
    part_covers: float


def survey(stream: RecordStream) -> Survey:
    """Go through a record once.

    Parameters
    ----------
    stream
        The record.

    Raises
    ------
    InputError
        If a sample is not finite, or the file holds another number of samples than it says.
    NotIdentifiableError
        If input or output is constant.
    """
    lows, highs, covered, firsts = list[float](), list[float](), list[float](), list[int]()
    total, low, high = _Moments(), math.inf, -math.inf
    y_low, y_high, place = math.inf, -math.inf, 0
    for u, y in chunks_of(stream):
        _require_finite(u, "input", place)
        _require_finite(y, "output", place)
        lows.append(float(u.min()))
        highs.append(float(u.max()))
        low, high = min(low, lows[-1]), max(high, highs[-1])
        y_low, y_high = min(y_low, float(y.min())), max(y_high, float(y.max()))
        covered.append(high - low)
        firsts.append(place)
        total.add(y)
        place += u.size
    for name, least, most in (("input", low, high), ("output", y_low, y_high)):
        if not most > least:
            raise NotIdentifiableError(f"the {name} is constant ({least:.6g}) over all samples")
    start = _first_settled(stream, covered, firsts, LARGEST_RADIUS * (high - low))
    first, share = _most_telling(np.array(lows), np.array(highs))
    begin = firsts[first]
    return Survey(
        place,
        low,
        high,
        y_low,
        y_high,
        math.sqrt(total.squares),
        start if 2 * start <= place else 0,
        slice(begin, min(begin + PART, place)),
        share,
    )


def chunks_of(stream: RecordStream) -> Iterator[tuple[Array, Array]]:
    """Go through a record, and see that all of it comes every time.

    Parameters
    ----------
    stream
        The record.

    Yields
    ------
    tuple of numpy.ndarray
        Input and output, shape (n,).

    Raises
    ------
    InputError
        If input and output of a chunk are not equally long, or it holds another number of samples
        than it says.
    """
    place = 0
    for u, y in stream.chunks(CHUNK):
        if u.shape != y.shape:
            raise InputError(
                f"from sample {place} on, {u.size} samples of the input were read and {y.size} of "
                "the output; give as many of both"
            )
        place += u.size
        if u.size:
            yield u, y
    if place != len(stream):
        raise InputError(f"the record says it has {len(stream)} samples, but {place} were read")


def part_of(stream: RecordStream, part: slice) -> Record:
    """Load some of the samples of a record in a file.

    Parameters
    ----------
    stream
        The record.
    part
        Which.

    Returns
    -------
    Record
    """
    us, ys, place = list[Array](), list[Array](), 0
    for u, y in chunks_of(stream):
        inside = slice(max(part.start - place, 0), max(part.stop - place, 0))
        us.append(u[inside].copy())
        ys.append(y[inside].copy())
        place += u.size
        if place >= part.stop:
            break
    return Record(
        np.concatenate(us),
        np.concatenate(ys),
        stream.dt,
        getattr(stream, "input_name", "u"),
        getattr(stream, "output_name", "y"),
        stream.u_unit,
        stream.y_unit,
    )


def data_hash(stream: RecordStream) -> str:
    """Give the SHA-256 of a record, as ``operators.provenance.data_hash`` does of one in memory.

    Parameters
    ----------
    stream
        The record.
    """
    total = hashlib.sha256()
    for signal in (0, 1):
        for chunk in chunks_of(stream):
            total.update(np.ascontiguousarray(chunk[signal], dtype="<f8").tobytes())
    total.update(np.ascontiguousarray(stream.dt, dtype="<f8").tobytes())
    return total.hexdigest()


def _require_finite(signal: Array, name: str, place: int) -> None:
    bad = np.flatnonzero(~np.isfinite(signal))
    if bad.size:
        raise InputError(
            f"sample {place + int(bad[0])} of the {name} is {signal[bad[0]]}; leave it out, or cut "
            "the record there"
        )


def _first_settled(
    stream: RecordStream, covered: list[float], firsts: list[int], span: float
) -> int:
    """Give the first sample at which the input has covered a span."""
    chunk = next((i for i, each in enumerate(covered) if each >= span), len(covered) - 1)
    low, high = math.inf, -math.inf
    for number, (u, _) in enumerate(chunks_of(stream)):
        if number == chunk:
            ups = np.maximum(np.maximum.accumulate(u), high)
            downs = np.minimum(np.minimum.accumulate(u), low)
            return firsts[chunk] + int(np.argmax(ups - downs >= span))
        low, high = min(low, float(u.min())), max(high, float(u.max()))
    return 0


def _most_telling(lows: Array, highs: Array) -> tuple[int, float]:
    """Give the chunk at which the part begins that shows most of the range, and what share."""
    width = min(PART // CHUNK, lows.size)
    parts = [slice(i, i + width) for i in range(lows.size - width + 1)]
    ranges = np.array([highs[each].max() - lows[each].min() for each in parts])
    shares = ranges / (highs.max() - lows.min())
    enough = np.flatnonzero(shares >= WHOLE_RANGE)
    best = int(enough[0]) if enough.size else int(shares.argmax())
    return best, float(shares[best])


class _Moments:
    """Mean and sum of squares about it, chunk by chunk.

    Chan, Golub and LeVeque, Updating formulae and a pairwise algorithm for computing sample
    variances, COMPSTAT 1982.
    """

    def __init__(self) -> None:
        self._count, self._mean, self.squares = 0, 0.0, 0.0

    def add(self, values: Array) -> None:
        """Count more values."""
        mean = float(values.mean())
        both, apart = self._count + values.size, mean - self._mean
        self.squares += float(np.sum(np.square(values - mean)))
        self.squares += apart**2 * self._count * values.size / both
        self._mean += apart * values.size / both
        self._count = both
