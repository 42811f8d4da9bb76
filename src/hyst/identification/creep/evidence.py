"""Whether what a model without creep leaves is creep, and by which lags it is made best.

What is left is fitted by lags of the model's output with weights that are not negative, beside
the directions in which the model's own constants could move, beside a delay, a drift and whatever
lags of those time constants still did of their state before each record. So what comes late,
settles since the beginning of a record, or drifts, is none of it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.creep.lags import answers, grid_of, in_use, signals_that_creep
from hyst.identification.creep.rate_dependence import widening_loops
from hyst.identification.families.family import Fit
from hyst.identification.fit.evaluation import Evaluation
from hyst.identification.fit.non_negative import non_negative
from hyst.identification.fit.nuisance import (
    Beside,
    Drift,
    Given,
    Nuisance,
    Nuisances,
    Settling,
)
from hyst.identification.fit.problem import model_output
from hyst.identification.fit.projection import Basis
from hyst.identification.judgement.general_loops import general_loops
from hyst.identification.judgement.regression import chance, correlation_time
from hyst.identification.judgement.remainder import Remainder, remainder_of
from hyst.identification.record_use.used_samples import Data

Array = NDArray[np.float64]
Rows = NDArray[np.bool_]

UNLIKELY = 1e-5
"""Probability that noise alone looks like creep."""

SMALLEST_SHARE = 0.08
"""Of the squared error that creep must explain: less makes the error less than 4 % smaller."""

SMALLEST_PART = 5e-4
"""Of the output's range: creep of less rms is not looked for."""

BEYOND_LOOPS = 0.5
"""Share of what creep explains that general loops must not explain as well, or of all they leave
that creep must explain: they are so general that they take a part of any creep."""

BEYOND_RATE = 0.25
"""Share of what creep explains beside general loops that loops which widen with the rate must not
explain as well: beside them lags of a true creep explain 0.36 to 0.96 of it, those that imitate
thresholds that grow with the rate 0.03 to 0.17."""

OF_EITHER_SIGN = 0.5
"""Share of what lags of either sign explain that lags of positive weight must explain."""

LARGEST = 0.6
"""Sum of weights: what lags by more of its way is dynamics."""

MOST_ROWS = 10_000
"""Samples that regressions take, spread evenly."""


@dataclass(frozen=True, eq=False)
class Evidence:
    """What lags of a model's output explain of what it leaves.

    Parameters
    ----------
    shown
        Whether the records show creep beyond drift, noise and loops of another shape.
    resembled
        Whether something is left that looks like creep, whatever else it looks like.
    weights, time_constants
        Shape (n,), of the lags that have some weight, time constants ascending, s.
    tau, limits
        Shape (k,): the grid, s, and two standard errors of the weight of a single lag of each of
        its time constants, beside drift and settling.
    late, late_error
        By how much the output comes later beside its creep, and the standard error, s.
    """

    shown: bool
    resembled: bool
    weights: Array
    time_constants: Array
    tau: Array
    limits: Array
    late: float
    late_error: float


def evidence_of(data: Data, fit: Fit, drifts: bool, *, only_if_shown: bool = False) -> Evidence:
    """Look for creep in what a fit without creep leaves.

    Parameters
    ----------
    data
        The records, their drift left in, in units in which ranges lie between 1 and 2.
    fit
        Of a model without creep.
    drifts
        Whether the output may also drift.
    only_if_shown
        Whether nobody goes on with creep that the records do not show: how late the output is
        beside it, which takes as long as all else, is not asked then.
    """
    tau, rows = grid_of(data), evenly(data)
    look = Look(data, fit, nuisances_of(tau.size, drifts), tau, rows)
    span = float(np.ptp(data.measured()))
    remainder = remainder_of(data, fit, span)
    weights, explained = look.with_positive_weights()
    either = look.by_either_sign()
    loops = general_loops(remainder) if explained > 0.0 else look.raw_own[:, :0]
    beside_loops = look.beside(loops)
    beyond = beside_loops.with_positive_weights()[1]
    n, total = look.error.size, float(look.error @ look.error)
    resembled = explained >= max(SMALLEST_SHARE * total, n * (SMALLEST_PART * span) ** 2)
    shown = (
        resembled
        and explained >= OF_EITHER_SIGN * either
        and beyond >= SMALLEST_SHARE * total
        and beyond >= BEYOND_LOOPS * min(explained, float(beside_loops.error @ beside_loops.error))
        and weights.sum() <= LARGEST
        and beside_loops.chance_of(beyond, int((weights > 0.0).sum())) <= UNLIKELY
        and _beyond_rate(look, remainder, loops) >= BEYOND_RATE * beyond
    )
    heavy = weights > 0.0
    late = look.lateness(heavy) if shown or not only_if_shown else (0.0, math.inf)
    return Evidence(bool(shown), resembled, weights[heavy], tau[heavy], tau, look.limits(), *late)


def _beyond_rate(look: Look, remainder: Remainder, loops: Array) -> float:
    """Give what lags explain beside general loops and such as widen with the rate."""
    both = np.column_stack([loops, widening_loops(remainder)])
    return look.beside(both).with_positive_weights()[1]


def evenly(data: Data, most: int = MOST_ROWS) -> Rows:
    """Choose samples in use that are spread evenly.

    Parameters
    ----------
    data
        The records.
    most
        How many at most.
    """
    total = sum(data.lengths())
    rows = np.zeros(total, dtype=np.bool_)
    rows[np.round(np.linspace(0, total - 1, min(total, most))).astype(np.intp)] = True
    return rows


def nuisances_of(count: int, drifts: bool, first: int = 0, late: Sequence[Array] = ()) -> Nuisances:
    """Give the columns beside a model with some lags.

    Parameters
    ----------
    count
        Of lags.
    drifts
        Whether the output may also drift.
    first
        Place in theta of their first time constant.
    late
        For each record, by which the output changes where it comes later; none if left out.
    """
    parts: list[Nuisance] = [Given(tuple(late))] if late else []
    parts += [Drift()] if drifts else []
    return Nuisances((*parts, Settling(tuple(range(first, first + count)))))


def lateness(data: Data, signals: Sequence[Array]) -> list[Array]:
    """Give for each record by what a signal changes where it comes a second later.

    Parameters
    ----------
    data
        The records.
    signals
        Of each.
    """
    pairs = zip(data.records, signals, strict=True)
    return [-np.diff(each, prepend=each[:1]) / record.dt for record, each in pairs]


class Look:
    """What a fit leaves and what lags of its output look like, beside all that is no creep.

    Parameters
    ----------
    data, fit
        The records and a model without creep.
    nuisances
        Columns beside the model, whose theta are the time constants.
    tau
        Shape (k,), of the lags, s.
    rows
        Shape (samples used,), which count.
    """

    def __init__(self, data: Data, fit: Fit, nuisances: Nuisances, tau: Array, rows: Rows) -> None:
        self._projection = Beside(data, nuisances, rows).at(tau)
        self.raw_error = (data.measured() - model_output(data, fit.operator))[rows]
        signals = signals_that_creep(data, fit)
        self.raw_lags = in_use(data, answers(data, signals, tau))[rows]
        evaluation = Evaluation(data, fit.parametrization)
        moved = evaluation.jacobian(fit.solution.theta)[rows]
        late = in_use(data, lateness(data, signals))[rows]
        self.raw_own = np.column_stack([moved, late])
        own = Basis.of(self._projection.out_of(self.raw_own))
        self.error = own.out_of(self._projection.out_of(self.raw_error))
        self.lags = own.out_of(self._projection.out_of(self.raw_lags))
        self.directions = own.orthonormal.shape[1] + self._projection.directions
        self._own = own

    def beside(self, columns: Array) -> Look:
        """Give the same beside further columns, shape (rows, q)."""
        other = object.__new__(Look)
        other.__dict__.update(self.__dict__)
        further = Basis.of(self._own.out_of(self._projection.out_of(columns)))
        other.error, other.lags = further.out_of(self.error), further.out_of(self.lags)
        other.directions = self.directions + further.orthonormal.shape[1]
        return other

    def with_positive_weights(self) -> tuple[Array, float]:
        """Give the weights that leave least, none negative, and what they explain."""
        weights, _ = non_negative(self.lags, self.error)
        left = self.error - self.lags @ weights
        return weights, float(self.error @ self.error - left @ left)

    def by_either_sign(self) -> float:
        """Give what lags of any weights explain."""
        left = Basis.of(self.lags).out_of(self.error)
        return float(self.error @ self.error - left @ left)

    def chance_of(self, explained: float, lags: int) -> float:
        """Give how likely noise alone would let some lags explain so much.

        Parameters
        ----------
        explained
            Of the residual's sum of squares.
        lags
            How many lags explain it.
        """
        left = Basis.of(self.lags).out_of(self.error)
        before = float(self.error @ self.error)
        freedom = (self.error.size - self.directions - lags) / correlation_time(left)
        return chance(before, before - explained, lags, freedom)

    def limits(self) -> Array:
        """Give two standard errors of the weight of a single lag of each time constant."""
        left = Basis.of(self.lags).out_of(self.error)
        freedom = max(left.size - self.directions - 1, 1)
        deviation = math.sqrt(float(left @ left) / freedom * correlation_time(left))
        size = np.linalg.norm(self.lags, axis=0)
        with np.errstate(divide="ignore"):
            return np.asarray(2.0 * deviation / size)

    def lateness(self, heavy: Rows) -> tuple[float, float]:
        """Give by how much the output comes later, and the standard error, s.

        Parameters
        ----------
        heavy
            Shape (k,): which lags have some weight.
        """
        others = np.column_stack([self.raw_own[:, :-1], self.raw_lags[:, heavy]])
        basis = Basis.of(self._projection.out_of(others))
        column = basis.out_of(self._projection.out_of(self.raw_own[:, -1]))
        error = basis.out_of(self._projection.out_of(self.raw_error))
        energy = max(float(column @ column), np.finfo(float).tiny)
        late = float(column @ error) / energy
        rest = error - late * column
        freedom = max(rest.size - self.directions - int(heavy.sum()), 1)
        variance = float(rest @ rest) / freedom * correlation_time(rest)
        return late, math.sqrt(variance / energy)

    def coefficients(self, weights: Array) -> list[Array]:
        """Give those of the columns beside the model, each record's own, for given weights."""
        left = self.raw_error - self.raw_lags @ weights
        own = self._projection.out_of(self.raw_own)
        moved = np.linalg.lstsq(own, self._projection.out_of(left), rcond=1e-9)[0]
        return self._projection.coefficients(left - self.raw_own @ moved)
