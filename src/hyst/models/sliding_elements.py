"""What constants of friction may be."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants
from hyst.checks.numbers import as_positive
from hyst.errors import InputError

Array = NDArray[np.float64]


def as_positive_entries(values: ArrayLike, name: str) -> Array:
    """Check constants of elements, all of them above 0.

    Parameters
    ----------
    values
        Shape (n,).
    name
        What messages call it.

    Returns
    -------
    numpy.ndarray
        Float64, read-only.

    Raises
    ------
    InputError
        If one is zero, negative or not finite.
    """
    constants = as_constants(values, name)
    wrong = np.flatnonzero(constants <= 0.0)
    if wrong.size:
        i = int(wrong[0])
        raise InputError(
            f"{name}[{i}] is {constants[i]}; give positive numbers, and leave out elements "
            "that bear nothing"
        )
    return constants


def require_one_each(values: Array, others: Array, name: str, other: str) -> None:
    """Refuse constants of elements that are not as many as others.

    Parameters
    ----------
    values, others
        Shapes (n,).
    name, other
        What the message calls them.

    Raises
    ------
    InputError
        If their lengths differ.
    """
    if values.size != others.size:
        raise InputError(
            f"{other} has {others.size} entries but {name} has {values.size}; give one {name} for "
            f"each {other}"
        )


def as_start(values: ArrayLike | None, count: int, name: str) -> Array:
    """Check what elements remember before the first sample; zeros if left out.

    Parameters
    ----------
    values
        Shape (count,), or None.
    count
        How many elements there are.
    name
        What messages call it.

    Returns
    -------
    numpy.ndarray
        Float64, read-only.

    Raises
    ------
    InputError
        If there are more or fewer, or one is not finite.
    """
    start = as_constants(np.zeros(count) if values is None else values, name)
    if start.size != count:
        raise InputError(f"{name} has {start.size} entries; give one for each of {count} elements")
    # -0.0 becomes 0.0, since a dictionary leaves out a memory of zeros.
    return as_constants(start + 0.0, name)


def as_stribeck(Fc: Any, Fs: Any, vs: Any) -> tuple[float, float, float]:
    """Check the constants of a Stribeck curve.

    Parameters
    ----------
    Fc, Fs, vs
        Force of fast sliding and at rest, output units, and the velocity between them.

    Returns
    -------
    tuple of float

    Raises
    ------
    InputError
        If one is not positive and finite, or Fs is below Fc.
    """
    coulomb, static = as_positive(Fc, "Fc"), as_positive(Fs, "Fs")
    if static < coulomb:
        raise InputError(
            f"Fs is {static:.6g}, below Fc = {coulomb:.6g}; friction at rest is at least that of "
            "sliding, so give Fs >= Fc"
        )
    return coulomb, static, as_positive(vs, "vs")
