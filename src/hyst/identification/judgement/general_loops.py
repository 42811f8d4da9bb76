"""Loops of a general kind, linear in their weights: plays, and plays of bent inputs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.identification.judgement.drive_cycles import last_turns
from hyst.identification.judgement.remainder import Part, Remainder

Array = NDArray[np.float64]
Rows = NDArray[np.intp]

BLOCK = 2**15
"""Samples: plays over all of a long record would take more memory than the record."""

RADII = (0.02, 0.05, 0.1, 0.17, 0.25, 0.35, 0.5, 0.65, 0.8)
"""Of half the input's range."""

KNOTS = (-0.5, 0.0, 0.5)
"""Of half the input's range, from its middle: where inputs bend."""

RADII_OF_BENT = (0.1, 0.3, 0.6)
"""Of half the bent input's range."""


def general_loops(remainder: Remainder) -> Array:
    """Give the columns of a model that comes near to any loop, shape (rows, 25).

    Beside plays they hold where the input turned last, and before: the loops of some materials do
    not close but move with the amplitude.
    """

    def of_part(part: Part) -> Array:
        last, before = (each[part.rows] for each in last_turns(part))
        loops = loops_of_part(remainder, part)
        return np.column_stack([loops, last, before, np.abs(last - before)])

    return remainder.columns(of_part)


def loops_of_part(remainder: Remainder, part: Part) -> Array:
    """Give plays and plays of bent inputs over the rows of one part, shape (rows, 22).

    Parameters
    ----------
    remainder
        What a fit leaves.
    part
        One of its parts.
    """
    return remainder.once(("loops", part.number), lambda: loops_at(remainder, part, part.rows))


def loops_at(remainder: Remainder, part: Part, rows: Rows) -> Array:
    """Give plays and plays of bent inputs over some samples of one part, shape (rows, 22).

    Parameters
    ----------
    remainder
        What a fit leaves.
    part
        One of its parts.
    rows
        Which of its samples, ascending.
    """
    low, high = float(remainder.u.min()), float(remainder.u.max())
    middle, half = (low + high) / 2.0, (high - low) / 2.0
    places = part.places[rows]
    columns = [part.u[rows, None], play_outputs(part.whole, half * np.array(RADII), places)]
    for knot in KNOTS:
        bent = np.maximum(part.whole - (middle + knot * half), 0.0)
        radii = (1.0 - knot) * half / 2.0 * np.array(RADII_OF_BENT)
        columns += [bent[places, None], play_outputs(bent, radii, places)]
    return np.column_stack(columns)


def play_outputs(drive: Array, r: Array, places: Rows) -> Array:
    """Give outputs of plays at some samples, from a drive over all samples before them.

    Parameters
    ----------
    drive
        Shape (k,).
    r
        Shape (m,), radii.
    places
        Shape (n,), which samples, ascending.

    Returns
    -------
    numpy.ndarray
        Shape (n, m).
    """
    memory, result = np.zeros(r.size), np.empty((places.size, r.size))
    stop = int(places[-1]) + 1 if places.size else 0
    for first in range(0, stop, BLOCK):
        block = np.ascontiguousarray(drive[first : min(first + BLOCK, stop)])
        z = np.empty((block.size, r.size))
        _engine.play_outputs(r.tolist(), memory, block, z)
        here = slice(*np.searchsorted(places, [first, first + block.size]))
        result[here] = z[places[here] - first]
    return result
