"""Sines in an output that are none of its drive, measured beside a loop of any shape."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.signals import Record

Array = NDArray[np.float64]

PLAYS = 25
KNOTS = 7
MOST_ROWS = 20_000


def foreign_sines(record: Record, frequencies: Sequence[float]) -> Array:
    """Give the sines of some frequencies in an output, which no hysteresis accounts for.

    They are fitted together with plays and bends of the input, so that a sine which stands still
    against its drive, as mains hum against a drive of 2 Hz, is not taken for part of the loop, nor
    a harmonic of the loop for part of the sine.

    Parameters
    ----------
    record
        Without slow drift.
    frequencies
        Hz, one or more.

    Returns
    -------
    numpy.ndarray
        Shape (N,), output units, of mean 0 over whole periods.
    """
    waves = _waves(record, frequencies)
    general = _general(record.u)
    rows = slice(None, None, 1 + len(record) // MOST_ROWS)
    columns = np.column_stack([waves, general, np.ones(len(record))])[rows]
    size = np.linalg.norm(columns, axis=0)
    weights = np.linalg.lstsq(columns / size, record.y[rows], rcond=1e-9)[0] / size
    return np.asarray(waves @ weights[: waves.shape[1]])


def _waves(record: Record, frequencies: Sequence[float]) -> Array:
    angles = 2.0 * np.pi * np.outer(record.time, frequencies)
    return np.concatenate([np.cos(angles), np.sin(angles)], axis=1)


def _general(u: Array) -> Array:
    """Give input, plays and bends of the input, shape (N, 1 + PLAYS + KNOTS), none constant."""
    low, high = float(u.min()), float(u.max())
    radii = 0.5 * (high - low) * np.arange(1, PLAYS + 1) / (PLAYS + 1)
    z = np.empty((u.size, PLAYS))
    _engine.play_outputs(radii.tolist(), np.full(PLAYS, u[0]), u, z)
    knots = np.linspace(low, high, KNOTS + 2)[1:-1]
    bends = np.maximum(u[:, None] - knots, 0.0)
    columns = np.column_stack([u, z, bends])
    columns = columns - columns.mean(axis=0)
    return np.asarray(columns[:, np.ptp(columns, axis=0) > 0.0])
