"""What a watch says now and then, in a line of text or of JSON."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.online.alarms import AlarmEvent
from hyst.online.watch.watcher import Window

Array = NDArray[np.float64]

_SHOWN = 4


@dataclass(frozen=True, eq=False)
class Report:
    """Some windows together.

    Parameters
    ----------
    window
        The last of them.
    error, model_error
        Root mean square over all of them, output units; NaN where nothing is known.
    allowed
        Error from which on there is an alarm; NaN while it is not known.
    """

    window: Window
    error: float
    model_error: float
    allowed: float


def report_of(windows: Sequence[Window], allowed: float) -> Report:
    """Put windows together.

    Parameters
    ----------
    windows
        At least one.
    allowed
        Error from which on there is an alarm, output units; 0 while it is not known.
    """
    error = _together([each.error for each in windows])
    model_error = _together([each.model_error for each in windows])
    return Report(windows[-1], error, model_error, allowed or math.nan)


def line_of(report: Report, unit: str) -> str:
    """Give a report as a line for people."""
    last = report.window
    after = f" {unit}" if unit else ""
    allowed = "" if math.isnan(report.allowed) else f", allowed {_number(report.allowed)}"
    errors = (
        f"error {_said(report.error)}{after} (model {_said(report.model_error)}{allowed}), "
        f"noise {_number(last.noise)}"
    )
    learnt = f"learning paused: {last.paused}" if last.paused else _bands(last)
    told = last.knowledge.sentences if last.has_bands else ()
    doubts = [last.innovation, *told][last.is_consistent :]
    verdict = "" if last.paused or not doubts else "; " + doubts[0]
    alarms = f"; alarms: {', '.join(last.active)}" if last.active else ""
    return f"{last.time:10.6g} s  {errors}; {learnt}{verdict}{alarms}"


def json_of(report: Report) -> str:
    """Give a report as a line of JSON; what is not known is null."""
    last = report.window
    known = last.knowledge
    estimates = {
        name: {"value": float(value), "low": _plain(low), "high": _plain(high), "known": bool(sure)}
        for name, value, low, high, sure in zip(
            known.names, last.parameters, *bands_of(last), strict=True
        )
    }
    return _as_json(
        {
            "time": last.time,
            "error": _plain(report.error),
            "model_error": _plain(report.model_error),
            "allowed_error": _plain(report.allowed),
            "noise": _plain(last.noise),
            "as_noise": last.is_consistent,
            "estimate": estimates,
            "paused": last.paused or None,
            "alarms": list(last.active),
            "counts": last.counts,
        }
    )


def json_of_event(event: AlarmEvent) -> str:
    """Give the start or end of an alarm as a line of JSON."""
    return _as_json(
        {
            "time": event.time,
            "alarm": event.name,
            "event": "start" if event.starts else "end",
            "value": _plain(event.value),
            "sentence": event.sentence,
        }
    )


def line_of_event(event: AlarmEvent) -> str:
    """Give the start or end of an alarm as a line for people."""
    return f"{event.time:10.6g} s  {event}"


def bands_of(window: Window) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Give low and high ends and what is determined; nothing where bands are of another time."""
    known = window.knowledge
    if window.has_bands:
        return known.low, known.high, known.determined
    none = np.full(len(known.names), np.nan)
    return none, none, np.zeros(none.size, dtype=np.bool_)


def _bands(window: Window) -> str:
    """Give the first estimates with half their bands."""
    unknown = " (not determined)" if window.has_bands else " (band not asked for)"
    said = [
        f"{name} {_number(value)}" + (_band(value, low, high) if sure else unknown)
        for name, value, low, high, sure in zip(
            window.knowledge.names, window.parameters, *bands_of(window), strict=True
        )
    ]
    more = len(said) - _SHOWN
    return ", ".join(said[:_SHOWN]) + (f" and {more} more" if more > 0 else "")


def _band(value: float, low: float, high: float) -> str:
    """Give half a band after a value in it, or else the band: a better fit than the value's."""
    if low <= value <= high:
        return f" +- {_number((high - low) / 2.0)}"
    return f" (outside its band, {_number(low)} to {_number(high)})"


def _said(value: float) -> str:
    return "unknown" if math.isnan(value) else _number(value)


def _number(value: float) -> str:
    return f"{value:.4g}"


def _together(values: list[float]) -> float:
    known = [value**2 for value in values if not math.isnan(value)]
    return math.sqrt(sum(known) / len(known)) if known else math.nan


def _plain(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _as_json(content: dict[str, Any]) -> str:
    return json.dumps(content, allow_nan=False)
