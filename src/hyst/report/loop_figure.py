"""The loop: output over input, recorded and modelled."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hyst.report.canvas import FAINT, MEASURED, MODELLED, blank, drawn, with_unit
from hyst.report.drawn_samples import drawn_path, drawn_samples
from hyst.report.fitted_record import FittedRecord

Array = NDArray[np.float64]


@drawn
def draw_loop(fits: tuple[FittedRecord, ...], heading: str) -> Figure:
    """Draw the loop, and beside it the loop without its straight line, where hysteresis is large.

    Parameters
    ----------
    fits
        Training records with the model's output.
    heading
        Line above the figure; empty for none.

    Returns
    -------
    bytes
        PNG.
    """
    figure, (left, right) = blank(2, 1, 10.0, 4.4)
    draw_fitted_loop(left, fits)
    draw_fitted_hysteresis(right, fits)
    if heading:
        figure.suptitle(heading)
    return figure


def draw_fitted_loop(axes: Axes, fits: tuple[FittedRecord, ...]) -> None:
    """Draw the loop of records and model on ``axes``; ``fits`` are records with its output."""
    slope, _ = _straight_line(fits)
    _draw(axes, fits, 0.0, 0.0)
    axes.set_title("Loop")
    axes.legend(loc="upper left" if slope > 0.0 else "upper right")


def draw_fitted_hysteresis(axes: Axes, fits: tuple[FittedRecord, ...]) -> None:
    """Draw the loop of ``fits`` without its straight line on ``axes``."""
    _draw(axes, fits, *_straight_line(fits))
    axes.axhline(0.0, color=FAINT, linewidth=1.0, zorder=0)
    axes.set_title("Loop without its straight line")


def _draw(axes: Axes, fits: tuple[FittedRecord, ...], slope: float, offset: float) -> None:
    for number, fit in enumerate(fits):
        u = fit.model_input
        line = slope * u + offset
        _pair(axes, u, fit.measured - line, fit.modelled - line, number == 0)
    record = fits[0].record
    what = f"{record.output_name} - line" if slope or offset else record.output_name
    axes.set_xlabel(with_unit(record.input_name, record.input_unit))
    axes.set_ylabel(with_unit(what, record.output_unit))


def _straight_line(fits: tuple[FittedRecord, ...]) -> tuple[float, float]:
    u = np.concatenate([fit.model_input for fit in fits])
    y = np.concatenate([fit.measured for fit in fits])
    slope = float(np.dot(u - u.mean(), y) / np.dot(u - u.mean(), u - u.mean()))
    return slope, float(y.mean() - slope * u.mean())


def _pair(axes: Axes, u: Array, measured: Array, modelled: Array, label: bool) -> None:
    shown = drawn_samples(u, measured)
    axes.plot(
        u[shown], measured[shown], ".", color=MEASURED, markersize=2.0, alpha=0.5,
        label="record" * label, rasterized=True,
    )  # fmt: skip
    axes.plot(*drawn_path(u, modelled), color=MODELLED, linewidth=1.1, label="model" * label)
