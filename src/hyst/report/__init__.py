"""Reports: tables, figures and a page of HTML that explain what was found.

The names are loaded when first used, because figures need matplotlib and tables do not.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from hyst.report.closed_loop_figure import draw_closed_loops
    from hyst.report.distortion_section import distortion_sections
    from hyst.report.drive_figure import draw_drive
    from hyst.report.drive_summary import drive_table
    from hyst.report.dynamics_figures import dynamics_sections
    from hyst.report.estimation_figure import draw_estimates
    from hyst.report.identification_report import Section, write_report
    from hyst.report.observer_answer import ObserverAnswer
    from hyst.report.observer_figures import draw_observer_bode
    from hyst.report.tables import (
        Table,
        candidates_table,
        compensation_table,
        constants_table,
        description_table,
        metrics_table,
        number,
        parameters_table,
        traits_table,
    )
    from hyst.report.tracking_figure import draw_tracking
    from hyst.report.words import delay_sentence, in_short, invertible_sentence

_HOME = {
    "ObserverAnswer": "observer_answer",
    "Section": "identification_report",
    "Table": "tables",
    "candidates_table": "tables",
    "compensation_table": "tables",
    "constants_table": "tables",
    "delay_sentence": "words",
    "description_table": "tables",
    "distortion_sections": "distortion_section",
    "draw_closed_loops": "closed_loop_figure",
    "draw_drive": "drive_figure",
    "draw_estimates": "estimation_figure",
    "draw_observer_bode": "observer_figures",
    "draw_tracking": "tracking_figure",
    "drive_table": "drive_summary",
    "dynamics_sections": "dynamics_figures",
    "in_short": "words",
    "invertible_sentence": "words",
    "metrics_table": "tables",
    "number": "tables",
    "parameters_table": "tables",
    "traits_table": "tables",
    "write_report": "identification_report",
}

__all__ = [
    "ObserverAnswer",
    "Section",
    "Table",
    "candidates_table",
    "compensation_table",
    "constants_table",
    "delay_sentence",
    "description_table",
    "distortion_sections",
    "draw_closed_loops",
    "draw_drive",
    "draw_estimates",
    "draw_observer_bode",
    "draw_tracking",
    "drive_table",
    "dynamics_sections",
    "in_short",
    "invertible_sentence",
    "metrics_table",
    "number",
    "parameters_table",
    "traits_table",
    "write_report",
]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'hyst.report' has no attribute {name!r}")
    value = getattr(importlib.import_module(f"hyst.report.{_HOME[name]}"), name)
    globals()[name] = value
    return value
