"""How much of an error groups of columns explain, with its correlation in time counted."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import scipy.fft
import scipy.special
from numpy.typing import NDArray

Array = NDArray[np.float64]

SMALLEST_EIGENVALUE = 1e-9
"""Of the correlations of columns: below, a direction is told by others."""

WIDE = 60
"""Columns of a group, from which on what others have beyond it is found once for all choices."""

NOT_CORRELATED = 0.05

MOST_LAGS = 60
TELLING = 0.08
"""Largest autocorrelation of an error that is white but for a part of such a share."""


@dataclass(frozen=True, eq=False)
class Regression:
    """An error and groups of columns; any choice of groups is fitted from sums of products.

    Parameters
    ----------
    error
        Shape (n,).
    groups
        Shape (n, k) each, by name; all are centred.
    """

    error: Array
    groups: Mapping[str, Array]
    _known: dict[tuple[str, ...], tuple[Array, NDArray[np.intp], int]] = field(
        default_factory=dict, init=False, repr=False
    )
    _left: dict[str, tuple[Array, Array, int]] = field(default_factory=dict, init=False, repr=False)

    @functools.cached_property
    def _all(self) -> tuple[Array, Array, dict[str, NDArray[np.intp]]]:
        columns = np.column_stack([*self.groups.values(), self.error])
        columns = columns - columns.mean(axis=0)
        size = np.linalg.norm(columns, axis=0)
        columns = columns / np.where(size > 0.0, size, 1.0)
        places, first = {}, 0
        for name, each in self.groups.items():
            places[name] = np.arange(first, first + each.shape[1])
            first += each.shape[1]
        return columns, size, places

    @functools.cached_property
    def _products(self) -> Array:
        columns = self._all[0]
        return np.asarray(columns.T @ columns)

    def _chosen(self, names: Sequence[str]) -> NDArray[np.intp]:
        places = self._all[2]
        return np.concatenate([np.empty(0, dtype=np.intp), *(places[each] for each in names)])

    def _solved(self, names: Sequence[str]) -> tuple[Array, NDArray[np.intp], int]:
        """Give coefficients of scaled columns, which they are, and their number of directions."""
        key = tuple(names)
        if key not in self._known:
            self._known[key] = self._solve(names)
        return self._known[key]

    def _solve(self, names: Sequence[str]) -> tuple[Array, NDArray[np.intp], int]:
        at = self._chosen(names)
        if at.size == 0:
            return np.empty(0), at, 0
        first = self._all[2][names[0]]
        if first.size < WIDE:
            matrix, moment = self._products[np.ix_(at, at)], self._products[at, -1]
            found, directions = _least_squares(matrix, moment)
            return found, at, directions
        # The freedom of hundreds of cells is in every choice: what it leaves is found once.
        taken, products, directions = self._beyond(names[0])
        rest = at[first.size :]
        found, more = _least_squares(products[np.ix_(rest, rest)], products[rest, -1])
        own = taken[:, -1] - taken[:, rest] @ found
        return np.concatenate([own, found]), at, directions + more

    def _beyond(self, name: str) -> tuple[Array, Array, int]:
        """Give what one group makes of every column, the products of what is left, and its rank."""
        if name not in self._left:
            at = self._all[2][name]
            with_all = self._products[at]
            taken, directions = _least_squares(with_all[:, at], with_all)
            self._left[name] = taken, self._products - with_all.T @ taken, directions
        return self._left[name]

    @property
    def total(self) -> float:
        """Sum of squares of the centred error."""
        return float(self._all[1][-1] ** 2)

    def left(self, names: Sequence[str]) -> tuple[float, int]:
        """Give the share of the sum of squares that is left, and the number of directions taken."""
        coefficients, at, directions = self._solved(names)
        explained = float(coefficients @ self._products[at, -1]) if directions else 0.0
        return max(1.0 - explained, 0.0), directions

    def rms(self, names: Sequence[str]) -> float:
        """Give that of what is left."""
        return math.sqrt(self.left(names)[0] * self.total / self.error.size)

    def coefficients(self, names: Sequence[str], of: str) -> Array:
        """Give those of one group, in a fit of several.

        Parameters
        ----------
        names
            Of the groups that are fitted together.
        of
            The group.
        """
        solved, at, _ = self._solved(names)
        size = self._all[1]
        mine = np.isin(at, self._all[2][of])
        scale = size[at[mine]]
        return np.asarray(solved[mine] * size[-1] / np.where(scale > 0.0, scale, np.inf))

    def rest(self, names: Sequence[str]) -> Array:
        """Give what is left of the error, shape (n,)."""
        solved, at, _ = self._solved(names)
        columns, size, _ = self._all
        return np.asarray((columns[:, -1] - columns[:, at] @ solved) * size[-1])


def _least_squares(matrix: Array, moment: Array) -> tuple[Array, int]:
    """Give the least solution of normal equations in the directions known, and how many are."""
    if not len(matrix):
        return np.zeros_like(moment), 0
    values, vectors = np.linalg.eigh(matrix)
    known = values > SMALLEST_EIGENVALUE
    along = (vectors[:, known].T @ moment).T / values[known]
    return vectors[:, known] @ along.T, int(known.sum())


def correlation_time(error: Array) -> float:
    """Give the number of samples that count as one, at least 1, from an error's autocorrelation.

    Parameters
    ----------
    error
        Shape (n,).
    """
    n = error.size
    power = float(error @ error)
    if n < 8 or power == 0.0:
        return 1.0
    transform = np.abs(np.fft.rfft(error, scipy.fft.next_fast_len(2 * n, real=True))) ** 2
    correlation = np.fft.irfft(transform)[: max(n // 4, 2)]
    correlation = correlation / correlation[0]
    below = np.flatnonzero(correlation[1:] < NOT_CORRELATED)
    stop = int(below[0]) + 1 if below.size else correlation.size
    return float(max(1.0 + 2.0 * correlation[1:stop].sum(), 1.0))


def is_white(error: Array) -> bool:
    """Tell whether an error's samples tell nothing of those after them.

    Parameters
    ----------
    error
        Shape (n,), of samples one after the other.

    Notes
    -----
    The sum of squared autocorrelations, after Box and Pierce, J. Am. Stat. Assoc. 65 (1970),
    1509-1526; n times the sum is of n white samples as the sum of as many squared normal numbers.
    """
    n, power = error.size, float(error @ error)
    lags = min(MOST_LAGS, n // 4)
    if lags < 1 or power == 0.0:
        return True
    transform = np.abs(scipy.fft.rfft(error, scipy.fft.next_fast_len(n + lags, real=True))) ** 2
    correlation = np.asarray(scipy.fft.irfft(transform))[1 : lags + 1] / power
    by_noise = (lags + 5.0 * math.sqrt(2.0 * lags)) / n
    worth_telling = float(np.abs(correlation).max()) > TELLING
    return not worth_telling or float(correlation @ correlation) <= by_noise


def chance(before: float, after: float, directions: int, freedom: float) -> float:
    """Give the probability that noise alone lets so many directions explain so much.

    Parameters
    ----------
    before, after
        Sums of squares.
    directions
        That were added.
    freedom
        Independent samples left.
    """
    if directions <= 0 or before <= after:
        return 1.0
    if freedom <= 0.0:
        return 1.0
    if after <= 0.0:
        return 0.0
    ratio = (before - after) / directions / (after / freedom)
    share = directions * ratio / (directions * ratio + freedom)
    return float(scipy.special.betainc(freedom / 2.0, directions / 2.0, 1.0 - share))
