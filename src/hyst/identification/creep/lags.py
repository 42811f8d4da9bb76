"""What lags answer to a signal, over the samples of records that are in use."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.family import Fit
from hyst.identification.record_use.used_samples import Data
from hyst.models import LinearDynamics
from hyst.operators import Affine, Composition
from hyst.signals import Record, reversals

Array = NDArray[np.float64]

PER_DECADE = 3
"""Time constants of the grid."""

FEWEST_SAMPLES, OF_A_STROKE = 10.0, 0.125
"""Of a time constant: a lag that is faster beside the strokes is hardly told from a delay."""

SMALLEST_TURN, STILL = 0.05, 0.02
"""Of the input's range, and of its largest change from sample to sample: less is a hold."""


def grid_of(data: Data) -> Array:
    """Give time constants from a few samples to the longest record, evenly spread in decades.

    Parameters
    ----------
    data
        The records.
    """
    fastest, slowest = bounds_of(data)
    count = max(math.ceil(PER_DECADE * math.log10(max(slowest / fastest, 1.0))), 1) + 1
    return np.asarray(np.geomspace(fastest, slowest, count))


def bounds_of(data: Data) -> tuple[float, float]:
    """Give the shortest and the longest time constant that records can show, s.

    Parameters
    ----------
    data
        The records.
    """
    slowest = max(record.duration for record in data.records)
    fastest = min(
        max(FEWEST_SAMPLES * record.dt, OF_A_STROKE * _stroke(record)) for record in data.records
    )
    return min(fastest, 0.5 * slowest), slowest


def _stroke(record: Record) -> float:
    """Give the mean time from one turn of the input to the next, holds left out, s."""
    turns = reversals(record.u, SMALLEST_TURN * float(np.ptp(record.u)))
    steps = np.abs(np.diff(record.u))
    moving = np.count_nonzero(steps > STILL * float(steps.max()))
    return record.dt * moving / (turns.size + 1)


def signals_that_creep(data: Data, fit: Fit, *, whole: bool = False) -> list[Array]:
    """Give for each record what would creep: the model's output without its offset.

    Parameters
    ----------
    data
        The records.
    fit
        Of a model without creep, in their units.
    whole
        To the end of the record, and not only to that of its window.
    """
    operator = fit.operator
    last = operator.parts[-1] if isinstance(operator, Composition) else operator
    offset = last.offset if isinstance(last, Affine) else 0.0
    return [
        operator.at_sample_time(record.dt)(record.u[: None if whole else window.stop]) - offset
        for record, window in zip(data.records, data.windows(), strict=True)
    ]


def answers(data: Data, signals: Sequence[Array], tau: Array) -> list[Array]:
    """Give what lags that start at 0 answer, for each record shape (samples, lags).

    ``x_{k+1} = x_k + (1 - exp(-dt / tau)) (u_k - x_k)``: their step response, sampled.

    Parameters
    ----------
    data
        The records.
    signals
        Of each record, shape (samples,).
    tau
        Time constants, s.
    """
    found = []
    for record, signal in zip(data.records, signals, strict=True):
        kept = np.exp(-record.dt / tau)
        # By the engine: scipy.signal takes half a second to load.
        columns = [
            LinearDynamics([[each]], [1.0 - each], [1.0], 0.0, record.dt)(signal) for each in kept
        ]
        found.append(np.column_stack(columns) if columns else np.zeros((signal.size, 0)))
    return found


def in_use(data: Data, over_records: Sequence[Array]) -> Array:
    """Put what there is for whole records into one array over the samples in use.

    Parameters
    ----------
    data
        The records.
    over_records
        For each, shape (samples up to the end of its window, ...).
    """
    pairs = zip(over_records, data.windows(), strict=True)
    return data.joined([each[window] for each, window in pairs])
