"""What constants must fulfil so that an operator can be inverted, as linear inequalities."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.operators.parameters import Parameters

Array = NDArray[np.float64]

MARGIN, MOST = 1e-6, 1e3
"""Least and most slope, over the sum of the weights in size: beyond, an inverse has no digits."""


@final
@dataclass(frozen=True, eq=False)
class Inequalities:
    """``rows @ theta >= least``: sufficient near the constants they were made for.

    Parameters
    ----------
    rows
        Shape (k, m).
    least
        Shape (k,).
    """

    rows: Array
    least: Array


def of_bounds(parameters: Parameters) -> Inequalities:
    """Give the finite bounds of parameters; what is above 0 stays above a millionth of itself.

    Parameters
    ----------
    parameters
        With their bounds.

    Examples
    --------
    >>> one = Parameters(np.ones(1), ("a",), np.zeros(1), np.full(1, np.inf))
    >>> of_bounds(one).rows, of_bounds(one).least
    (array([[1.]]), array([1.e-06]))
    """
    unit = np.eye(len(parameters))
    below, above = np.isfinite(parameters.lower), np.isfinite(parameters.upper)
    least = np.maximum(parameters.lower, MARGIN * parameters.values)[below]
    least = np.where(parameters.lower[below] < 0.0, parameters.lower[below], least)
    return Inequalities(
        np.vstack([unit[below], -unit[above]]),
        np.concatenate([least, -parameters.upper[above]]),
    )


def of_plays(p0: float, p: Array) -> Inequalities:
    """Give thresholds that do not fall, from 0 or more, and cumulative weights within limits.

    Parameters
    ----------
    p0, p
        Present weights, which give the scale of the margin; the columns are those of p0, p and r.

    Examples
    --------
    >>> of_plays(1.0, np.array([0.5])).rows[:3]
    array([[0., 0., 1.],
           [1., 0., 0.],
           [1., 1., 0.]])
    """
    n = p.size
    steps, sums = np.eye(n) - np.eye(n, k=-1), np.tril(np.ones((n + 1, n + 1)))
    thresholds = np.hstack([np.zeros((n, n + 1)), steps])
    slopes = np.hstack([sums, np.zeros((n + 1, n))])
    return stacked(
        Inequalities(thresholds, np.zeros(n)),
        within(slopes, abs(p0) + float(np.abs(p).sum())),
    )


def within(slopes: Array, size: float) -> Inequalities:
    """Give slopes, rows of sums of weights, from a millionth to a thousand times a size.

    Parameters
    ----------
    slopes
        Shape (k, m).
    size
        The sum of the weights in size.
    """
    count = slopes.shape[0]
    return Inequalities(
        np.vstack([slopes, -slopes]), np.repeat([MARGIN * size, -MOST * size], count)
    )


def stacked(one: Inequalities, other: Inequalities) -> Inequalities:
    """Give both together, of the same parameters."""
    return Inequalities(np.vstack([one.rows, other.rows]), np.concatenate([one.least, other.least]))


def side_by_side(parts: list[Inequalities]) -> Inequalities:
    """Give the inequalities of operators whose parameters follow one after the other.

    Parameters
    ----------
    parts
        Of each.

    Examples
    --------
    >>> one = Inequalities(np.ones((1, 1)), np.zeros(1))
    >>> side_by_side([one, one]).rows
    array([[1., 0.],
           [0., 1.]])
    """
    width = sum(part.rows.shape[1] for part in parts)
    rows, first = [], 0
    for part in parts:
        count = part.rows.shape[1]
        wide = np.zeros((part.rows.shape[0], width))
        wide[:, first : first + count] = part.rows
        rows.append(wide)
        first += count
    return Inequalities(np.vstack(rows), np.concatenate([part.least for part in parts]))
