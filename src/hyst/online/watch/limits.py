"""What an alarm of the watch is raised for."""

from __future__ import annotations

from dataclasses import dataclass

from hyst.checks.numbers import as_positive
from hyst.online.alarms import AlarmRule

MODEL_ERROR, ESTIMATE_ERROR, DRIFT = "model error", "estimate error", "drift"
NOT_DETERMINED, NOTHING_LEARNT, MEMORY_UNKNOWN = (
    "not determined",
    "nothing learnt",
    "memory unknown",
)
SAMPLES_LOST, UNREADABLE, NO_NUMBER = "samples lost", "unreadable lines", "no number"
CLOCK, SAMPLE_TIME, INPUT_RANGE = "clock", "sample time", "input range"
STUCK, SATURATED, OVERFLOW, SILENT = "output stuck", "output saturated", "overflow", "no data"

# Values of levels are given over what is allowed, those of counts are counts.
RULES = (
    AlarmRule(MODEL_ERROR, 1.0, 0.75, starts_after=2, ends_after=3),
    AlarmRule(ESTIMATE_ERROR, 1.0, 0.75, starts_after=2, ends_after=3),
    AlarmRule(DRIFT, 1.0, 0.75, starts_after=3, ends_after=3),
    AlarmRule(NOT_DETERMINED, 1.0, 0.0, starts_after=2),
    AlarmRule(NOTHING_LEARNT, 1.0, 0.0, starts_after=10),
    AlarmRule(MEMORY_UNKNOWN, 1.0, 0.0, starts_after=2, ends_after=1),
    AlarmRule(SAMPLES_LOST, 1.0, 0.0, ends_after=5),
    AlarmRule(UNREADABLE, 1.0, 0.0, ends_after=5),
    AlarmRule(NO_NUMBER, 1.0, 0.0, ends_after=5),
    AlarmRule(CLOCK, 1.0, 0.0, ends_after=5),
    AlarmRule(SAMPLE_TIME, 1.0, 0.75, starts_after=2, ends_after=2),
    AlarmRule(INPUT_RANGE, 1.0, 0.5, ends_after=3),
    AlarmRule(STUCK, 1.0, 0.5, ends_after=2),
    AlarmRule(SATURATED, 1.0, 0.5, ends_after=5),
    AlarmRule(OVERFLOW, 1.0, 0.0, ends_after=5),
    AlarmRule(SILENT, 1.0, 0.5),
)


@dataclass(frozen=True)
class Limits:
    """What is too much.

    Parameters
    ----------
    error
        Largest root mean square of the error of prediction over a window, output units. None: twice
        what the model states, or where it states nothing, twice the median of the first 10 windows.
    drift
        Largest difference between the predictions of the estimate and of the model, root mean
        square over a window, as a share of the model's output range.
    step
        Largest deviation of the sample time, as a share of it.

    Raises
    ------
    InputError
        If one is not above 0.

    Examples
    --------
    >>> Limits(error=0.05).drift
    0.02
    """

    error: float | None = None
    drift: float = 0.02
    step: float = 0.02

    def __post_init__(self) -> None:
        if self.error is not None:
            as_positive(self.error, "tolerance", "output units")
        as_positive(self.drift, "drift", "a share of the output's range")
        as_positive(self.step, "step", "a share of the sample time")
