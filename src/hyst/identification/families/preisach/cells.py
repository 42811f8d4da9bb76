"""Cells of the half plane of relays, in the order of the model's weights: row by row."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Cells:
    """The cells that thresholds cut the half plane alpha >= beta into.

    Cell (i, j), j <= i, holds relays with alpha between thresholds i and i + 1 and beta between
    thresholds j and j + 1; on the diagonal it is a triangle.

    Parameters
    ----------
    thresholds
        Shape (n + 1,), ascending, input units.
    """

    thresholds: Array

    @property
    def levels(self) -> int:
        """Number of cells along a side, n."""
        return int(self.thresholds.size - 1)

    @property
    def count(self) -> int:
        """Number of cells, n (n + 1) / 2."""
        return self.levels * (self.levels + 1) // 2

    @property
    def places(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Row and column of every cell."""
        return np.tril_indices(self.levels)

    def areas(self) -> Array:
        """Give the area of every cell, over the square of the range."""
        rows, columns = self.places
        sides = np.diff(self.thresholds) / (self.thresholds[-1] - self.thresholds[0])
        return np.asarray(np.where(rows == columns, 0.5, 1.0) * sides[rows] * sides[columns])

    def centres(self) -> tuple[Array, Array]:
        """Give alpha and beta in the middle of the mass of every cell, input units."""
        rows, columns = self.places
        low, side = self.thresholds[:-1], np.diff(self.thresholds)
        of_alpha = np.where(rows == columns, 2.0 / 3.0, 0.5)
        return low[rows] + of_alpha * side[rows], low[columns] + (1.0 - of_alpha) * side[columns]

    def density(self, weights: Array) -> Array:
        """Give the mass per area of the half plane, shape (n, n), NaN above the diagonal.

        Parameters
        ----------
        weights
            Shape (cells,).
        """
        result = np.full((self.levels, self.levels), np.nan)
        extent = self.thresholds[-1] - self.thresholds[0]
        result[self.places] = weights / (self.areas() * extent**2)
        return result

    def differences(self) -> Array:
        """Give the slopes of the density between neighbours, shape (pairs, cells).

        Applied to weights, the sum of their squares is the integral of the squared gradient of the
        density over the half plane, where a density of 1 everywhere has a mass of 1, and both
        thresholds run from 0 to 1: it does not depend on how fine the grid is.
        """
        sides = np.diff(self.thresholds) / (self.thresholds[-1] - self.thresholds[0])
        number = np.full((self.levels, self.levels), -1)
        number[self.places] = np.arange(self.count)
        per_mass = 0.5 / self.areas()
        along = [(number[:-1, :], number[1:, :], 0), (number[:, :-1], number[:, 1:], 1)]
        rows = []
        for first, second, axis in along:
            i, j = np.nonzero((first >= 0) & (second >= 0))
            at = i if axis == 0 else j
            across = sides[j if axis == 0 else i]
            weight = np.sqrt(across / (0.5 * (sides[at] + sides[at + 1])))
            part = np.zeros((i.size, self.count))
            pair = np.arange(i.size)
            part[pair, first[i, j]] = -weight * per_mass[first[i, j]]
            part[pair, second[i, j]] = weight * per_mass[second[i, j]]
            rows.append(part)
        return np.concatenate(rows)


def even_cells(low: float, high: float, levels: int) -> Cells:
    """Give the cells of thresholds that are evenly spaced.

    Parameters
    ----------
    low, high
        Ends, input units.
    levels
        Number of cells along a side.
    """
    return Cells(low + (high - low) * (np.arange(levels + 1) / levels))


EVEN_SHARE = 0.5
"""Of the levels that are spread evenly where the others follow the mass."""


def adapted_cells(cells: Cells, weights: Array, levels: int) -> Cells:
    """Give cells that are narrower where relays switch: half even, half by their mass.

    Parameters
    ----------
    cells
        A grid.
    weights
        Shape (cells,), found on it.
    levels
        Number of the new cells along a side.
    """
    rows, columns = cells.places
    mass = np.bincount(rows, weights, cells.levels) + np.bincount(columns, weights, cells.levels)
    sides = np.diff(cells.thresholds) / (cells.thresholds[-1] - cells.thresholds[0])
    total = float(mass.sum())
    shares = EVEN_SHARE * sides + (1.0 - EVEN_SHARE) * (mass / total if total > 0.0 else sides)
    up_to = np.concatenate([[0.0], np.cumsum(shares)]) / float(shares.sum())
    wanted = np.arange(1, levels) / levels
    inner = np.interp(wanted, up_to, cells.thresholds)
    return Cells(np.concatenate([cells.thresholds[:1], inner, cells.thresholds[-1:]]))
