"""Models of one actuator beside each other: their loops, and their errors over time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hyst.identification import ComparedModel, Comparison
from hyst.report.canvas import FAINT, MEASURED, MODELLED, SECOND, blank, drawn, with_unit
from hyst.report.drawn_samples import drawn_path, drawn_samples

Array = NDArray[np.float64]

COLOURS = (SECOND, MODELLED, "#047857", "#7c3aed", "#be185d", "#0891b2")
MOST_DRAWN = len(COLOURS)
"""More lines on each other tell nothing; the best are drawn."""

_CUT = 4.0
"""Times the largest error of the best model, where errors of others are cut off."""


def drawn_models(found: Comparison) -> list[ComparedModel]:
    """Give the models that figures show, the best first."""
    return sorted(found.models, key=found.error_of)[:MOST_DRAWN]


@drawn
def draw_compared_loops(found: Comparison) -> Figure:
    """Draw the recorded loop and those of the models, and all without the straight line.

    Parameters
    ----------
    found
        The comparison.

    Returns
    -------
    bytes
        PNG.
    """
    figure, (left, right) = blank(2, 1, 10.0, 4.9)
    draw_loops_over_input(left, found)
    draw_hystereses(right, found)
    handles, labels = left.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=min(len(labels), 2))
    return figure


def draw_loops_over_input(axes: Axes, found: Comparison) -> None:
    """Draw the recorded loop and those of the models of ``found`` on ``axes``."""
    _draw_loops(axes, found, 0.0, 0.0)
    axes.set_title("Loops, recorded and of the models")


def draw_hystereses(axes: Axes, found: Comparison) -> None:
    """Draw the loops of ``found`` without the straight line of the record on ``axes``."""
    _draw_loops(axes, found, *_straight_line(found, _windows(found)))
    axes.axhline(0.0, color=FAINT, linewidth=1.0, zorder=0)
    axes.set_title("Without the straight line of the record")


def _draw_loops(axes: Axes, found: Comparison, slope: float, offset: float) -> None:
    windows = _windows(found)
    for number, (record, window) in enumerate(zip(found.records, windows, strict=True)):
        u = record.u[window]
        _dots(axes, u, record.y[window] - (slope * u + offset), "record" * (number == 0))
    low, high = axes.get_ylim()
    for place, (colour, each) in enumerate(zip(COLOURS, drawn_models(found), strict=False)):
        for number, (record, window) in enumerate(zip(found.records, windows, strict=True)):
            u = record.u[window]
            y = each.outputs[number][window] - (slope * u + offset)
            name, above = _told(each) * (number == 0), 3.0 - place / MOST_DRAWN
            axes.plot(*drawn_path(u, y), color=colour, linewidth=0.9, label=name, zorder=above)
    # A model that is far off must not make the loop small.
    room = 0.15 * (high - low)
    axes.set_ylim(low - room, high + room)
    first = found.records[0]
    what = f"{first.output_name} - line" if slope or offset else first.output_name
    axes.set_xlabel(with_unit(first.input_name, first.input_unit))
    axes.set_ylabel(with_unit(what, first.output_unit))


@drawn
def draw_compared_errors(found: Comparison) -> Figure:
    """Draw the error of each model over time, all in one scale, the records after each other.

    The scale is cut where a bad model would make the errors of the best one small.

    Parameters
    ----------
    found
        The comparison.

    Returns
    -------
    bytes
        PNG.
    """
    models = drawn_models(found)
    figure, axes = blank(1, len(models), 10.0, 0.3 + 2.1 * len(models))
    shown = _shown_error(found)
    for at, colour, each in zip(axes, COLOURS, models, strict=False):
        most = _largest_error(each, found, _windows(found))
        _draw_error(at, found, each, colour)
        at.set_title(_told(each) + (f", cut off: up to {most:.3g}" if most > shown else ""))
        _finish_errors(at, found)
        at.set_xlabel("time [s]")
    return figure


def draw_errors_over_time(axes: Axes, found: Comparison) -> None:
    """Draw the errors of all models of ``found`` over time on one ``axes``, the best on top."""
    models = list(zip(COLOURS, drawn_models(found), strict=False))
    for place, (colour, each) in enumerate(models):
        _draw_error(axes, found, each, colour, 3.0 - place / MOST_DRAWN)
    most = max(_largest_error(each, found, _windows(found)) for _, each in models)
    cut = f", cut off: up to {most:.3g}" if most > _shown_error(found) else ""
    axes.set_title(f"Errors over time{cut}")
    axes.set_xlabel("time [s]")
    _finish_errors(axes, found)


def _draw_error(
    axes: Axes, found: Comparison, each: ComparedModel, colour: str, above: float = 2.0
) -> None:
    begin = 0.0
    for number, (record, window) in enumerate(zip(found.records, _windows(found), strict=True)):
        error, name = (each.outputs[number] - record.y)[window], _told(each) * (number == 0)
        shown = drawn_samples(error)
        time = begin + record.time[window][shown]
        axes.plot(time, error[shown], color=colour, linewidth=0.7, label=name, zorder=above)
        begin += record.duration + record.dt
        if number + 1 < len(found.records):
            axes.axvline(begin, color=FAINT)


def _finish_errors(axes: Axes, found: Comparison) -> None:
    axes.axhline(0.0, color="#4b5563", linewidth=0.7)
    axes.set_ylabel(with_unit("error", found.records[0].output_unit))
    axes.margins(x=0.01)
    shown = _shown_error(found)
    axes.set_ylim(-shown, shown)


def _shown_error(found: Comparison) -> float:
    """Give the end of the scale of errors, where a bad model would make the best one's small."""
    reach = [_largest_error(each, found, _windows(found)) for each in drawn_models(found)]
    return 1.08 * min(max(reach), _CUT * reach[0]) or 1.0


def _told(each: ComparedModel) -> str:
    return f"{each.name}: {each.metrics.rms_percent:.3g} % rms"


def _largest_error(each: ComparedModel, found: Comparison, windows: Sequence[slice]) -> float:
    errors = (
        np.abs(y[window] - record.y[window]).max()
        for y, record, window in zip(each.outputs, found.records, windows, strict=True)
    )
    return float(max(errors))


def _windows(found: Comparison) -> list[slice]:
    return [slice(each.start, each.stop) for each in found.used]


def _straight_line(found: Comparison, windows: Sequence[slice]) -> tuple[float, float]:
    pairs = list(zip(found.records, windows, strict=True))
    u = np.concatenate([record.u[window] for record, window in pairs])
    y = np.concatenate([record.y[window] for record, window in pairs])
    centred = u - u.mean()
    power = float(np.dot(centred, centred))
    slope = float(np.dot(centred, y)) / power if power > 0.0 else 0.0
    return slope, float(y.mean() - slope * u.mean())


def _dots(axes: Axes, u: Array, y: Array, label: str) -> None:
    shown = drawn_samples(u, y)
    axes.plot(
        u[shown], y[shown], ".", color=MEASURED, markersize=3.0, alpha=0.5, label=label,
        rasterized=True,
    )  # fmt: skip
