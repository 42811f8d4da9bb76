"""What a method of inversion hands over."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SOLVED = "solved"
CONVERGED = "converged"
ITERATION_LIMIT = "iteration limit"


@dataclass(frozen=True, eq=False)
class SolvedDrive:
    """A drive of the plays and how it was found.

    Parameters
    ----------
    drive
        Shape (N,), input units of the plays.
    status
        ``solved`` (in one pass), ``converged`` or ``iteration limit``.
    iterations
        Steps tried.
    notes
        What the user should know, in sentences.
    unpolished
        The drive before it was polished, shape (N,), or None if nothing was.
    roughness
        Which error a second difference of one input unit was worth to the polish.
    """

    drive: Array
    status: str
    iterations: int
    notes: tuple[str, ...]
    unpolished: Array | None = None
    roughness: float = 0.0
