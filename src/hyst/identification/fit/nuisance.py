"""Columns beside a model that are fitted with it and are none of it: variable projection.

What a record holds beside the model, as the state of a lag before its first sample or a drift, is a
sum of columns. For every theta their best coefficients are known, so columns are projected out
of residual and Jacobian, and theta holds the model alone. Standard errors from what is left are
those of the joint fit (Frisch, Waugh and Lovell).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import final

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from hyst.identification.fit.projection import Basis, Projection
from hyst.identification.record_use.used_samples import Data

Array = NDArray[np.float64]
Rows = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Moments:
    """When samples of one record were taken.

    Parameters
    ----------
    number
        Of the record, counted from 0.
    places
        Shape (n,), which samples of the record, by the clock of the model's output.
    dt
        Time between samples, s.
    duration
        Of the record, s.
    first
        The first sample in use: what settles is measured from there, for of what has died away
        before nothing is known.
    """

    number: int
    places: NDArray[np.intp]
    dt: float
    duration: float
    first: int = 0

    @property
    def time(self) -> Array:
        """Shape (n,), s since the first sample of the record."""
        return np.asarray(self.places * self.dt)


class Nuisance(ABC):
    """Columns that every record has beside the model, each record with its own coefficients."""

    @property
    def has_columns(self) -> bool:
        """Whether there is any column to be projected out."""
        return True

    @abstractmethod
    def columns(self, moments: Moments, theta: Array) -> Array:
        """Give the columns over some samples of a record, shape (n, q).

        Parameters
        ----------
        moments
            When the samples were taken.
        theta
            Shape (m,), the free parameters of the model.
        """

    def count(self, moments: Moments, theta: Array) -> int:
        """Give their number q.

        Parameters
        ----------
        moments
            When the samples were taken.
        theta
            Shape (m,), the free parameters of the model.
        """
        return int(self.columns(moments, theta).shape[1])

    def slopes(self, moments: Moments, theta: Array, coefficients: Array) -> Array | None:
        """Give the derivative of ``columns @ coefficients`` by theta, shape (n, m).

        Parameters
        ----------
        moments, theta
            As of ``columns``.
        coefficients
            Shape (q,).

        Returns
        -------
        numpy.ndarray or None
            None where the columns do not depend on theta.
        """
        return None


@final
@dataclass(frozen=True)
class Drift(Nuisance):
    """A polynomial in time without its constant, which is the model's offset.

    Parameters
    ----------
    degree
        1 for a straight line.
    """

    degree: int = 1

    @property
    def has_columns(self) -> bool:
        """Whether it is more than the constant."""
        return self.degree > 0

    def columns(self, moments: Moments, theta: Array) -> Array:
        """Give Legendre polynomials over the record."""
        t = 2.0 * moments.time / (moments.duration or 1.0) - 1.0
        return np.asarray(legendre.legvander(t, self.degree)[:, 1:])


@final
@dataclass(frozen=True)
class Settling(Nuisance):
    """What first-order lags still do of their unknown state before the record: ``exp(-t / tau)``.

    Time counts from the first sample in use, and before it as 0.

    Parameters
    ----------
    places
        Which entries of theta are the time constants, s.
    """

    places: tuple[int, ...]

    def columns(self, moments: Moments, theta: Array) -> Array:
        """Give one exponential for each time constant."""
        return np.exp(-self._since(moments) / theta[list(self.places)])

    def slopes(self, moments: Moments, theta: Array, coefficients: Array) -> Array:
        """Give ``c t / tau^2 exp(-t / tau)`` at the place of each time constant."""
        tau = theta[list(self.places)]
        result = np.zeros((moments.places.size, theta.size))
        by_tau = self._since(moments) / tau**2 * self.columns(moments, theta)
        result[:, list(self.places)] = coefficients * by_tau
        return result

    def _since(self, moments: Moments) -> Array:
        return np.maximum(moments.places - moments.first, 0)[:, None] * moments.dt


@final
@dataclass(frozen=True, eq=False)
class Given(Nuisance):
    """A column that is known for every sample of each record, whatever theta.

    Parameters
    ----------
    signals
        Of each record, shape (samples of the record, or up to the last one used).
    """

    signals: tuple[Array, ...]

    def columns(self, moments: Moments, theta: Array) -> Array:
        """Give the column; beyond its ends it goes on as it ends."""
        signal = self.signals[moments.number]
        return signal[np.clip(moments.places, 0, signal.size - 1), None]


@final
@dataclass(frozen=True)
class Nuisances:
    """All columns beside a model.

    Parameters
    ----------
    parts
        Each of its kind.
    """

    parts: tuple[Nuisance, ...]

    @property
    def has_columns(self) -> bool:
        """Whether any part has a column to be projected out."""
        return any(each.has_columns for each in self.parts)

    def columns(self, moments: Moments, theta: Array) -> Array:
        """Give the columns of all parts, shape (n, q).

        Parameters
        ----------
        moments
            When the samples were taken.
        theta
            Shape (m,), the free parameters of the model.
        """
        return np.concatenate([each.columns(moments, theta) for each in self.parts], axis=1)

    def slopes(self, moments: Moments, theta: Array, coefficients: Array) -> Array:
        """Give the derivative of ``columns @ coefficients`` by theta, shape (n, m).

        Parameters
        ----------
        moments
            When the samples were taken.
        theta
            Shape (m,), the free parameters of the model.
        coefficients
            Shape (q,).
        """
        total = np.zeros((moments.places.size, theta.size))
        first = 0
        for each in self.parts:
            count = each.count(moments, theta)
            by_theta = each.slopes(moments, theta, coefficients[first : first + count])
            total += 0.0 if by_theta is None else by_theta
            first += count
        return total


class Beside:
    """The columns beside a model over the samples in use, to be projected out.

    Parameters
    ----------
    data
        The records.
    nuisances
        The columns.
    chosen
        Shape (samples used,): which samples count; all if left out.
    root_weights
        Shape (samples used,): square root of every sample's weight; 1 if left out.
    """

    def __init__(
        self,
        data: Data,
        nuisances: Nuisances,
        chosen: Rows | None = None,
        root_weights: Array | None = None,
    ) -> None:
        self._nuisances = nuisances
        self._last: tuple[Array, Projection] | None = None
        ends = np.cumsum(data.lengths())[:-1]
        moments = moments_of(data)
        masks = [None] * len(moments) if chosen is None else np.split(chosen, ends)
        roots = [None] * len(moments) if root_weights is None else np.split(root_weights, ends)
        self._moments, self._roots = list[Moments](), list[Array | None]()
        for each, mask, root in zip(moments, masks, roots, strict=True):
            rows = slice(None) if mask is None else mask
            self._moments.append(replace(each, places=each.places[rows]))
            self._roots.append(None if root is None else root[rows])

    def at(self, theta: Array) -> Projection:
        """Give the projection for one theta; the last one is remembered."""
        if self._last is not None and np.array_equal(self._last[0], theta):
            return self._last[1]
        self._last = theta.copy(), self._new_at(theta)
        return self._last[1]

    def _new_at(self, theta: Array) -> Projection:
        bases = []
        for moments, root in zip(self._moments, self._roots, strict=True):
            columns = self._nuisances.columns(moments, theta)
            bases.append(Basis.of(columns if root is None else root[:, None] * columns))
        return Projection(bases)

    def slopes(self, theta: Array, coefficients: Sequence[Array]) -> Array:
        """Give the derivative of what the columns make by theta, all records in a row.

        Parameters
        ----------
        theta
            Shape (m,).
        coefficients
            Of each record, shape (q,).
        """
        parts = [
            self.slopes_of(record, slice(None), theta, each)
            for record, each in enumerate(coefficients)
        ]
        return np.concatenate(parts)

    def slopes_of(self, record: int, rows: slice, theta: Array, coefficients: Array) -> Array:
        """Give the derivative of what the columns make by theta over some samples of one record.

        Parameters
        ----------
        record
            Counted from 0.
        rows
            Which of its samples that count.
        theta
            Shape (m,).
        coefficients
            Shape (q,).
        """
        moments, root = self._moments[record], self._roots[record]
        some = replace(moments, places=moments.places[rows])
        by_theta = self._nuisances.slopes(some, theta, coefficients)
        return by_theta if root is None else root[rows, None] * by_theta


def moments_of(data: Data) -> list[Moments]:
    """Tell when the samples in use of each record were taken.

    Parameters
    ----------
    data
        The records.
    """
    passes = zip(data.records, data.windows(), data.counted(), strict=True)
    found = []
    for number, (record, window, counts) in enumerate(passes):
        places = np.arange(window.start, window.stop)
        places = places if counts is None else places[counts]
        found.append(Moments(number, places, record.dt, record.duration, window.start))
    return found


def over_whole_records(
    data: Data, nuisances: Nuisances, theta: Array, coefficients: Sequence[Array]
) -> list[Array]:
    """Give what the columns make at every measured output sample of each record.

    Parameters
    ----------
    data
        The records.
    nuisances, theta
        The columns.
    coefficients
        Of each record.
    """
    whole = []
    passes = zip(data.records, data.windows(), data.whole_lags(), coefficients, strict=True)
    for number, (record, window, late, each) in enumerate(passes):
        places = np.arange(len(record)) - late
        moments = Moments(number, places, record.dt, record.duration, window.start)
        whole.append(np.asarray(nuisances.columns(moments, theta) @ each))
    return whole
