"""What the model leaves unexplained: over time, over the input, its distribution and its memory."""

from __future__ import annotations

import math
from collections.abc import Iterator

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
    draw_error_over_time(over_time, fits)
    draw_error_over_input(over_input, fits)
    draw_error_distribution(spread, fits)
    draw_error_autocorrelation(memory, fits)
    if heading:
        figure.suptitle(heading)
    return figure


def draw_error_over_time(axes: Axes, fits: tuple[FittedRecord, ...]) -> None:
    """Draw what the model leaves of ``fits`` over time, on ``axes``."""
    for fit, shown, colour in _coloured(fits):
        time = (fit.start + shown) * fit.record.dt
        axes.plot(time, fit.error[shown], ".", color=colour, markersize=1.6, alpha=0.6)
    axes.axhline(0.0, color=FAINT, zorder=0)
    axes.set(title="Error over time", xlabel="time [s]", ylabel=_error_label(fits))


def draw_error_over_input(axes: Axes, fits: tuple[FittedRecord, ...]) -> None:
    """Draw what the model leaves of ``fits`` over the input, on ``axes``."""
    for fit, shown, colour in _coloured(fits):
        u = fit.model_input[shown]
        axes.plot(u, fit.error[shown], ".", color=colour, markersize=1.6, alpha=0.4)
    axes.axhline(0.0, color=FAINT, zorder=0)
    record = fits[0].record
    axes.set(
        title="Error over input",
        xlabel=with_unit(record.input_name, record.input_unit),
        ylabel=_error_label(fits),
    )


def draw_error_distribution(axes: Axes, fits: tuple[FittedRecord, ...]) -> None:
    """Draw how large the errors of ``fits`` are how often, on ``axes``."""
    _draw_distribution(axes, np.concatenate([fit.error for fit in fits]))
    axes.set(title="Distribution", xlabel=_error_label(fits), ylabel="share of samples per unit")
    axes.locator_params(axis="x", nbins=6)  # labels such as -0.015 ran into each other


def draw_error_autocorrelation(axes: Axes, fits: tuple[FittedRecord, ...]) -> None:
    """Draw how long the error of the longest of ``fits`` remembers itself, on ``axes``."""
    _draw_autocorrelation(axes, max(fits, key=lambda fit: fit.error.size))
    axes.set(title="Autocorrelation of the error", xlabel="lag [s]", ylabel="correlation")


def _coloured(
    fits: tuple[FittedRecord, ...],
) -> Iterator[tuple[FittedRecord, NDArray[np.intp], str]]:
    """Give each record with the samples of it that are drawn, and its colour."""
    for number, fit in enumerate(fits):
        shown = drawn_samples(fit.model_input, fit.error)
        yield fit, shown, (MODELLED, SECOND)[number % 2]


def _error_label(fits: tuple[FittedRecord, ...]) -> str:
    return with_unit("error", fits[0].record.output_unit)


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
