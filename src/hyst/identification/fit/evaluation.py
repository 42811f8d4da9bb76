"""Outputs of a parametrization over records, and their derivatives: whole, or block by block.

Invariant: a block's derivatives go on from the memory of the block before and from its derivatives,
so that blocks and whole agree to rounding, and no more than a block of them is ever held.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.identification.fit.block import Block
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.record_use.used_samples import Data
from hyst.operators import Operator

Array = NDArray[np.float64]
Rows = NDArray[np.bool_]
Places = NDArray[np.intp]

FEW_CONSTANTS = 2
"""Times the free parameters: up to so many constants their products are summed, and taken to theta
after that; of more, every sample's derivatives are taken to theta first."""

SHORT_RUN = 200
"""Samples: rows in runs that are shorter on average are gathered, and summed together."""

BLOCK = 4096
"""Samples: derivatives by thirty constants fit in a cache of 1 MB."""


@dataclass(frozen=True, eq=False)
class _Pass:
    """One record: the chain at its sample time, its input, its window, and what counts of it."""

    chain: _engine.Chain
    u: Array
    window: slice
    counts: NDArray[np.bool_] | None


class Evaluation:
    """Model outputs and their derivatives by theta over the samples used.

    The engine is given the constants as one vector; no operator is built or checked, for the bounds
    of a parametrization and its canonical form keep every theta one that makes an operator.

    Parameters
    ----------
    data
        The records.
    parametrization
        Free parameters of a model.
    """

    def __init__(self, data: Data, parametrization: Parametrization) -> None:
        self._parametrization = parametrization
        self._joined = data.joined
        self._lengths = data.lengths()
        self._start = parametrization.template.initial_state()
        chains = {
            dt: _engine.Chain(parametrization.template.at_sample_time(dt).stages())
            for dt in _sample_times(data, parametrization.template)
        }
        self._chains = tuple(chains.values())
        self._passes = [
            _Pass(
                chains.get(record.dt, self._chains[0]),
                np.ascontiguousarray(record.u[: window.stop]),
                window,
                counts,
            )
            for record, window, counts in zip(
                data.records, data.windows(), data.counted(), strict=True
            )
        ]

    def output(self, theta: Array) -> Array:
        """Give the output of the model of canonical theta, shape (samples used,)."""
        self._set(theta)
        parts = []
        for each in self._passes:
            y = np.empty((1, each.u.size))
            if each.chain.run(self._start[None, :].copy(), each.u[None, :], y) >= 0:
                self._parametrization.operator(theta)(each.u)  # names the sample that overflows
            parts.append(y[0, each.window])
        return self._joined(parts)

    def jacobian(self, theta: Array) -> Array:
        """Give its derivative by theta, shape (samples used, m)."""
        self._set(theta)
        result = np.empty((sum(self._lengths), theta.size))
        row = 0
        for each, length in zip(self._passes, self._lengths, strict=True):
            by_constants = self._rows[: each.u.size]
            each.chain.jacobian(self._start.copy(), each.u, by_constants)
            rows = by_constants[each.window]
            rows = rows if each.counts is None else rows[each.counts]
            result[row : row + length] = self._by_theta(rows)
            row += length
        return result

    def blocks(self, theta: Array) -> Iterator[Block]:
        """Give the derivative by theta, block by block; no more than one of them is held."""
        self._set(theta)
        first = 0
        for number, each in enumerate(self._passes):
            for rows in self._blocks_of(each):
                stop = first + len(rows)
                yield Block(number, slice(first, stop), self._by_theta(rows))
                first = stop

    def products(
        self, theta: Array, errors: Array, chosen: Rows | None = None, root: Array | None = None
    ) -> tuple[Array, Array]:
        """Give ``J'J`` and ``J'e`` of some samples, J being the derivative by theta.

        Parameters
        ----------
        theta
            Canonical.
        errors
            Shape (samples chosen,), with their weights.
        chosen
            Shape (samples used,): which samples count; all if left out.
        root
            Shape (samples chosen,): square root of every sample's weight; 1 if left out.
        """
        self._set(theta)
        transform = self._parametrization.transform
        late = len(transform) <= FEW_CONSTANTS * theta.size
        size = len(transform) if late else theta.size
        matrix, gradient = np.zeros((size, size)), np.zeros(size)
        first = 0
        for each, pieces in zip(self._passes, self._pieces(chosen), strict=True):
            by_constants = self._rows[: each.u.size]
            each.chain.jacobian(self._start.copy(), each.u, by_constants)
            for piece in pieces:
                rows = by_constants[piece] if late else self._by_theta(by_constants[piece])
                place = slice(first, first + len(rows))
                rows = rows if root is None else root[place, None] * rows
                matrix += rows.T @ rows
                gradient += rows.T @ errors[place]
                first = place.stop
        if late:
            return transform.T @ matrix @ transform, transform.T @ gradient
        return matrix, gradient

    def _pieces(self, chosen: Rows | None) -> list[list[slice] | list[Places]]:
        """Give for each record the rows of its samples that are chosen, and count."""
        ends = np.cumsum(self._lengths)[:-1]
        parts = [None] * len(self._passes) if chosen is None else np.split(chosen, ends)
        return [_pieces_of(each, part) for each, part in zip(self._passes, parts, strict=True)]

    def jacobian_at(self, theta: Array, rows: NDArray[np.intp]) -> Array:
        """Give the derivative at some of the samples used, shape (rows, m).

        Parameters
        ----------
        theta
            Canonical.
        rows
            Which of them, ascending.
        """
        if rows.size == sum(self._lengths):
            return self.jacobian(theta)
        result = np.empty((rows.size, theta.size))
        for block in self.blocks(theta):
            here = slice(*np.searchsorted(rows, [block.rows.start, block.rows.stop]))
            result[here] = block.jacobian[rows[here] - block.rows.start]
        return result

    def _blocks_of(self, each: _Pass) -> Iterator[Array]:
        """Give the derivatives by all constants of the samples of one record that are used."""
        state, start = self._start.copy(), each.window.start
        memory = np.zeros((state.size, each.chain.parameter_count))
        room = np.empty((BLOCK, each.chain.parameter_count))
        for first in range(0, each.u.size, BLOCK):
            signal = each.u[first : first + BLOCK].copy()
            rows = room[: signal.size]
            each.chain.carry_jacobian(state, memory, signal, rows)
            if first + signal.size <= start:
                continue
            used = slice(max(first, start) - start, first + signal.size - start)
            rows = rows[max(start - first, 0) :]
            yield rows if each.counts is None else rows[each.counts[used]]

    def _by_theta(self, by_constants: Array) -> Array:
        """Give derivatives by theta from those by all constants, shape (n, m)."""
        if self._chosen is None:
            return np.asarray(by_constants @ self._parametrization.transform)
        places, factors = self._chosen
        return np.asarray(by_constants[:, places] * factors)

    @functools.cached_property
    def _chosen(self) -> tuple[Places, Array] | None:
        """Which constant each parameter moves, and by how much, where it moves but one."""
        transform = self._parametrization.transform
        if np.count_nonzero(transform, axis=0).max(initial=0) > 1:
            return None
        places = np.abs(transform).argmax(axis=0)
        return places, transform[places, np.arange(places.size)]

    def _set(self, theta: Array) -> None:
        constants = self._parametrization.constants(theta)
        for chain in self._chains:
            chain.set_parameters(constants)

    @functools.cached_property
    def _rows(self) -> Array:
        """Room for the derivatives by all constants; fresh memory costs more than to fill it."""
        return np.empty(
            (max(each.u.size for each in self._passes), self._chains[0].parameter_count)
        )


def _pieces_of(record: _Pass, chosen: Rows | None) -> list[slice] | list[Places]:
    """Give rows of one record as runs, which need no copy, or all at once if they are short."""
    if record.counts is None and chosen is None:
        return [record.window]
    rows = np.zeros(record.window.stop, dtype=bool)
    used = rows[record.window]
    used[slice(None) if record.counts is None else record.counts] = (
        True if chosen is None else chosen
    )
    edges = np.flatnonzero(np.diff(rows, prepend=False, append=False))
    runs = [slice(int(a), int(b)) for a, b in edges.reshape(-1, 2)]
    if len(runs) * SHORT_RUN <= np.count_nonzero(rows):
        return runs
    return [np.flatnonzero(rows)]


def _sample_times(data: Data, operator: Operator) -> list[float]:
    """Give the sample times at which an operator differs; one for one that has none."""
    times = dict.fromkeys(record.dt for record in data.records)
    return list(times) if operator.dt is not None else [data.records[0].dt]
