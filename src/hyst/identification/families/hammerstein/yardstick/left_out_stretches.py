"""What regressions leave of stretches of the records they were not fitted to."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_FOLDS = 8
_STRETCHES = 5  # of each fold in each record: every part of a chirp is in every fold
_STANDARD_ERRORS = 2.0  # by which a gain is counted less: noise explains stretches by chance
_RIDGES = (1e-10, 1e-7, 1e-5, 1e-3)  # of a column's square: some move in few stretches only


@dataclass(frozen=True, eq=False)
class LeftOutStretches:
    """Regressions on groups of columns, each held to stretches its coefficients do not know.

    Parameters
    ----------
    places
        By group, which columns of the tables are of it.
    tables
        Of each record, shape (n, k): all columns about their means, of norm 1, and a constant.
    target
        Of each record, shape (n,): what is regressed.
    grams
        Shape (folds, k + 1, k + 1), inner products over the stretches of each fold, target last.
    """

    places: Mapping[str, slice]
    tables: Sequence[Array]
    target: Sequence[Array]
    grams: Array

    @classmethod
    def of(
        cls, columns: Sequence[Mapping[str, Array]], target: Sequence[Array]
    ) -> LeftOutStretches:
        """Put records and columns together.

        Parameters
        ----------
        columns
            Of each record, by group, shapes (n, k).
        target
            Of each record, shape (n,).
        """
        places, first = {}, 0
        for name, block in columns[0].items():
            places[name] = slice(first, first + block.shape[1])
            first += block.shape[1]
        joined = [np.column_stack(list(each.values())) for each in columns]
        joined = [each - each.mean(axis=0) for each in joined]
        size = np.sqrt(sum(np.square(each).sum(axis=0) for each in joined))
        size[size == 0.0] = 1.0
        tables = [np.column_stack([each / size, np.ones(len(each))]) for each in joined]
        grams = np.zeros((_FOLDS, first + 2, first + 2))
        for table, signal in zip(tables, target, strict=True):
            whole = np.column_stack([table, signal])
            edges = np.linspace(0, signal.size, _FOLDS * _STRETCHES + 1).astype(np.intp)
            for i in range(_FOLDS * _STRETCHES):
                part = whole[edges[i] : edges[i + 1]]
                grams[i % _FOLDS] += part.T @ part
        return cls(places, tables, target, grams)

    def left(self, groups: Sequence[str]) -> tuple[float, list[Array]]:
        """Regress on the columns of some groups and the constant.

        Parameters
        ----------
        groups
            Names.

        Returns
        -------
        float
            Mean square of what is left of samples by coefficients found without them, two
            standard errors of it added.
        list of numpy.ndarray
            What is left by the coefficients found with all, of each record.
        """
        width = self.grams.shape[1]
        chosen = [i for name in groups for i in range(width)[self.places[name]]]
        rows = np.array([*chosen, width - 2, width - 1])
        grams = self.grams[:, rows[:, None], rows]
        whole = grams.sum(axis=0)
        found = [(_held_to(grams, ridge), ridge) for ridge in _RIDGES]
        left, ridge = min(found)
        solution = _solved(whole, _pull(whole, ridge))
        rest = [
            signal - table[:, rows[:-1]] @ solution
            for table, signal in zip(self.tables, self.target, strict=True)
        ]
        return max(left, 0.0) / sum(each.size for each in rest), rest


def _held_to(grams: Array, ridge: float) -> float:
    """Give the sum of squares of all folds, each by the others, and two standard errors more."""
    whole, before = grams.sum(axis=0), grams[:, -1, -1]
    pull = _pull(whole, ridge)
    solutions = [np.append(-_solved(whole - fold, pull), 1.0) for fold in grams]
    after = np.array([each @ fold @ each for each, fold in zip(solutions, grams, strict=True)])
    shares = np.divide(after, before, out=np.ones(_FOLDS), where=before > 0.0)
    chance = _STANDARD_ERRORS * float(shares.std()) / math.sqrt(_FOLDS - 1)
    return min(float(after.sum()) + chance * float(before.sum()), float(before.sum()))


def _pull(gram: Array, ridge: float) -> Array:
    """Give what is added to the diagonal: a share of each column's square, none to the constant.

    It is that of all samples, or a column that moves in the stretches left out alone is free.
    """
    pull = ridge * np.diag(gram)[:-1] + np.finfo(float).tiny
    pull[-1] = 0.0
    return np.asarray(pull)


def _solved(gram: Array, pull: Array) -> Array:
    """Give the coefficients of normal equations whose last column is the target."""
    return np.asarray(np.linalg.solve(gram[:-1, :-1] + np.diag(pull), gram[:-1, -1]))
