"""Samples folded into rows of the same input with the same memory."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.errors import InputError

Array = NDArray[np.float64]

_MOMENTS = 5
_ENOUGH_TO_TELL_NOISE = 50.0


@dataclass(frozen=True, eq=False)
class FoldedSamples:
    """Rows of samples that every model of plays answers alike.

    Parameters
    ----------
    count, y
        Shape (R,), how many samples a row has, and the mean of their outputs.
    way
        Shape (T, R), the turns of the input that plays may remember, from the outermost on, and
        at the end the input itself.
    noise
        Variance of the output within rows, where what its input explains is left out; NaN where
        rows have too few samples each.
    freedom
        Degrees of freedom of ``noise``.
    """

    count: Array
    y: Array
    way: Array
    noise: float
    freedom: float

    @property
    def swing(self) -> float:
        """Range of the input."""
        return float(np.ptp(self.way)) if self.way.size else 0.0


def folded_samples(rows: Sequence[Sequence[float]]) -> FoldedSamples:
    """Read the rows of the engine.

    Parameters
    ----------
    rows
        Count, mean output, squares and products about the means (input, both, output), turns and
        input; turns may be of different number.

    Returns
    -------
    FoldedSamples

    Examples
    --------
    >>> folded_samples([[2.0, 1.0, 0.0, 0.0, 0.5, 3.0, 4.0]]).way[:, 0]
    array([3., 4.])
    """
    length = max((len(each) - _MOMENTS for each in rows), default=1)
    table = np.empty((len(rows), _MOMENTS + length))
    for k, each in enumerate(rows):
        # A turn that is passed twice leaves the same memory.
        pad = [each[_MOMENTS]] * (length + _MOMENTS - len(each))
        table[k] = [*each[:_MOMENTS], *pad, *each[_MOMENTS:]]
    table = table[np.lexsort(table.T)] if table.size else table
    count, y, uu, uy, yy = table[:, :_MOMENTS].T
    explained = np.divide(uy**2, uu, out=np.zeros_like(uy), where=uu > 0.0)
    freedom = float(np.maximum(count - 1.0 - (uu > 0.0), 0.0).sum())
    square = float(np.maximum(yy - explained, 0.0)[count - 1.0 > (uu > 0.0)].sum())
    noise = square / freedom if freedom >= _ENOUGH_TO_TELL_NOISE else float("nan")
    return FoldedSamples(count, y, np.ascontiguousarray(table[:, _MOMENTS:].T), noise, freedom)


def folded_in(core: _engine.JointEstimation) -> dict[str, Any]:
    """Give what an engine has folded, as a file keeps it."""
    return {"place": core.folding(), "rows": core.folded(0), "before": core.folded(1)}


def fold_again(core: _engine.JointEstimation, kept: dict[str, Any]) -> None:
    """Hand an engine what ``folded_in`` gave.

    Parameters
    ----------
    core
        The engine.
    kept
        From a file.

    Raises
    ------
    InputError
        If it is nothing that an engine gives.
    """
    try:
        numbers = [kept["place"], *kept["rows"], *kept["before"]]
        if not all(np.isfinite(np.asarray(each, dtype=np.float64)).all() for each in numbers):
            raise ValueError
        if any(not each[0] > 0.0 for each in numbers[1:]):
            raise ValueError
        core.fold_again(kept["place"], kept["rows"], kept["before"])
    except (KeyError, TypeError, ValueError, IndexError):
        raise InputError(
            "the saved samples of the estimator are no rows of counts, outputs and turns; save it "
            "again"
        ) from None
