"""What a drive will determine of a stated model, before anyone runs it."""

from __future__ import annotations

from hyst.identification.forecast.drive_forecast import DriveForecast, ExpectedError
from hyst.identification.forecast.expected_errors import forecast_drive
from hyst.identification.forecast.stage_sketch import sketched_plays, sketched_stage

__all__ = ["DriveForecast", "ExpectedError", "forecast_drive", "sketched_plays", "sketched_stage"]


def __dir__() -> list[str]:
    return __all__
