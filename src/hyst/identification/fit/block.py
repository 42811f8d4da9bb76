"""Some of the samples of a record on their way through a fit."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

BESIDE = -1
"""For the number of a record: gauges and priors come after all records."""


@dataclass(frozen=True, eq=False)
class Block:
    """Some of the samples used, one after the other, of one record.

    Parameters
    ----------
    record
        Number of the record, counted from 0; ``BESIDE`` for residuals that no sample makes.
    rows
        Which of the samples used they are.
    jacobian
        Shape (n, m): derivative of the output by theta.
    """

    record: int
    rows: slice
    jacobian: Array


Blocks = Callable[[], Iterable[Block]]
"""Gives a derivative block by block, each time it is called."""


def blocks_of(jacobian: Array, lengths: Sequence[int]) -> list[Block]:
    """Give a derivative record by record.

    Parameters
    ----------
    jacobian
        Shape (N, m).
    lengths
        Samples of each record.
    """
    ends = np.cumsum([0, *lengths])
    pieces = [slice(int(a), int(b)) for a, b in itertools.pairwise(ends)]
    return [Block(record, rows, jacobian[rows]) for record, rows in enumerate(pieces)]


def of_records(blocks: Blocks, columns: NDArray[np.bool_]) -> Iterator[Block]:
    """Give the blocks of samples, with some of their columns.

    Parameters
    ----------
    blocks
        With those of residuals that no sample makes.
    columns
        Shape (m,), which of them.
    """
    for each in blocks():
        if each.record != BESIDE:
            yield replace(each, jacobian=each.jacobian[:, columns])


def lengths_of(lengths: Sequence[int], chosen: NDArray[np.bool_] | None) -> list[int]:
    """Give how many samples of each record are chosen.

    Parameters
    ----------
    lengths
        Samples of each record.
    chosen
        Shape (N,), of all records in a row; all if None.
    """
    if chosen is None:
        return list(lengths)
    return [int(each.sum()) for each in np.split(chosen, np.cumsum(lengths)[:-1])]
