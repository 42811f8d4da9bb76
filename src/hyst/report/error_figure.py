"""What the model leaves unexplained: over time, over the input, its distribution and its memory."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hyst.report.canvas import FAINT, MEASURED, MODELLED, SECOND, blank, drawn, with_unit
from hyst.report.drawn_samples import drawn_samples
from hyst.report.error_memory import autocorrelation
from hyst.report.fitted_record import FittedRecord

Array = NDArray[np.float64]

_MOST_LAGS = 20_000


@drawn
def draw_error(fits: tuple[FittedRecord, ...], heading: str) -> Figure:
    """Draw the error of the model over the training records.

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
    figure, (over_time, over_input, spread, memory) = blank(2, 2, 10.0, 6.4)
    record = fits[0].record
    for number, fit in enumerate(fits):
        colour = (MODELLED, SECOND)[number % 2]
        u, error = fit.model_input, fit.error
        shown = drawn_samples(u, error)
        time = (fit.start + shown) * fit.record.dt
        over_time.plot(time, error[shown], ".", color=colour, markersize=1.6, alpha=0.6)
        over_input.plot(u[shown], error[shown], ".", color=colour, markersize=1.6, alpha=0.4)
    error_label = with_unit("error", record.output_unit)
    over_time.set(title="Error over time", xlabel="time [s]", ylabel=error_label)
    over_input.set(
        title="Error over input",
        xlabel=with_unit(record.input_name, record.input_unit),
        ylabel=error_label,
    )
    for axes in (over_time, over_input):
        axes.axhline(0.0, color=FAINT, zorder=0)
    _draw_distribution(spread, np.concatenate([fit.error for fit in fits]))
    spread.set(title="Distribution", xlabel=error_label, ylabel="share of samples per unit")
    spread.locator_params(axis="x", nbins=6)  # labels such as -0.015 ran into each other
    longest = max(fits, key=lambda fit: fit.error.size)
    _draw_autocorrelation(memory, longest)
    memory.set(title="Autocorrelation", xlabel="lag [s]", ylabel="correlation")
    if heading:
        figure.suptitle(heading)
    return figure


def _draw_distribution(axes: Axes, error: Array) -> None:
    axes.hist(error, bins=60, density=True, color="#fdba74", edgecolor="white", linewidth=0.3)
    mean, deviation = float(error.mean()), float(error.std())
    if deviation > 0.0:
        x = np.linspace(error.min(), error.max(), 200)
        bell = np.exp(-0.5 * ((x - mean) / deviation) ** 2) / (deviation * math.sqrt(2.0 * math.pi))
        axes.plot(x, bell, color=MEASURED, label="normal, same mean and deviation")
        top = axes.get_ylim()[1]
        axes.set_ylim(0.0, 1.18 * top)
        axes.legend(loc="upper left")


def _draw_autocorrelation(axes: Axes, fit: FittedRecord) -> None:
    count = fit.error.size
    lags = min(_MOST_LAGS, count // 4)
    lag = np.arange(lags + 1) * fit.record.dt
    band = 1.96 / math.sqrt(count)
    axes.axhspan(-band, band, color=FAINT, alpha=0.6, label="95 % of white noise", zorder=0)
    axes.plot(lag, autocorrelation(fit.error, lags), color=MODELLED)
    axes.legend(loc="upper right")
    axes.margins(x=0.01)
