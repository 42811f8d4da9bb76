"""The four figures of an identification."""

from __future__ import annotations

import numpy as np

from hyst.identification import Identified
from hyst.report.error_figure import draw_error
from hyst.report.fitted_record import FittedRecord
from hyst.report.history_figure import draw_history
from hyst.report.loop_figure import draw_loop
from hyst.report.model_figure import Labels, draw_model


def draw_identification(
    identified: Identified,
    training: tuple[FittedRecord, ...],
    shown: tuple[FittedRecord, ...],
    named: tuple[str, str, str, str],
    heading: str,
) -> tuple[bytes, bytes, bytes, bytes]:
    """Draw the loop, the history, the error and the model.

    Parameters
    ----------
    identified
        The result.
    training
        Records it was identified from.
    shown
        Records to draw over time.
    named
        Input with unit, output with unit.
    heading
        Line above each; empty for none.

    Returns
    -------
    tuple of bytes
        PNG each.
    """
    errors = dict(zip(identified.parameter_names, identified.standard_errors.tolist(), strict=True))
    u = np.concatenate([fit.record.u for fit in training])
    return (
        draw_loop(training, heading),
        draw_history(shown, heading),
        draw_error(training, heading),
        draw_model(identified.model, u, Labels(*named), errors, heading),
    )
