"""Where a command lies in the drive of a record that is longer, or began early or late."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_LEAST_SEEN = 0.002  # of the command's range: below it no shift of a drive is told
_CLEARER = 0.3  # a shift counts if it leaves less than this of the difference
_LEAST_SHARED = 0.75  # of the reference: what a record that is no longer must have of it


def place_of(drive: Array, command: Array) -> int:
    """Give the sample at which a drive, no shorter than a command, is most alike to it.

    Parameters
    ----------
    drive, command
        Shapes (M,) and (N,), M >= N, input units.

    Returns
    -------
    int
        0 to M - N.
    """
    apart = _apart(drive, command)
    n = command.size
    return int(np.argmin(apart[n - 1 : n + drive.size - n]))


def unlike(drive: Array, command: Array) -> float:
    """Give the root mean square of drive minus command, in shares of the command's range."""
    return math.sqrt(float(np.mean((drive - command) ** 2))) / _extent(command)


def alike(drive: Array, command: Array) -> float:
    """Give the correlation of drive and command; 1 for a command at rest, which says nothing."""
    d, c = drive - drive.mean(), command - command.mean()
    of_command = float(c @ c)
    if of_command == 0.0:
        return 1.0
    of_drive = float(d @ d)
    return float(d @ c) / math.sqrt(of_drive * of_command) if of_drive > 0.0 else 0.0


def shift_of(drive: Array, command: Array, periodic: bool) -> int:
    """Give by how many samples a drive is later than the command of the same length; 0 if not.

    Parameters
    ----------
    drive, command
        Shape (N,) each.
    periodic
        Whether what leaves at one end comes in at the other.

    Returns
    -------
    int
        Above 0: the record began before the motion.
    """
    here, n = unlike(drive, command), command.size
    if here < _LEAST_SEEN:
        return 0
    if periodic:
        start = place_of(np.concatenate([drive, drive[:-1]]), command)
        if unlike(np.roll(drive, -start), command) > _CLEARER * here:
            return 0
        return start if start <= n // 2 else start - n
    shared = n - np.abs(np.arange(1 - n, n))
    apart = np.where(shared >= _LEAST_SHARED * n, _apart(drive, command), np.inf)
    shift = int(np.argmin(apart)) - (n - 1)
    return shift if math.sqrt(float(apart.min())) < _CLEARER * here * _extent(command) else 0


def _apart(drive: Array, command: Array) -> Array:
    """Mean square of drive[s:] - command over what both have, for s = 1 - N to M - 1."""
    m, n = drive.size, command.size
    centre = float(command.mean())  # a mean far above the range would cost digits
    d, c = drive - centre, command - centre
    length = 1 << (m + n).bit_length()
    product = np.fft.rfft(d, length) * np.fft.rfft(c[::-1], length)
    both = np.fft.irfft(product, length)[: m + n - 1]
    s = np.arange(1 - n, m)
    first, beyond = np.maximum(s, 0), np.minimum(s + n, m)
    squares_d = np.concatenate([[0.0], np.cumsum(d**2)])
    squares_c = np.concatenate([[0.0], np.cumsum(c**2)])
    of_drive = squares_d[beyond] - squares_d[first]
    of_command = squares_c[beyond - s] - squares_c[first - s]
    apart: Array = np.maximum(of_drive + of_command - 2.0 * both, 0.0) / (beyond - first)
    return apart


def _extent(command: Array) -> float:
    return float(np.ptp(command)) or float(np.abs(command).max()) or 1.0
