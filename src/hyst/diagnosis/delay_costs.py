"""What general loops leave of the outputs of records, for any delay common to all of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.isolated_outliers import bridged, isolated_outliers
from hyst.diagnosis.nearest_in_cone import Cone
from hyst.diagnosis.turning_loops import RADII, SMALL, TurningLoops
from hyst.signals import Record

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Indices = NDArray[np.intp]

MOST_ROWS = 2000
"""Of all records together; the memory runs through every sample all the same."""

_GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0
_LONGEST_BRIDGE = 3
_MOST_BENDS = 6
"""Of the drift of a record."""

_BENDS = 15
"""Of a map after the plays."""

_ROUNDS, _PIECES_OF_A_MAP = 4, 40
"""By which plays and the map after them are found in turn."""

_FINEST = 1 / 64
"""Samples: fractions are rounded to it, so that records of different rates share work."""


@dataclass(frozen=True, eq=False)
class _Part:
    """One record: its loops, its output at all samples, and samples a sample of the first is."""

    loops: TurningLoops
    y: Array
    ratio: float
    turns: int

    def split(self, delay: float) -> tuple[int, float]:
        """Give a delay of the first record's samples as whole ones of this one and a part."""
        own = round(delay * self.ratio / _FINEST) * _FINEST
        whole = math.floor(own)
        return whole, own - whole

    def drifts(self) -> Array:
        """Give a constant and a slow bent line: hats over stretches of some turns."""
        bends = max(1, min(_MOST_BENDS, self.turns // 8))
        place = np.linspace(0.0, bends, self.loops.rows.size)
        return np.maximum(1.0 - np.abs(place[:, None] - np.arange(bends + 1)), 0.0)


@dataclass(frozen=True, eq=False)
class _Cones:
    """Both cones, and that of plays alone, for one set of parts of a sample."""

    lagging: Cone
    leading: Cone
    plain: Cone


@dataclass(frozen=True, eq=False)
class DelayCosts:
    """Residuals of the nearest general loops by delay, in parts of the range of all outputs.

    Parameters
    ----------
    parts
        The records.
    sign
        1, or -1 where the output falls as its input rises.
    longest
        Delay either way, samples of the first record.
    bends
        Whether a map after plays is among the loops.
    """

    parts: tuple[_Part, ...]
    sign: float
    longest: float
    bends: bool
    _shape: list[tuple[Array, Array]] = field(default_factory=list, repr=False)
    _cones: dict[tuple[float, ...], _Cones] = field(default_factory=dict, repr=False)
    _left: dict[tuple[float, bool], Array] = field(default_factory=dict, repr=False)

    @classmethod
    def of(
        cls,
        records: Sequence[Record],
        outputs: Sequence[Array],
        starts: Sequence[int],
        kept: Sequence[Flags | None],
        longest: float,
        turns: Sequence[int],
        bends: bool,
        dt: float,
        y_range: float,
    ) -> DelayCosts:
        """Bring records to one scale and choose their rows.

        Parameters
        ----------
        records, starts, kept
            As ``evidence_of_delay``.
        outputs
            Of the records, cleaned.
        longest
            Delay either way that will be asked for, samples of the first record.
        turns
            Of the input of each record.
        bends
            Whether a map after plays is wanted: on strokes of one amplitude every rising branch
            is within the cones, and bends would only hide a delay.
        dt
            Sample time in which delays are counted, s.
        y_range
            Of all outputs, by which costs are measured.
        """
        u_low = min(float(each.u.min()) for each in records)
        half = max((max(float(each.u.max()) for each in records) - u_low) / 2.0, 1e-300)
        share = MOST_ROWS / sum(max(len(r) - s, 1) for r, s in zip(records, starts, strict=True))
        parts = []
        for i, record in enumerate(records):
            ratio = dt / record.dt
            rows = _rows(record, starts[i], kept[i], math.ceil(longest * ratio) + 1, share)
            u = (record.u - u_low) / half - 1.0
            loops = TurningLoops.of(u, rows)
            parts.append(_Part(loops, outputs[i] / y_range, ratio, turns[i]))
        slope = sum(_inner(part) for part in parts)
        return cls(tuple(parts), -1.0 if slope < 0.0 else 1.0, longest, bends)

    @property
    def rows(self) -> int:
        """Samples compared."""
        return sum(part.loops.rows.size for part in self.parts)

    def left(self, delay: float, plain: bool = False) -> Array:
        """Give the residual for one delay.

        Parameters
        ----------
        delay
            Samples of the first record.
        plain
            Whether of plays alone, and a map after them, instead of the better one of both cones.
        """
        key = (delay, plain)
        if key not in self._left:
            fractions, y = self._shifted(delay)
            cones = self._cones_at(fractions)
            tried = (cones.plain,) if plain else (cones.lagging, cones.leading)
            self._left[key] = min((cone.left(y) for cone in tried), key=lambda e: float(e @ e))
        return self._left[key]

    def cost(self, delay: float, plain: bool = False) -> float:
        """Give the sum of squares of the residual.

        Parameters
        ----------
        delay, plain
            As of ``left``.
        """
        e = self.left(delay, plain)
        return float(e @ e)

    def _shifted(self, delay: float) -> tuple[tuple[float, ...], Array]:
        """Give the parts of a sample of a delay, and the outputs its whole samples later."""
        splits = [part.split(delay) for part in self.parts]
        outputs = [
            part.y[part.loops.rows + whole]
            for part, (whole, _) in zip(self.parts, splits, strict=True)
        ]
        return tuple(fraction for _, fraction in splits), self.sign * np.concatenate(outputs)

    def _columns(self, fractions: tuple[float, ...]) -> tuple[Array, Array, Array]:
        found = [part.loops.cones(f) for part, f in zip(self.parts, fractions, strict=True)]
        lagging, leading, products = (np.concatenate(each) for each in zip(*found, strict=True))
        return lagging, leading, products

    def _drifts(self) -> Array:
        return _block_diagonal([part.drifts() for part in self.parts])

    def _cones_at(self, fractions: tuple[float, ...]) -> _Cones:
        if fractions not in self._cones:
            lagging, leading, products = self._columns(fractions)
            slow = [self._drifts(), *([self._bent(lagging)] if self.bends else [])]
            free = np.linalg.qr(np.hstack([*slow, products]))[0]
            plain = Cone.of(_plays(lagging), np.linalg.qr(np.hstack(slow))[0])
            self._cones[fractions] = _Cones(Cone.of(lagging, free), Cone.of(leading, free), plain)
        return self._cones[fractions]

    def _bent(self, lagging: Array) -> Array:
        """Give bends of the plays' best output: what a map after the plays would do to it."""
        if not self._shape:
            still = self._columns((0.0,) * len(self.parts))[0]
            plain = Cone.of(_plays(still), np.linalg.qr(self._drifts())[0])
            delays = np.unique(np.round(np.linspace(-self.longest, self.longest, 17)))
            outputs = [self._shifted(float(d))[1] for d in delays]
            costs = [float(e @ e) for e in map(plain.left, outputs)]
            y = outputs[int(np.argmin(costs))]
            weights = plain.weights(y)
            for _ in range(_ROUNDS):
                weights = plain.weights(_unbent(y, _plays(still) @ weights))
            v = _plays(still) @ weights
            knots = v.min() + np.ptp(v) * np.arange(1, _BENDS + 1) / (_BENDS + 1)
            self._shape.append((weights, knots))
        weights, knots = self._shape[0]
        return np.maximum((_plays(lagging) @ weights)[:, None] - knots, 0.0)


def _plays(lagging: Array) -> Array:
    """Give the input and plays, without those that stand in for a part of a sample of delay."""
    return np.hstack([lagging[:, :1], lagging[:, 1 + SMALL : 1 + RADII.size]])


def _unbent(y: Array, v: Array) -> Array:
    """Undo the rising map from v to y that means over pieces of v tell."""
    order = np.argsort(v, kind="stable")
    pieces = [each for each in np.array_split(order, _PIECES_OF_A_MAP) if each.size]
    middle = np.array([v[each].mean() for each in pieces])
    height = np.maximum.accumulate([y[each].mean() for each in pieces])
    rising = np.concatenate([[True], np.diff(height) > 1e-3 * max(float(np.ptp(height)), 1e-300)])
    middle, height = middle[rising], height[rising]
    if middle.size < 2:
        return y
    slope = np.diff(middle) / np.diff(height)
    inside = np.interp(y, height, middle)
    below, above = np.minimum(y - height[0], 0.0), np.maximum(y - height[-1], 0.0)
    return np.asarray(inside + slope[0] * below + slope[-1] * above)


def clean_output(record: Record, kept: Flags | None) -> Array:
    """Give an output with what is not kept, and what stands out alone, bridged.

    Parameters
    ----------
    record
        The record.
    kept
        Shape (N,), or None for all.
    """
    y = record.y if kept is None else bridged(record.y, kept)
    return bridged(y, ~isolated_outliers(y))


def span_of(outputs: Sequence[Array]) -> float:
    """Give the range of all outputs together.

    Parameters
    ----------
    outputs
        Of each record.
    """
    low, high = (min(float(y.min()) for y in outputs), max(float(y.max()) for y in outputs))
    return max(high - low, 1e-300)


def _inner(part: _Part) -> float:
    u, y = part.loops.u[part.loops.rows], part.y[part.loops.rows]
    return float((u - u.mean()) @ y)


def _rows(record: Record, start: int, kept: Flags | None, longest: int, share: float) -> Indices:
    """Choose samples evenly, though at no whole step, that no delay brings to a long gap."""
    first, stop = max(start, longest, 1), len(record) - longest
    count = min(stop - first, max(8, int(share * (len(record) - start))))
    places = first + np.arange(count) * ((stop - first) / count)
    if count < stop - first:  # at a whole step the same phases of every period would be seen
        places = places + np.mod(np.arange(count) * _GOLDEN, 1.0)
    rows = np.unique(np.minimum(places.astype(np.intp), stop - 1))
    if kept is None or kept.all():
        return rows
    clear = _clear_of_gaps(kept, longest)
    return rows[clear[rows]] if clear[rows].sum() >= rows.size / 2 else rows


def _clear_of_gaps(kept: Flags, longest: int) -> Flags:
    """Mark samples with no gap too long for a bridge within the longest delay."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], ~kept, [0]]).astype(np.int8)))
    clear = np.ones(kept.size, dtype=bool)
    for begin, end in zip(edges[::2], edges[1::2], strict=True):
        if end - begin > _LONGEST_BRIDGE:
            clear[max(begin - longest, 0) : end + longest] = False
    return clear


def _block_diagonal(blocks: Sequence[Array]) -> Array:
    rows, columns = sum(len(b) for b in blocks), sum(b.shape[1] for b in blocks)
    result = np.zeros((rows, columns))
    row = column = 0
    for block in blocks:
        result[row : row + len(block), column : column + block.shape[1]] = block
        row, column = row + len(block), column + block.shape[1]
    return result
