"""What is believed of the constants of a model before the first sample."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.operators import Operator
from hyst.operators.composition import leaves_of

Array = NDArray[np.float64]

_LEAST_SHARE = 0.1


def spreads_of(
    model: Operator, share: float, given: Mapping[str, float], sizes: tuple[float, float]
) -> Array:
    """Give how far off each constant is believed to be, as a standard error.

    A share of its size; of those that are small, of a tenth of the size of all constants of the
    same stage and unit, so that one that starts at 0 can grow.

    Parameters
    ----------
    model
        Where the estimation starts.
    share
        Above 0.
    given
        Standard errors by name, which count instead.
    sizes
        Of input and output: for constants in their units where no other one says how large.

    Returns
    -------
    numpy.ndarray
        Shape (m,); 0 for constants without any scale.
    """
    spreads = []
    for leaf in leaves_of(model):
        values, kinds = leaf.parameters().values, _units_of(leaf)
        size = np.array([_size_of(values, kinds, i, sizes) for i in range(values.size)])
        spreads.append(share * np.maximum(np.abs(values), _LEAST_SHARE * size))
    spread = np.concatenate([np.zeros(0), *spreads])
    names = model.parameters().names
    for name, error in given.items():
        spread[names.index(name)] = error
    return spread


def tied_scales(model: Operator) -> tuple[str, ...]:
    """Name constants that only repeat a scale another stage has, and are held therefore.

    Between two stages the signal can be given another unit without any effect on the output. One
    constant for each such place is held: the largest weight of a map, or of the later stage.

    Parameters
    ----------
    model
        Any operator.

    Returns
    -------
    tuple of str
    """
    leaves = leaves_of(model)
    counts = [len(leaf.parameters()) for leaf in leaves]
    first = np.concatenate([[0], np.cumsum(counts)])
    names, tied = model.parameters().names, []
    for i in range(len(leaves) - 1):
        pair = (_scales(leaves[i], 1.0, 2.0), _scales(leaves[i + 1], 2.0, 1.0))
        if pair[0] is None or pair[1] is None:
            continue
        k = i if leaves[i].is_map and not leaves[i + 1].is_map else i + 1
        moved = pair[k - i]
        assert moved is not None
        is_weight = moved == (2.0 if k == i else 0.5)
        values = np.where(is_weight, np.abs(leaves[k].parameters().values), -1.0)
        if is_weight.any() and values.max() > 0.0:
            tied.append(names[first[k] + int(np.argmax(values))])
    return tuple(tied)


def _scales(leaf: Operator, input_scale: float, output_scale: float) -> Array | None:
    try:
        return leaf.parameter_scales(input_scale, output_scale)
    except InputError:
        return None


def _units_of(leaf: Operator) -> list[tuple[float, float]]:
    """For each constant, by which factors it follows the units of input and output."""
    by_input, by_output = _scales(leaf, 2.0, 1.0), _scales(leaf, 1.0, 2.0)
    count = len(leaf.parameters())
    if by_input is None or by_output is None:
        # Of no unit that is known: each one for itself.
        return [(float(-i), 0.0) for i in range(count)]
    return list(zip(by_input.tolist(), by_output.tolist(), strict=True))


def _size_of(
    values: Array, kinds: list[tuple[float, float]], i: int, sizes: tuple[float, float]
) -> float:
    alike = values[[kind == kinds[i] for kind in kinds]]
    size = float(np.abs(alike).max())
    if size > 0.0:
        return size
    return {(2.0, 1.0): sizes[0], (1.0, 2.0): sizes[1]}.get(kinds[i], 0.0)
