"""What the state of the dynamics before a record still does in it: columns beside the model.

Where a record is used from, its hysteresis is known, but not what the dynamics were doing. They go
on with it as if alone, in as many ways as they have states. What their delay still held of the
hysteresis before the first sample comes to it: a model that starts at 0 would else be compared with
an actuator that rests at its offset.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.family import Fit
from hyst.identification.fit.nuisance import Beside, Moments, Nuisance, over_whole_records
from hyst.identification.fit.problem import model_output
from hyst.identification.record_use.used_samples import Data
from hyst.models import LinearDynamics

Array = NDArray[np.float64]

_OVER = 1e-10  # of what a state begins with
_MOST_LEVELS = 4  # of the hysteresis before a record: an actuator at rest has one


@final
@dataclass(frozen=True, eq=False)
class Ringing(Nuisance):
    """Responses to an unknown past from the first sample in use, with ``A = A0 + B0 k'``.

    Free ones, ``C A^k x``, and those to what the delay held, level by level.

    Parameters
    ----------
    base
        Gives A0, B0 and the delay.
    place
        Of the first entry of k in theta; the entries of C follow, and D if it is not 0.
    """

    base: LinearDynamics
    place: int

    def count(self, moments: Moments, theta: Array) -> int:
        """Give the number of states, and of levels in the delay."""
        return self.base.order + len(_levels(self.base.delay - moments.first))

    def columns(self, moments: Moments, theta: Array) -> Array:
        """Give one column for each state, and for each level in the delay."""
        A, C = self._matrices(theta)
        held = _levels(self.base.delay - moments.first)
        count = _samples(moments, A, self.base.delay)
        rows, inside = _rows(moments, count)
        columns = np.zeros((moments.places.size, self.base.order + len(held)))
        columns[inside, : self.base.order] = _powers(A.T, C, count)[rows]
        if held:
            G = LinearDynamics(A, self.base.B, C, self._feedthrough(theta), self.base.dt)
            answers = np.asarray(G(_steps(held, count))).T
            columns[inside, self.base.order :] = answers[rows]
        return columns

    def slopes(self, moments: Moments, theta: Array, coefficients: Array) -> Array:
        """Give the derivative by k, C and D of the response to one past."""
        A, C = self._matrices(theta)
        n, base = self.base.order, self.base
        held = _levels(base.delay - moments.first)
        result = np.zeros((moments.places.size, theta.size))
        count = _samples(moments, A, base.delay)
        rows, inside = _rows(moments, count)
        states = _powers(A, coefficients[:n], count)
        if held:
            drive = coefficients[n:] @ _steps(held, count)
            of_state = [LinearDynamics(A, base.B, each, 0.0, base.dt)(drive) for each in np.eye(n)]
            states = states + np.stack(of_state, axis=1)
            if base.D != 0.0:
                result[inside, self.place + 2 * n] = drive[rows]
        driven = LinearDynamics(A, base.B, C, 0.0, base.dt)(np.ascontiguousarray(states.T))
        result[inside, self.place : self.place + n] = np.asarray(driven).T[rows]
        result[inside, self.place + n : self.place + 2 * n] = states[rows]
        return result

    def _feedthrough(self, theta: Array) -> float:
        free = self.base.D != 0.0
        return float(theta[self.place + 2 * self.base.order]) if free else 0.0

    def _matrices(self, theta: Array) -> tuple[Array, Array]:
        n, own = self.base.order, theta[self.place :]
        return self.base.A + np.outer(self.base.B, own[:n]), own[n : 2 * n]


def _levels(held: int) -> list[slice]:
    """Give the samples that a delay still held, in as many levels as are told apart."""
    if held <= 0:
        return []
    ends = np.linspace(0, held, min(held, _MOST_LEVELS) + 1).round().astype(int)
    return [slice(int(a), int(b)) for a, b in pairwise(ends)]


def _steps(held: Sequence[slice], count: int) -> Array:
    """Give each level as a drive of the dynamics, shape (levels, count)."""
    drives = np.zeros((len(held), count))
    for row, samples in zip(drives, held, strict=True):
        row[samples] = 1.0
    return drives


def _samples(moments: Moments, A: Array, delay: int) -> int:
    """Give after how many samples nothing of it is left, or how many there are."""
    last = int(moments.places[-1]) - moments.first + 1 if moments.places.size else 1
    slowest = float(np.abs(np.linalg.eigvals(A)).max(initial=0.0))
    if not 0.0 < slowest < 1.0:
        return max(last, 1)
    over = np.log(_OVER) / np.log(slowest) + 2 * len(A) + delay
    return int(np.clip(over, 1, max(last, 1)))


def _rows(moments: Moments, count: int) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    since = moments.places - moments.first
    inside = (since >= 0) & (since < count)
    return since[inside], inside


def _powers(A: Array, x: Array, count: int) -> Array:
    """Give ``A^k x`` for k = 0 .. count - 1, shape (count, n), by doubling."""
    rows, power = x[None, :], A
    while len(rows) < count:
        rows = np.concatenate([rows, rows @ power.T])
        power = power @ power
    return rows[:count]


def without_ringing(data: Data, fit: Fit) -> Data:
    """Give the records without what the state of the dynamics before them left.

    Parameters
    ----------
    data
        The records, in the units of the fit.
    fit
        Whose columns beside the model it is.
    """
    nuisances = fit.parametrization.nuisances
    if nuisances is None:
        return data
    left = data.measured() - model_output(data, fit.operator)
    coefficients = Beside(data, nuisances).at(fit.solution.theta).coefficients(left)
    taken = over_whole_records(data, nuisances, fit.solution.theta, coefficients)
    pairs = zip(data.records, taken, strict=True)
    records = tuple(replace(each, y=each.y - part) for each, part in pairs)
    return replace(data, records=records, past=tuple(taken))
