"""How an output drifts, seen where drive and memory come back to what they were."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import scipy.special
from numpy.polynomial import legendre
from numpy.typing import ArrayLike, NDArray

from hyst.diagnosis.repetition import Repetition, changes, repetition_of
from hyst.signals import Record, estimate_noise

Array = NDArray[np.float64]

BLOCKS = 8
"""Of every repetition: noise that lasts longer than a sample is averaged within a block."""

MOST_BLOCKS = 4000
"""Of a record: of a long one blocks are longer."""

MOST_DEGREE = 4

CHANCE = 1e-4
"""How often noise alone may pass for drift."""

NEGLIGIBLE = 1e-4
"""Of the output's range: less drift than this is none."""

TINY = float(np.finfo(float).tiny)

SURE = 4.0
"""Standard errors that a drift must exceed."""

SAME_DRIVE, NOISE_ALLOWED = 2e-3, 2.0
"""By how much a drive that comes back may differ, rms: of its range, and times its noise."""

LEAST_SEEN = 0.5
"""Of a record: what drifts in less of it is not known for the rest."""

MOST_DRIVEN = 0.5
"""Of a drift: where the drive itself moves by more, in ranges, its change may be what is seen."""

LARGEST_GAIN = 10.0
"""Of slow changes, in ratios of the ranges: a low pass lets them through and the rest less."""

PARALLEL = 0.9
"""Correlation of two curves of degree 3 or more from which the one is that of the other."""

MOST_CLIPPED = 4.0
"""Robust standard deviations beyond which a block is pulled in."""


@dataclass(frozen=True, eq=False)
class Drift:
    """What an output does over time beside following its input.

    Parameters
    ----------
    curve
        Shape (N,), output units, of mean 0: a model is right on the average over its record.
    total
        Its range over the record, output units, negative where it ends lower than it begins.
    rate
        Its mean slope, output units per second.
    standard_error
        Of ``total``.
    early, late
        Mean slopes of the first and of the second half, output units per second.
    degree
        Of the polynomial in time.
    """

    curve: Array
    total: float
    rate: float
    standard_error: float
    early: float
    late: float
    degree: int

    @property
    def curved(self) -> bool:
        """Whether the halves differ by more than half of the larger slope."""
        return abs(self.early - self.late) > 0.5 * max(abs(self.early), abs(self.late))


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
    repeats = None if repeats is None else _really_repeated(record, repeats)
    if repeats is None:
        return None
    rows, moved, driven = _block_means(record, repeats)
    degree = _degree(record, repeats)
    if moved.size < degree + 2 or _seen(repeats) < LEAST_SEEN * len(record):
        return None
    moved = _pulled_in(rows[:, :degree], moved)
    weights = np.linalg.lstsq(rows[:, :degree], moved, rcond=None)[0]
    residual = moved - rows[:, :degree] @ weights
    freedom = moved.size - degree
    variance = float(residual @ residual) / freedom
    explained = float(moved @ moved - residual @ residual) / degree
    polynomials = _polynomials(np.arange(len(record)), len(record), degree)
    curve = polynomials @ weights
    total = float(np.ptp(curve))
    span = float(np.ptp(record.y))
    if (
        scipy.special.fdtrc(degree, freedom, explained / max(variance, TINY)) > CHANCE
        or total <= NEGLIGIBLE * span
    ):
        return None
    inverse = np.linalg.pinv(rows[:, :degree].T @ rows[:, :degree])
    between = polynomials[int(curve.argmax())] - polynomials[int(curve.argmin())]
    error = float(np.sqrt(variance * (between @ inverse @ between)))
    by_drive = polynomials @ np.linalg.lstsq(rows[:, :degree], driven, rcond=None)[0]
    if total < SURE * error or _is_driven(curve, by_drive, degree):
        return None
    first, middle, last = (float(curve[k]) for k in (0, len(record) // 2, -1))
    half = 0.5 * record.duration
    early, late = (middle - first) / half, (last - middle) / half
    total = math.copysign(total, last - first)
    return Drift(curve - curve.mean(), total, 0.5 * (early + late), error, early, late, degree)


def _is_driven(curve: Array, by_drive: Array, degree: int) -> bool:
    """Tell whether an output drifts because its drive does, by the ratio of ranges or far more."""
    size = float(np.ptp(by_drive)) / float(np.ptp(curve))
    if size > MOST_DRIVEN or size < MOST_DRIVEN / LARGEST_GAIN or degree < 3:
        return size > MOST_DRIVEN
    return bool(abs(np.corrcoef(curve, by_drive)[0, 1]) > PARALLEL)


def _really_repeated(record: Record, repeats: Repetition) -> Repetition | None:
    """Keep where the drive comes back as exactly as it can; None if it nowhere does.

    Of a drive whose amplitude changes slowly the mean of the output does, too, through any map.
    """
    noise = math.sqrt(2.0) * estimate_noise(record.u)
    allowed = max(NOISE_ALLOWED * noise, SAME_DRIVE * float(np.ptp(record.u)))
    segments = tuple(
        each
        for each in repeats.segments
        if math.sqrt(float(np.mean(np.square(changes(record, *each)[0])))) <= allowed
    )
    return replace(repeats, segments=segments) if segments else None


def _seen(repeats: Repetition) -> float:
    """Give over how many samples, from first to last, the output is compared with itself."""
    first = min(start - lag for start, _, lag in repeats.segments)
    return max(stop for _, stop, _ in repeats.segments) - first


def _degree(record: Record, repeats: Repetition) -> int:
    lag = float(np.median([lag for _, _, lag in repeats.segments]))
    times = len(record) / lag
    return 1 if times < 4.0 else 2 if times < 8.0 else 3 if times < 16.0 else MOST_DEGREE


def _block_means(record: Record, repeats: Repetition) -> tuple[Array, Array, Array]:
    """Give mean changes over blocks: of the polynomials, of y without what the drive did, and of u.

    The last in the output's unit by the ratio of the ranges: of a drive that is only nearly the
    same after a lag, an output with dynamics follows the change by more than by its mean gain.
    """
    gain, ratio = _slope(record), float(np.ptp(record.y)) / max(float(np.ptp(record.u)), TINY)
    share = MOST_BLOCKS / sum(stop - start for start, stop, _ in repeats.segments)
    rows, moved, driven = [], [], []
    for start, stop, lag in repeats.segments:
        change_u, change_y, _ = changes(record, start, stop, lag)
        samples = stop - start
        count = max(int(min(BLOCKS * samples / lag, share * samples)), 1)
        edges = np.arange(min(count, samples) + 1) * samples // min(count, samples)
        of_u, of_y = (
            np.add.reduceat(each, edges[:-1]) / np.diff(edges) for each in (change_u, change_y)
        )
        middle = start + 0.5 * (edges[:-1] + edges[1:] - 1)
        now, before = (_polynomials(at, len(record), MOST_DEGREE) for at in (middle, middle - lag))
        rows.append(now - before)
        # What the drive itself moved on is no drift.
        moved.append(of_y - gain * of_u)
        driven.append(ratio * of_u)
    return np.concatenate(rows), np.concatenate(moved), np.concatenate(driven)


def _slope(record: Record) -> float:
    u, y = record.u - record.u.mean(), record.y - record.y.mean()
    energy = float(u @ u)
    return float(u @ y) / energy if energy > 0.0 else 0.0


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
