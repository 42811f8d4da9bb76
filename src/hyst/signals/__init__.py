"""Records, their turning points and their metrics."""

from __future__ import annotations

from hyst.signals.drive import Drive, Limits
from hyst.signals.drive_design import design
from hyst.signals.excitation_order import Persistence, persistence
from hyst.signals.first_order_curves import (
    ForcDensity,
    ReversalCurve,
    forc_density,
    reversal_curves,
)
from hyst.signals.held_levels import levels
from hyst.signals.loop_metrics import hysteresis_percent, loop_area
from hyst.signals.measured_response import MeasuredResponse
from hyst.signals.metrics import Metrics, error_metrics
from hyst.signals.multisines import multisine
from hyst.signals.noise import estimate_noise, suggest_dead_band
from hyst.signals.noise_drive import lowpassed_noise
from hyst.signals.record import Record
from hyst.signals.record_stream import RecordStream
from hyst.signals.rest import from_rest
from hyst.signals.sequences import decaying_triangle, forc, prbs, staircase, triangle
from hyst.signals.swept_sines import swept_sine
from hyst.signals.turning_points import reversals
from hyst.signals.units import units_differ

__all__ = [
    "Drive",
    "ForcDensity",
    "Limits",
    "MeasuredResponse",
    "Metrics",
    "Persistence",
    "Record",
    "RecordStream",
    "ReversalCurve",
    "decaying_triangle",
    "design",
    "error_metrics",
    "estimate_noise",
    "forc",
    "forc_density",
    "from_rest",
    "hysteresis_percent",
    "levels",
    "loop_area",
    "lowpassed_noise",
    "multisine",
    "persistence",
    "prbs",
    "reversal_curves",
    "reversals",
    "staircase",
    "suggest_dead_band",
    "swept_sine",
    "triangle",
    "units_differ",
]


def __dir__() -> list[str]:
    return __all__
