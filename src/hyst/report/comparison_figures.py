"""Models of one actuator beside each other: their loops, and their errors over time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hyst.identification import ComparedModel, Comparison
from hyst.report.canvas import FAINT, MEASURED, MODELLED, SECOND, blank, drawn, with_unit

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
    figure, (left, right) = blank(2, 1, 11.0, 4.9)
    models, windows = drawn_models(found), _windows(found)
    slope, offset = _straight_line(found, windows)
    ranked = list(zip(COLOURS, models, strict=False))
    for axes, taken in ((left, (0.0, 0.0)), (right, (slope, offset))):
        for number, (record, window) in enumerate(zip(found.records, windows, strict=True)):
            u = record.u[window]
            line = taken[0] * u + taken[1]
            _dots(axes, u, record.y[window] - line, "record" * (number == 0))
        low, high = axes.get_ylim()
        for place, (colour, each) in enumerate(ranked):
            for number, (record, window) in enumerate(zip(found.records, windows, strict=True)):
                u = record.u[window]
                y = each.outputs[number][window] - (taken[0] * u + taken[1])
                name, above = _told(each) * (number == 0), 3.0 - place / MOST_DRAWN
                axes.plot(u, y, color=colour, linewidth=0.9, label=name, zorder=above)
        # A model that is far off must not make the loop small.
        room = 0.15 * (high - low)
        axes.set_ylim(low - room, high + room)
    first = found.records[0]
    right.axhline(0.0, color=FAINT, linewidth=1.0, zorder=0)
    left.set_title("Loops, recorded and of the models")
    right.set_title("The same without the straight line of the record")
    for axes in (left, right):
        axes.set_xlabel(with_unit(first.input_name, first.input_unit))
    left.set_ylabel(with_unit(first.output_name, first.output_unit))
    right.set_ylabel(with_unit(f"{first.output_name} - line", first.output_unit))
    handles, labels = left.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=min(len(labels), 4))
    return figure


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
    models, windows = drawn_models(found), _windows(found)
    figure, axes = blank(1, len(models), 10.0, 0.7 + 1.75 * len(models))
    unit = found.records[0].output_unit
    reach = [_largest_error(each, found, windows) for each in models]
    shown = 1.08 * min(max(reach), _CUT * reach[0]) or 1.0
    for at, colour, each, most in zip(axes, COLOURS, models, reach, strict=False):
        begin = 0.0
        for number, (record, window) in enumerate(zip(found.records, windows, strict=True)):
            error = (each.outputs[number] - record.y)[window]
            at.plot(begin + record.time[window], error, color=colour, linewidth=0.7)
            begin += record.duration + record.dt
            if number + 1 < len(found.records):
                at.axvline(begin, color=FAINT)
        at.axhline(0.0, color="#4b5563", linewidth=0.7)
        at.set_title(_told(each) + (f", cut off: up to {most:.3g}" if most > shown else ""))
        at.set_ylabel(with_unit("error", unit))
        at.margins(x=0.01)
        at.set_ylim(-shown, shown)
    axes[-1].set_xlabel("time [s]")
    return figure


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
    axes.plot(u, y, ".", color=MEASURED, markersize=3.0, alpha=0.5, label=label, rasterized=True)
