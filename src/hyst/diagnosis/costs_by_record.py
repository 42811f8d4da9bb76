"""Costs of a common delay where every record may have loops of its own, as at its own rate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.delay_costs import DelayCosts

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class CostsByRecord:
    """Residuals of the nearest general loops of each record, one after the other.

    Parameters
    ----------
    each
        The costs of each record, in parts of the same range.
    """

    each: tuple[DelayCosts, ...]

    @property
    def rows(self) -> int:
        """Samples compared."""
        return sum(one.rows for one in self.each)

    def left(self, delay: float, plain: bool = False) -> Array:
        """Give the residual for one delay, as ``DelayCosts.left``.

        Parameters
        ----------
        delay
            Samples of the first record.
        plain
            Whether of plays and a map after them.
        """
        return np.concatenate([one.left(delay, plain) for one in self.each])

    def cost(self, delay: float, plain: bool = False) -> float:
        """Give the sum of squares of the residual.

        Parameters
        ----------
        delay, plain
            As of ``left``.
        """
        return sum(one.cost(delay, plain) for one in self.each)
