"""Identification: from records to models that can be inverted."""

from __future__ import annotations

from hyst.identification.comparison.compare_models import compare
from hyst.identification.comparison.compared_model import ComparedModel
from hyst.identification.comparison.comparison import Comparison
from hyst.identification.families.registry import (
    chosen_families,
    families_in_reserve,
    names_of,
    require_taken,
)
from hyst.identification.forecast import (
    DriveForecast,
    ExpectedError,
    forecast_drive,
    sketched_plays,
    sketched_stage,
)
from hyst.identification.identify_records import identify
from hyst.identification.record_use.coded_input import in_volts, with_driver
from hyst.identification.record_use.part_of_a_sample import earlier, later
from hyst.identification.record_use.used_samples import UsedSamples
from hyst.identification.result.identified import Candidate, Identified
from hyst.identification.result.late_output import late_output
from hyst.identification.result.record_errors import RecordErrors
from hyst.identification.reversal_curve_fit import (
    ReversalCurveFit,
    identify_from_reversal_curves,
)
from hyst.identification.slopes import Slopes, identify_weights_from_slopes
from hyst.identification.stream.survey import part_of

__all__ = [
    "Candidate",
    "ComparedModel",
    "Comparison",
    "DriveForecast",
    "ExpectedError",
    "Identified",
    "RecordErrors",
    "ReversalCurveFit",
    "Slopes",
    "UsedSamples",
    "chosen_families",
    "compare",
    "earlier",
    "families_in_reserve",
    "forecast_drive",
    "identify",
    "identify_from_reversal_curves",
    "identify_weights_from_slopes",
    "in_volts",
    "late_output",
    "later",
    "names_of",
    "part_of",
    "require_taken",
    "sketched_plays",
    "sketched_stage",
    "with_driver",
]


def __dir__() -> list[str]:
    return __all__
