"""Output over time, recorded and modelled: the whole record and a few strokes of it."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hyst.report.canvas import FAINT, MEASURED, MODELLED, blank, drawn, with_unit
from hyst.report.drawn_samples import drawn_samples
from hyst.report.fitted_record import FittedRecord
from hyst.signals import reversals

_STROKES = 6


@drawn
def draw_history(fits: tuple[FittedRecord, ...], heading: str) -> Figure:
    """Draw records over time, one a row, and beside each a close view.

    Parameters
    ----------
    fits
        Records with the model's output.
    heading
        Line above the figure; empty for none.

    Returns
    -------
    bytes
        PNG.
    """
    figure, axes = blank(2, len(fits), 10.0, 0.8 + 2.7 * len(fits))
    for row, fit in enumerate(fits):
        whole, close = axes[2 * row], axes[2 * row + 1]
        draw_output(whole, fit)
        _draw(close, fit, *_a_few_strokes(fit))
        close.set_title("A closer look")
        close.set_ylabel(with_unit(fit.record.output_name, fit.record.output_unit))
    for each in axes:
        each.set_xlabel("time [s]")
    _place_legend(axes[1])
    if heading:
        figure.suptitle(heading)
    return figure


def draw_output(axes: Axes, fit: FittedRecord) -> None:
    """Draw the output of a whole record, ``fit``, and of the model over time, on ``axes``."""
    _draw(axes, fit, 0, len(fit.record))
    axes.set_title(f"Output, {fit.label} record")
    axes.set_ylabel(with_unit(fit.record.output_name, fit.record.output_unit))
    if fit.start > 0:
        axes.axvspan(0.0, fit.start * fit.record.dt, color="#f3f4f6", zorder=0)


def draw_strokes(axes: Axes, fit: FittedRecord) -> None:
    """Draw a few strokes of a record, ``fit``, and of the model over time, on ``axes``."""
    _draw(axes, fit, *_a_few_strokes(fit))
    axes.set_title("A few strokes")
    axes.set_xlabel("time [s]")
    axes.set_ylabel(with_unit(fit.record.output_name, fit.record.output_unit))
    _place_legend(axes)


def draw_band(axes: Axes, fit: FittedRecord) -> None:
    """Draw the error of ``fit`` over a few strokes in the band that is to hold it, on ``axes``.

    Beside an output of its full range neither could be seen.
    """
    start, stop = _a_few_strokes(fit)
    error = (fit.y_model - fit.record.y)[start:stop]
    shown = drawn_samples(error)
    t = (start + shown) * fit.record.dt
    if fit.band is None:
        axes.set_title("Error over a few strokes (too long a record for the band)")
    else:
        low, high = ((fit.y_model - each)[start:stop][shown] for each in fit.band)
        axes.fill_between(t, low, high, color=MODELLED, alpha=0.18, linewidth=0.0, label="95 %")
        axes.set_title("Error over a few strokes, in its band")
    axes.plot(t, error[shown], ".", color=MODELLED, markersize=2.5, label="model - record")
    axes.axhline(0.0, color=FAINT, zorder=0)
    axes.set_xlabel("time [s]")
    axes.set_ylabel(with_unit("error", fit.record.output_unit))
    axes.margins(x=0.01)
    _place_legend(axes)


def _place_legend(axes: Axes) -> None:
    axes.legend(loc="upper right", ncols=3)
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.18 * (high - low))


def _draw(axes: Axes, fit: FittedRecord, start: int, stop: int) -> None:
    measured, modelled = fit.record.y[start:stop], fit.y_model[start:stop]
    shown = drawn_samples(measured, modelled)
    t = (start + shown) * fit.record.dt
    if fit.band is not None:
        low, high = (each[start:stop][shown] for each in fit.band)
        axes.fill_between(t, low, high, color=MODELLED, alpha=0.18, linewidth=0.0, label="95 %")
    axes.plot(t, measured[shown], color=MEASURED, linewidth=2.2, alpha=0.6, label="record")
    axes.plot(t, modelled[shown], color=MODELLED, linewidth=1.0, label="model")
    axes.margins(x=0.01)


def _a_few_strokes(fit: FittedRecord) -> tuple[int, int]:
    """First and last sample of some strokes in the middle of what took part."""
    u = fit.record.u
    turns = reversals(u, 0.05 * float(np.ptp(u)))
    turns = turns[turns >= fit.start]
    if turns.size < _STROKES + 1:
        return fit.start, len(fit.record)
    first = (turns.size - _STROKES - 1) // 2
    return int(turns[first]), int(turns[first + _STROKES]) + 1
