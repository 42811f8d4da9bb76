"""The flat parameter vector of an operator."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.checks.arrays import as_constants
from hyst.errors import InputError


@dataclass(frozen=True, eq=False)
class Parameters:
    """Values, names and bounds of the constants of an operator, in one fixed order.

    Parameters
    ----------
    values, lower, upper
        Shape (m,), float64; ``lower <= values <= upper``. Bounds may be infinite.
    names
        m distinct names, for example ``p[1]`` or ``affine.offset``.
    """

    values: NDArray[np.float64]
    names: tuple[str, ...]
    lower: NDArray[np.float64]
    upper: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.names)


def numbered(name: str, count: int, first: int = 1) -> tuple[str, ...]:
    """Give names ``name[first]`` ... for ``count`` entries, counted from 1 as in the formulas.

    Parameters
    ----------
    name
        The array's name.
    count
        How many entries it has.
    first
        Number of the first one; other than 1 only where it is a power.

    Returns
    -------
    tuple of str
    """
    return tuple(f"{name}[{first + i}]" for i in range(count))


def parameters_of_plays(p0: float, p: NDArray[np.float64], r: NDArray[np.float64]) -> Parameters:
    """Give p0, the weights, then the thresholds, which stay zero or more.

    Parameters
    ----------
    p0
        Weight of the input.
    p, r
        Shape (n,), weights and thresholds of the plays.
    """
    n = p.size
    free = np.full(n + 1, np.inf)
    return Parameters(
        values=np.concatenate([[p0], p, r]),
        names=("p0", *numbered("p", n), *numbered("r", n)),
        lower=np.concatenate([-free, np.zeros(n)]),
        upper=np.concatenate([free, free[1:]]),
    )


def as_parameter_vector(
    theta: Sequence[float] | NDArray[np.float64], count: int
) -> NDArray[np.float64]:
    """Check a parameter vector.

    Parameters
    ----------
    theta
        Shape (count,), finite numbers.
    count
        How many entries the operator needs.

    Returns
    -------
    numpy.ndarray
        A read-only float64 copy.

    Raises
    ------
    InputError
        If it is no list of real numbers, the length is wrong or an entry is not finite.
    """
    vector = as_constants(theta, "theta")
    if vector.size != count:
        raise InputError(f"theta has {vector.size} entries; this operator has {count} parameters")
    return vector
