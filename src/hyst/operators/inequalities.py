"""What constants must fulfil so that an operator can be inverted, as linear inequalities."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.operators.parameters import Parameters

Array = NDArray[np.float64]

MARGIN = 1e-6
"""Least slope, over the sum of the weights in size."""


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
    """Give the finite bounds of parameters.

    Parameters
    ----------
    parameters
        With their bounds.

    Examples
    --------
    >>> one = Parameters(np.ones(1), ("a",), np.zeros(1), np.full(1, np.inf))
    >>> of_bounds(one).rows, of_bounds(one).least
    (array([[1.]]), array([0.]))
    """
    unit = np.eye(len(parameters))
    below, above = np.isfinite(parameters.lower), np.isfinite(parameters.upper)
    return Inequalities(
        np.vstack([unit[below], -unit[above]]),
        np.concatenate([parameters.lower[below], -parameters.upper[above]]),
    )


def of_plays(p0: float, p: Array, further: int = 0) -> Inequalities:
    """Give thresholds that do not fall, from 0 or more, and cumulative weights above 0.

    Parameters
    ----------
    p0, p
        Present weights, which give the scale of the margin; the columns are those of p0, p and r.
    further
        Columns behind them, of constants that are free.

    Examples
    --------
    >>> of_plays(1.0, np.array([0.5])).rows
    array([[0., 0., 1.],
           [1., 0., 0.],
           [1., 1., 0.]])
    """
    n = p.size
    rows = np.zeros((2 * n + 1, 2 * n + 1 + further))
    steps = np.eye(n) - np.eye(n, k=-1)
    rows[:n, n + 1 : 2 * n + 1] = steps
    rows[n:, : n + 1] = np.tril(np.ones((n + 1, n + 1)))
    least = MARGIN * (abs(p0) + float(np.abs(p).sum()))
    return Inequalities(rows, np.concatenate([np.zeros(n), np.full(n + 1, least)]))


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
