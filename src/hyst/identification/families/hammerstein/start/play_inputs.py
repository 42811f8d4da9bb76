"""The drive as plays on a grid of radii: inputs of one linear system, for any hysteresis before it.

Plays span the Prandtl-Ishlinskii operators, and come near to any hysteresis without jumps. With
them as inputs the dynamics behind are linear in all that is unknown but their poles.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.identification.record_use.used_samples import Data

Array = NDArray[np.float64]

MOST_ROWS = 120_000
"""Samples that a start is looked for in, in stretches spread over longer records."""

STRETCHES = 4

_WIDEST, _NARROWEST, _FARTHEST = 0.9, 0.03, 0.95  # of half the range of the drive
_GEOMETRIC, _EVEN = 8, 16
_TAPS = 16  # of the low pass, for each sample kept
_EDGE = 0.9  # of half the new sample rate
_TRIMMED = 9  # samples at each end of a decimated stretch, which the low pass has not filled


@dataclass(frozen=True, eq=False)
class Piece:
    """A stretch of a record: what is known of it, sample by sample.

    Parameters
    ----------
    inputs
        Shape (n, m): what may drive the dynamics, counted from its first sample.
    output
        Shape (n,), the measured output.
    first
        The first sample that is compared; of the samples before it the memory is not known.
    """

    inputs: Array
    output: Array
    first: int

    def thinned(self) -> Piece:
        """Give every other input, the drive itself first: enough for poles."""
        return Piece(self.inputs[:, ::2], self.output, self.first)

    def decimated(self, factor: int) -> Piece:
        """Give every so-many-th sample behind a low pass without phase.

        Parameters
        ----------
        factor
            1 gives the piece itself.
        """
        import scipy.signal  # slow, and only dynamics need it

        if factor == 1:
            return self
        lowpass = scipy.signal.firwin(_TAPS * factor + 1, _EDGE / factor)
        both = np.column_stack([self.output, self.inputs])
        both = both - both[0]
        kept = scipy.signal.resample_poly(both, 1, factor, axis=0, window=lowpass)
        kept = kept[_TRIMMED:-_TRIMMED]
        first = max(-(-self.first // factor) - _TRIMMED, 0)
        return Piece(np.ascontiguousarray(kept[:, 1:]), kept[:, 0].copy(), first)


def grids_of(half_range: float) -> tuple[Array, Array]:
    """Give two grids of radii up to nearly half the range of the drive: geometric, and even.

    The first sees small radii, the second a hysteresis that stiffens towards the ends.

    Parameters
    ----------
    half_range
        Of the drive, input units.
    """
    geometric = half_range * np.geomspace(_NARROWEST, _WIDEST, _GEOMETRIC)
    even = half_range * np.linspace(0.0, _FARTHEST, _EVEN + 1)[1:]
    return np.asarray(geometric), np.asarray(even)


def play_columns(u: Array, radii: Array) -> Array:
    """Give a drive and its plays, shape (samples, m).

    Parameters
    ----------
    u
        From rest at 0.
    radii
        Shape (m - 1,), input units.
    """
    bank = np.empty((u.size, radii.size))
    _engine.play_outputs(radii.tolist(), np.zeros(radii.size), np.ascontiguousarray(u), bank)
    return np.column_stack([u, bank])


def pieces_of(
    data: Data, columns: Callable[[Array], Array], most_rows: int = MOST_ROWS
) -> list[Piece]:
    """Give the records, or stretches spread over long ones, with what may drive the dynamics.

    Parameters
    ----------
    data
        The records.
    columns
        Gives it of a drive from rest, as its plays.
    most_rows
        Samples in all.
    """
    most = max(most_rows // len(data.records), 1000)
    pieces = []
    for record, window, output in zip(
        data.records, data.windows(), data.brought_forward(), strict=True
    ):
        inputs = columns(record.u[: window.stop])
        for begin, end in stretches(window.start, window.stop, most):
            rows = slice(begin, end)
            pieces.append(
                Piece(
                    inputs[rows] - inputs[begin],
                    output[rows] - output[begin],
                    max(window.start - begin, 0),
                )
            )
    return pieces


def stretches(start: int, stop: int, most: int) -> Sequence[tuple[int, int]]:
    """Give what of a record is looked at: all, or stretches spread evenly over it.

    Parameters
    ----------
    start, stop
        Samples in use.
    most
        Samples that may be looked at.
    """
    if stop - start <= most:
        return [(0, stop)]
    length = most // STRETCHES
    begins = np.linspace(start, stop - length, STRETCHES).astype(int)
    return [(int(each), int(each) + length) for each in begins]


def bandwidth(pieces: Sequence[Piece]) -> float:
    """Give the frequency below which all but a thousandth of the output's power lies, above noise.

    Parameters
    ----------
    pieces
        Of records of one sample time.

    Returns
    -------
    float
        Share of half the sample rate.
    """
    import scipy.signal  # slow, and only dynamics need it

    power = np.zeros(513)
    for each in pieces:
        y = each.output[each.first :]
        length = min(1024, y.size)
        _, density = scipy.signal.welch(y - y.mean(), nperseg=length, nfft=1024)
        power += density * y.size
    power = np.maximum(power - 2.0 * np.median(power[-128:]), 0.0)
    total = np.cumsum(power)
    return float(np.searchsorted(total, 0.999 * total[-1]) + 1) / power.size
