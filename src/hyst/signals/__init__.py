"""Records, their turning points and their metrics."""

from __future__ import annotations

from hyst.signals.loop_metrics import hysteresis_percent, loop_area
from hyst.signals.metrics import Metrics, error_metrics
from hyst.signals.noise import estimate_noise, suggest_dead_band
from hyst.signals.record import Record
from hyst.signals.reversals import reversals

__all__ = [
    "Metrics",
    "Record",
    "error_metrics",
    "estimate_noise",
    "hysteresis_percent",
    "loop_area",
    "reversals",
    "suggest_dead_band",
]
