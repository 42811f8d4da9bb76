"""General hysteresis loops that turn where their input turns, at whole samples and between them.

Two cones of functions of the input, each of sums with weights that are not negative:

    what lags:  u, pieces of u, plays, plays of a piece of u,
    what leads: u, pieces of u, stops (u less a play), stops of a piece of u.

A piece is the input held between two levels; plays of pieces are the cells of a Preisach model. So
the first holds every Prandtl-Ishlinskii and, up to the width of its cells, every Preisach model of
weights that are not negative, and the second the loops of friction, which are steep after a turn
and flatten later. No member can go on rising after its input has turned, nor fall before it: this
is what a delay would have to do instead. Products of the input and a play, a constant and a slow
drift, of either sign, are common to both.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst import _engine

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

# Radii in units of half the input's range: fine where a play could be taken for a delay.
RADII = np.concatenate(
    [[0.005, 0.01, 0.015, 0.02, 0.03, 0.04, 0.05, 0.06], 0.02 * np.arange(4, 49)]
)
SMALL = 4
"""How many of them are so small that they stand in for a part of a sample of delay."""

_MIDDLE = 19
_PIECES = np.linspace(-1.0, 1.0, 9)
_CELL_RADII = (0.02, 0.06, 0.14, 0.22, 0.32, 0.44, 0.58, 0.75)
_CELL_WIDTH = 0.4
_AT_ONCE = 100_000
"""Samples whose plays are in memory together."""


def _cells() -> tuple[Array, Array, Array]:
    """Give radius, lowest and highest level of every play of a piece."""
    rows = []
    for r in _CELL_RADII:
        count = int(np.ceil((2.0 - 2.0 * r) / _CELL_WIDTH))
        width = (2.0 - 2.0 * r) / count
        rows += [(r, -1.0 + i * width, -1.0 + (i + 1) * width + 2.0 * r) for i in range(count)]
    r, low, high = np.array(rows).T
    return r, low, high


_CELL_R, _CELL_LOW, _CELL_HIGH = _cells()


@dataclass(frozen=True, eq=False)
class TurningLoops:
    """Loops of one record at some of its samples.

    Parameters
    ----------
    u
        Shape (N,), input between -1 and 1.
    rows
        Shape (m,), samples >= 1, ascending.
    before, at
        Shape (m, plays), plays and plays of pieces one sample before each row and at it.
    """

    u: Array
    rows: Indices
    before: tuple[Array, Array]
    at: tuple[Array, Array]

    @classmethod
    def of(cls, u: Array, rows: Indices) -> TurningLoops:
        """Run the memory through the whole input and keep it at the rows.

        Parameters
        ----------
        u
            Shape (N,), input between -1 and 1.
        rows
            Shape (m,), samples >= 1, ascending.
        """
        wanted = np.unique(np.concatenate([rows - 1, rows]))
        plays, cells = _memory(u, wanted)
        earlier, now = np.searchsorted(wanted, rows - 1), np.searchsorted(wanted, rows)
        return cls(u, rows, (plays[earlier], cells[earlier]), (plays[now], cells[now]))

    def cones(self, fraction: float) -> tuple[Array, Array, Array]:
        """Give both cones, and the products, a part of a sample before the rows.

        Parameters
        ----------
        fraction
            Of a sample, in [0, 1).

        Returns
        -------
        lagging, leading, products : numpy.ndarray
            Shape (m, columns); the first ``1 + len(RADII)`` of ``lagging`` are u and the plays.
        """
        u = between_samples(self.u, self.rows, fraction)[:, None]
        plays, cells = self.at
        held = np.clip(u, _CELL_LOW, _CELL_HIGH)
        if fraction > 0.0:
            # Between two samples the input does not turn, so one step of the play is exact.
            plays = np.clip(self.before[0], u - RADII, u + RADII)
            cells = np.clip(self.before[1], held - _CELL_R, held + _CELL_R)
        pieces = np.clip(u, _PIECES[:-1], _PIECES[1:])
        v = plays[:, _MIDDLE : _MIDDLE + 1]
        lagging = np.hstack([u, plays, pieces, cells])
        leading = np.hstack([u, u - plays, pieces, held - cells])
        return lagging, leading, np.hstack([v * u, v * v, v * v * v, v * u * u])


def between_samples(u: Array, rows: Indices, fraction: float) -> Array:
    """Give a signal a part of a sample before each row: a cubic, but a line beside a turn.

    Parameters
    ----------
    u
        Shape (N,).
    rows
        Shape (m,), samples >= 1.
    fraction
        Of a sample, in [0, 1).
    """
    if fraction == 0.0:
        return u[rows]
    a, b, c = u[np.maximum(rows - 2, 0)], u[rows - 1], u[rows]
    d = u[np.minimum(rows + 1, u.size - 1)]
    t = 1.0 - fraction
    bend = 2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)
    cubic = b + 0.5 * t * (c - a + t * bend)
    smooth = ((b - a) * (c - b) > 0.0) & ((d - c) * (c - b) > 0.0)
    inside = np.clip(cubic, np.minimum(b, c), np.maximum(b, c))
    return np.where(smooth, inside, b + t * (c - b))


def _memory(u: Array, wanted: Indices) -> tuple[Array, Array]:
    """Give plays, and plays of pieces, at the samples wanted."""
    plays = np.empty((wanted.size, RADII.size))
    cells = np.empty((wanted.size, _CELL_R.size))
    # Before the first sample nothing is known: as if the input had rested where it begins.
    z = np.full(RADII.size, u[0])
    own = [np.clip(u[:1], low, high) for low, high in zip(_CELL_LOW, _CELL_HIGH, strict=True)]
    for first in range(0, u.size, _AT_ONCE):
        part = np.ascontiguousarray(u[first : first + _AT_ONCE])
        inside = slice(*np.searchsorted(wanted, [first, first + part.size]))
        places = wanted[inside] - first
        bank = np.empty((part.size, RADII.size))
        _engine.play_outputs(RADII.tolist(), z, part, bank)
        plays[inside], z = bank[places], bank[-1].copy()
        single = np.empty((part.size, 1))
        for i, r in enumerate(_CELL_R):
            held = np.clip(part, _CELL_LOW[i], _CELL_HIGH[i])
            _engine.play_outputs([float(r)], own[i], held, single)
            cells[inside, i], own[i] = single[places, 0], single[-1].copy()
    return plays, cells
