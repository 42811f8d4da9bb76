"""Which samples of a long record are drawn: as many as can be told apart in a figure."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Below it every sample is drawn.
_MOST = 50_000
# Samples all over a record, and stretches whose lowest and highest samples are drawn too: a panel
# is some 400 pixels wide.
_EVEN, _STRETCHES = 40_000, 2_500
_GOLDEN = 0.6180339887498949
# No two points nearer than this share of the range are told apart.
_CELLS = 2_000
_RUN, _RUNS = 4_000, 25


def drawn_samples(*signals: Array) -> NDArray[np.intp]:
    """Choose samples for points, and for lines over time: spread ones and extremes of each signal.

    Parameters
    ----------
    signals
        Of one length N.

    Returns
    -------
    numpy.ndarray
        Ascending indices; all where N is at most 50,000.

    Examples
    --------
    >>> signal = np.zeros(1_000_000)
    >>> signal[123_456] = 1.0
    >>> chosen = drawn_samples(signal)
    >>> chosen.size < 60_000, 123_456 in chosen
    (True, True)
    """
    count = signals[0].size
    if count <= _MOST:
        return np.arange(count)
    length = -(-count // _STRETCHES)
    whole = count // length * length
    # Each somewhere in its share of the record: even steps would fall in with periods.
    places = np.arange(_EVEN)
    even = (places + places * _GOLDEN % 1.0) * (count / _EVEN)
    chosen = [even.astype(np.intp), np.array([0, count - 1])]
    for signal in signals:
        rows, rest = signal[:whole].reshape(-1, length), signal[whole:]
        starts = np.arange(0, whole, length)
        chosen += [starts + rows.argmin(axis=1), starts + rows.argmax(axis=1)]
        if rest.size:
            chosen.append(whole + np.array([rest.argmin(), rest.argmax()]))
    return np.unique(np.concatenate(chosen))


def drawn_path(x: Array, y: Array) -> tuple[Array, Array]:
    """Choose points for a line that goes round loops, which chords between samples would cut.

    Samples in the same place as the one before are left out. What is still too long is drawn in
    runs of consecutive samples, with gaps between them: evenly spaced ones, and those with the
    extremes of x and y.

    Parameters
    ----------
    x, y
        Shape (N,).

    Returns
    -------
    x, y : numpy.ndarray
        NaN at gaps; all samples where N is at most 50,000.
    """
    if x.size <= _MOST:
        return x, y
    cells = _cells(x) * (_CELLS + 1) + _cells(y)
    kept = np.flatnonzero(np.diff(cells, prepend=-1))
    x, y = x[kept], y[kept]
    if x.size <= _MOST:
        return x, y
    runs = np.linspace(0, x.size - _RUN, _RUNS).astype(np.intp)
    around = np.array([x.argmin(), x.argmax(), y.argmin(), y.argmax()]) - _RUN // 2
    starts = np.unique(np.concatenate([runs, np.clip(around, 0, x.size - _RUN)]))
    gap = [np.nan]
    pieces = [(np.append(x[k : k + _RUN], gap), np.append(y[k : k + _RUN], gap)) for k in starts]
    return np.concatenate([a for a, _ in pieces]), np.concatenate([b for _, b in pieces])


def _cells(signal: Array) -> NDArray[np.intp]:
    """Give the places of samples within their range, in whole steps."""
    low, span = signal.min(), np.ptp(signal)
    return np.asarray((signal - low) * (_CELLS / span if span > 0.0 else 0.0), dtype=np.intp)
