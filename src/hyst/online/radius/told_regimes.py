"""Regimes that somebody tells, in the place of those from measured slopes."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.errors import InputError

Array = NDArray[np.float64]


def one_told(slope: float | None, regime: float | None, plays: int) -> tuple[bool, float] | None:
    """Read the slope or the regime of one sample.

    Parameters
    ----------
    slope
        Of the model at this sample; NaN where it is not known, None to measure it.
    regime
        How many plays are on their envelopes, likewise.
    plays
        How many there are.

    Returns
    -------
    tuple of bool and float or None
        Whether it is a slope, and the number; None to measure the slope.

    Raises
    ------
    InputError
        If both are given, or the regime is no whole number from 0 to ``plays``.

    Examples
    --------
    >>> one_told(None, 2, 3), one_told(0.5, None, 3), one_told(None, None, 3)
    ((False, 2.0), (True, 0.5), None)
    """
    found = told_of(
        None if slope is None else [slope], None if regime is None else [regime], 1, plays
    )
    return None if found is None else (found[0], float(found[1][0]))


def told_of(
    slopes: ArrayLike | None, regimes: ArrayLike | None, samples: int, plays: int
) -> tuple[bool, Array] | None:
    """Read slopes or regimes of a record.

    Parameters
    ----------
    slopes, regimes
        Shape (N,), as for ``one_told``.
    samples
        N.
    plays
        How many there are.

    Returns
    -------
    tuple of bool and numpy.ndarray or None
        Whether they are slopes, and the numbers; None to measure slopes.

    Raises
    ------
    InputError
        If both are given, their length is another one, or a regime is no whole number from 0 to
        ``plays``.

    Examples
    --------
    >>> told_of(None, [0, 1], 2, 1)
    (False, array([0., 1.]))
    """
    if slopes is not None and regimes is not None:
        raise InputError("slope and regime are both given; give one of them")
    given, name = (slopes, "slope") if regimes is None else (regimes, "regime")
    if given is None:
        return None
    try:
        numbers = np.ascontiguousarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{name} is {given!r}; give numbers, NaN where it is unknown") from None
    if numbers.shape != (samples,):
        raise InputError(
            f"{name} has the shape {numbers.shape}, the record has {samples} samples; give one "
            "number for each"
        )
    if regimes is not None:
        bad = ~np.isnan(numbers) & ~np.isin(numbers, np.arange(plays + 1))
        if bad.any():
            k = int(np.argmax(bad))
            raise InputError(
                f"regime is {numbers[k]:.6g} at sample {k}; give the number of plays on their "
                f"envelopes, 0 to {plays}, or NaN where it is unknown"
            )
    return slopes is not None, numbers
