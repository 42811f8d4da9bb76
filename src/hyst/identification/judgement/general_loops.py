"""Loops of a general kind, linear in their weights: plays, and plays of bent inputs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.identification.judgement.drive_cycles import last_turns
from hyst.identification.judgement.remainder import Part, Remainder

Array = NDArray[np.float64]

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
        last, before = last_turns(part)
        loops = loops_of_part(remainder, part)
        return np.column_stack([loops, last, before, np.abs(last - before)])

    return remainder.columns(of_part)


def loops_of_part(remainder: Remainder, part: Part) -> Array:
    """Give plays and plays of bent inputs over all samples of one part, shape (n, 22).

    Parameters
    ----------
    remainder
        What a fit leaves.
    part
        One of its parts.
    """
    return remainder.once(("loops", part.number), lambda: _loops_of_part(remainder, part))


def _loops_of_part(remainder: Remainder, part: Part) -> Array:
    low, high = float(remainder.u.min()), float(remainder.u.max())
    middle, half = (low + high) / 2.0, (high - low) / 2.0
    columns = [part.u[:, None], play_outputs(part, part.whole, half * np.array(RADII))]
    for knot in KNOTS:
        bent = np.maximum(part.whole - (middle + knot * half), 0.0)
        radii = (1.0 - knot) * half / 2.0 * np.array(RADII_OF_BENT)
        columns += [bent[part.places, None], play_outputs(part, bent, radii)]
    return np.column_stack(columns)


def play_outputs(part: Part, drive: Array, r: Array) -> Array:
    """Give outputs of plays over the samples used of a part, from a drive over all of them.

    Parameters
    ----------
    part
        The part.
    drive
        Shape (k + n,), one number for each of its samples and of those before them.
    r
        Shape (m,), radii.

    Returns
    -------
    numpy.ndarray
        Shape (n, m).
    """
    z = np.empty((drive.size, r.size))
    _engine.play_outputs(r.tolist(), np.zeros(r.size), drive, z)
    return z[part.places]
