"""Play outputs and normal equations of a bank of plays over several records."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.identification.record_use.used_samples import Data

Array = NDArray[np.float64]

BLOCK = 2**15
"""Samples: a bank over all of a long record takes many times the memory of the record."""


def bank_matrix(data: Data, r: Array) -> Array:
    """Give the regressors of the weights.

    Parameters
    ----------
    data
        The records.
    r
        Shape (n,), radii, input units.

    Returns
    -------
    numpy.ndarray
        Shape (samples used, 1 + n): the input, then the play outputs, of all records one after the
        other.
    """
    return np.concatenate([rows for _, rows in bank_blocks(data, r)])


def bank_blocks(data: Data, r: Array) -> Iterator[tuple[slice, Array]]:
    """Give the same block by block, each with which of the samples used it is of.

    Parameters
    ----------
    data, r
        As of ``bank_matrix``.
    """
    done = 0
    for record, window, counts in zip(data.records, data.windows(), data.counted(), strict=True):
        memory = np.zeros(r.size)
        for first in range(0, window.stop, BLOCK):
            u = np.ascontiguousarray(record.u[first : min(first + BLOCK, window.stop)])
            z = np.empty((u.size, r.size))
            _engine.play_outputs(r.tolist(), memory, u, z)
            skipped = max(window.start - first, 0)
            if skipped >= u.size:
                continue
            rows = np.column_stack([u, z])[skipped:]
            if counts is not None:
                begun = first + skipped - window.start
                rows = rows[counts[begun : begun + len(rows)]]
            yield slice(done, done + len(rows)), rows
            done += len(rows)


def bank_gram(data: Data, r: Array, u_origin: float = 0.0, y_origin: float = 0.0) -> Array:
    """Sum the inner products of the columns [u, z_1 .. z_n, 1, y] while the records stream by.

    Play outputs move with their input, so input and play outputs share one origin.

    Parameters
    ----------
    data
        The records.
    r
        Shape (n,), radii, input units.
    u_origin, y_origin
        Subtracted from the columns u and z, and from y: near their means no digits cancel later.

    Returns
    -------
    numpy.ndarray
        Shape (n + 3, n + 3), symmetric.
    """
    width = r.size + 3
    total = np.zeros((width, width))
    passes = zip(data.records, data.windows(), data.brought_forward(), data.counted(), strict=True)
    for record, window, output, counts in passes:
        u = record.u[: window.stop] - u_origin
        y = output - y_origin
        edges = _edges(window, counts)
        gram = np.zeros((len(edges) - 1, width, width))
        _engine.play_gram(r.tolist(), np.full(r.size, -u_origin), u, y, edges, gram)
        first = 0 if counts is None or counts[0] else 1
        total += gram[first::2].sum(axis=0) if len(gram) > 1 else gram[0]
    return total


def _edges(window: slice, counts: NDArray[np.bool_] | None) -> list[int]:
    """Give where samples that count and samples that do not take turns, both ends included."""
    if counts is None:
        return [window.start, window.stop]
    turns = window.start + 1 + np.flatnonzero(np.diff(counts))
    return [window.start, *turns.tolist(), window.stop]
