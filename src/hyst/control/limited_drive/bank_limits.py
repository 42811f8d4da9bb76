"""What is known beforehand of a bank of plays at the ends of its drive.

Invariant: it agrees with any memory; what holds for most of them only is tried by the core, and
saves it time where it does.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# The core compares radii with rounded sums: what is less than this share of the largest is none.
_NARROWEST = 1e-5
# By how much the ends of what leaves the drive within are set too near: more than rounding.
_SPARE = 1e-3
# Of how many roundings the end of a bank is made, at most: four a play.
_ROUNDING = 64.0


@final
@dataclass(frozen=True)
class BankEnd:
    """An end of the drive; see ``hyst_bank_end`` of the core.

    Parameters
    ----------
    moved
        Plays that move on the way there from the memory at start, narrowest first.
    slope, constant
        Of the bank behind them.
    start
        The end can be met by inputs beyond this one only.
    least
        Radius of the widest of the plays that move, less what rounding may take from it.
    """

    moved: int
    slope: float
    constant: float
    start: float
    least: float

    @property
    def numbers(self) -> tuple[float, float, float, float]:
        """Slope, constant, start and least."""
        return self.slope, self.constant, self.start, self.least


@final
@dataclass(frozen=True)
class Bank:
    """A bank of plays, the last stage of an inverse, as the core has it.

    Parameters
    ----------
    p0, p, r
        Weight of the input, weights and radii of the plays, rounded to the numbers of the target.
    z
        Memory at start.
    epsilon
        Of those numbers.
    """

    p0: float
    p: Array
    r: Array
    z: Array
    epsilon: float

    def rises(self) -> bool:
        """Tell whether the output rises however many plays move, narrowest first."""
        slopes = self.p0 + np.concatenate([[0.0], np.cumsum(self.p)])
        r = self.r
        tiny = r.size > 0 and 0.0 < r[0] < _NARROWEST * r[-1]
        return bool((slopes > 0.0).all() and (np.diff(r) >= 0.0).all() and not tiny)

    def end(self, drive: float, side: int) -> BankEnd:
        """Give what is known of an end.

        Parameters
        ----------
        drive
            Lowest or highest output.
        side
            1 for the highest, -1 for the lowest.
        """
        p, r, z = self.p, self.r, self.z
        moved = 0
        while moved < r.size and side * (self._solved(drive, side, moved) - z[moved]) > r[moved]:
            moved += 1
        constant = -side * float(p[:moved] @ r[:moved])
        # Plays are no farther from v than their radii: u is at most s v + sum |p| r.
        width = (1.0 + _SPARE) * float(np.abs(p) @ r) + _SPARE * abs(drive)
        start = (drive - side * width) / (self.p0 + float(p.sum()))
        lost = _ROUNDING * self.epsilon * (abs(self._solved(drive, side, moved)) + float(r.sum()))
        least = float(r[moved - 1]) - lost if moved else 0.0
        return BankEnd(moved, self.p0 + float(p[:moved].sum()), constant, start, least)

    def _solved(self, drive: float, side: int, moved: int) -> float:
        p, r, z = self.p, self.r, self.z
        rest = -side * float(p[:moved] @ r[:moved]) + float(p[moved:] @ z[moved:])
        return (drive - rest) / (self.p0 + float(p[:moved].sum()))


def bank_of(stages: list[dict[str, Any]], memory: Array, dtype: Any = np.float64) -> Bank | None:
    """Give the bank of plays that is the last stage of an inverse, if it needs no model beside it.

    Parameters
    ----------
    stages
        What the engine tells of the inverse's stages.
    memory
        Of the inverse, at start.
    dtype
        Numbers of the target.

    Returns
    -------
    Bank or None
        None where the last stage is no bank that rises, or another one has a memory.
    """
    if not stages or stages[-1]["call"] != "$signal = hyst_pi_step(&$model, $memory, $signal);":
        return None
    if any(each["state_length"] for each in stages[:-1]):
        return None
    tables = stages[-1]["tables"]
    p, r, z = (
        np.asarray(each, dtype).astype(np.float64) for each in (tables["p"], tables["r"], memory)
    )
    p0 = float(dtype(stages[-1]["numbers"]["p0"]))
    bank = Bank(p0, p, r, z, float(np.finfo(dtype).eps))
    return bank if bank.rises() else None
