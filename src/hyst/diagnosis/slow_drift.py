"""How an output drifts, seen where drive and memory come back to what they were."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.special
from numpy.polynomial import legendre
from numpy.typing import ArrayLike, NDArray

from hyst.diagnosis.repetition import Repetition, changes, repetition_of
from hyst.signals import Record

Array = NDArray[np.float64]

BLOCKS = 4
"""Of every repetition: noise that lasts longer than a sample is averaged within a block."""

CHANCE = 1e-4
"""How often noise alone may pass for drift."""

NEGLIGIBLE = 1e-4
"""Of the output's range: less drift than this is none."""

TINY = float(np.finfo(float).tiny)

MOST_CLIPPED = 4.0
"""Robust standard deviations beyond which a block is pulled in."""


@dataclass(frozen=True, eq=False)
class Drift:
    """What an output does over time beside following its input.

    Parameters
    ----------
    curve
        Shape (N,), output units, 0 at the first sample.
    total
        Its range over the record, output units.
    rate
        Its mean slope, output units per second.
    standard_error
        Of ``total``.
    degree
        Of the polynomial in time.
    """

    curve: Array
    total: float
    rate: float
    standard_error: float
    degree: int


def slow_drift(record: Record, found: Repetition | None = None) -> Drift | None:
    """Find what changes slowly in an output though drive and memory come back.

    The change of y since drive and memory were the same is the change of a polynomial in time; its
    degree grows with how often they come back. No model of the hysteresis is needed.

    Parameters
    ----------
    record
        Any record.
    found
        Where it repeats, if that is known already.

    Returns
    -------
    Drift or None
        None where nothing repeats, or where what changes is no more than noise.
    """
    repeats = repetition_of(record.u) if found is None else found
    if repeats is None:
        return None
    rows, moved = _block_means(record, repeats)
    degree = _degree(record, repeats)
    if moved.size < degree + 3:
        return None
    moved = _pulled_in(rows[:, :degree], moved)
    weights = np.linalg.lstsq(rows[:, :degree], moved, rcond=None)[0]
    residual = moved - rows[:, :degree] @ weights
    freedom = moved.size - degree
    variance = float(residual @ residual) / freedom
    explained = float(moved @ moved - residual @ residual) / degree
    curve = _polynomials(np.arange(len(record)), len(record), degree) @ weights
    total = float(np.ptp(curve))
    span = float(np.ptp(record.y))
    if (
        scipy.special.fdtrc(degree, freedom, explained / max(variance, TINY)) > CHANCE
        or total <= NEGLIGIBLE * span
    ):
        return None
    inverse = np.linalg.pinv(rows[:, :degree].T @ rows[:, :degree])
    ends = np.ptp(_polynomials(np.arange(len(record)), len(record), degree), axis=0)
    error = float(np.sqrt(variance * (ends @ inverse @ ends)))
    rate = float(curve[-1] - curve[0]) / record.duration
    return Drift(curve - curve[0], total, rate, error, degree)


def _degree(record: Record, repeats: Repetition) -> int:
    lag = float(np.median([lag for _, _, lag in repeats.segments]))
    times = len(record) / lag
    return 1 if times < 4.0 else 2 if times < 8.0 else 3 if times < 16.0 else 4


def _block_means(record: Record, repeats: Repetition) -> tuple[Array, Array]:
    """Give mean changes over blocks, of the polynomials and of y without what the drive did."""
    rows, moved, drives = [], [], []
    for start, stop, lag in repeats.segments:
        change_u, change_y, _ = changes(record, start, stop, lag)
        times = np.arange(start, stop)
        now, before = (_polynomials(at, len(record), 4) for at in (times, times - lag))
        count = max(int(BLOCKS * (stop - start) / lag), 1)
        for block in np.array_split(np.arange(stop - start), min(count, stop - start)):
            rows.append((now - before)[block].mean(axis=0))
            moved.append(float(change_y[block].mean()))
            drives.append(float(change_u[block].mean()))
    matrix, output, drive = np.array(rows), np.array(moved), np.array(drives)
    energy = float(drive @ drive)
    if energy > 0.0:
        # What the drive itself did not repeat; only where it is no drift of the drive.
        spread = drive - drive.mean()
        size = float(spread @ spread)
        if size > 0.5 * energy:
            output = output - float(spread @ output) / size * drive
    return matrix, output


def _polynomials(at: ArrayLike, samples: int, degree: int) -> Array:
    """Give Legendre polynomials of degree 1 and more over the record, shape (times, degree)."""
    t = 2.0 * np.asarray(at, dtype=np.float64) / max(samples - 1, 1) - 1.0
    return np.asarray(legendre.legvander(t, degree)[:, 1:])


def _pulled_in(rows: Array, moved: Array) -> Array:
    """Clip what lies far from the fit, so that a few bad samples make no drift."""
    weights = np.linalg.lstsq(rows, moved, rcond=None)[0]
    fitted = rows @ weights
    residual = moved - fitted
    limit = MOST_CLIPPED * 1.4826 * float(np.median(np.abs(residual)))
    return np.asarray(fitted + np.clip(residual, -limit, limit)) if limit > 0.0 else moved
