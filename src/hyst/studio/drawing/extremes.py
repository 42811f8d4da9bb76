"""Few samples that draw like all of them: the extremes of each stretch."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def extreme_samples(stretches: int, *signals: Array) -> NDArray[np.intp]:
    """Choose the ends of a record and the extremes of every signal in each of its stretches.

    A line through them covers what a line through all samples covers, within the width of a
    stretch.

    Parameters
    ----------
    stretches
        How many at most; about one for each column of pixels.
    signals
        Of one length N; samples that are not finite are passed over.

    Returns
    -------
    numpy.ndarray
        Ascending indices, at most 2 for each stretch and signal, and 2; all where N is so small.

    Examples
    --------
    >>> y = np.zeros(1_000_000)
    >>> y[123_456] = 1.0
    >>> chosen = extreme_samples(500, y)
    >>> chosen.size < 1100, 123_456 in chosen
    (True, True)
    """
    size = signals[0].size
    if size <= 2 * stretches * len(signals) + 2:
        return np.arange(size)
    length = -(-size // stretches)  # rounded up, so that what is left is no longer than a stretch
    count = size // length
    whole = length * count
    begins = np.arange(count) * length
    chosen = [np.array([0, size - 1]), *_of_rest(whole, size, signals)]
    for signal in signals:
        rows = signal[:whole].reshape(count, length)
        low = np.where(np.isfinite(rows), rows, np.inf).argmin(axis=1)
        high = np.where(np.isfinite(rows), rows, -np.inf).argmax(axis=1)
        chosen += [begins + low, begins + high]
    return np.unique(np.concatenate(chosen)).astype(np.intp)


def _of_rest(whole: int, size: int, signals: tuple[Array, ...]) -> list[NDArray[np.intp]]:
    """Give the extremes of what is left behind the last whole stretch."""
    if whole == size:
        return []
    rests = [np.nan_to_num(each[whole:], posinf=0.0, neginf=0.0) for each in signals]
    return [whole + np.array([rest.argmin(), rest.argmax()]) for rest in rests]
