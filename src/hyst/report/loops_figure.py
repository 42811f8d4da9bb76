"""Loops of several records on each other: as recorded, and behind the dynamics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hyst.compensation import LoopsBehind
from hyst.compensation.loop_check.loops import LoopOfRecord
from hyst.compensation.loop_check.rate_test import RepeatedLoop
from hyst.report.canvas import FAINT, MODELLED, blank, drawn, with_unit

Array = NDArray[np.float64]

MOST_DRAWN = 8
"""More loops on each other tell nothing; the slowest and the fastest are among those drawn."""

_BINS = 90
_MOST_POINTS = 20_000


@dataclass(frozen=True, eq=False)
class _Drawn:
    """One loop: samples, and the mean of its cycles where there are any."""

    label: str
    u: Array
    y: Array
    v: Array
    modelled: Array
    mean_u: Array
    mean_v: Array


@drawn
def draw_loops_behind(found: LoopsBehind) -> Figure:
    """Draw the loops of all records, and what the inverse of the dynamics makes of them.

    Left output over input, in the middle what drives the dynamics over the input, right the same
    without the straight line of the model. Dots are samples; lines are the model with the first
    three harmonics of what the samples have beside it, which are compared; broken is the model.

    Parameters
    ----------
    found
        The loops.

    Returns
    -------
    bytes
        PNG.
    """
    figure, (raw, behind, opened) = blank(3, 1, 14.0, 4.9)
    loops = _drawn(found)
    colours = colormaps["viridis"](np.linspace(0.0, 0.85, len(loops)))
    slope, offset = _line(loops)
    for colour, each in zip(colours, loops, strict=True):
        raw.plot(each.u, each.y, color=colour, linewidth=0.9)
    for axes, line in ((behind, 0.0), (opened, 1.0)):
        lines = []
        for colour, each in zip(colours, loops, strict=True):
            taken = line * (slope * each.u + offset)
            _dots(axes, each.u, each.v - taken, colour)
            shown = each.mean_v - line * (slope * each.mean_u + offset)
            axes.plot(each.mean_u, shown, color=colour, label=each.label, linewidth=1.6, zorder=3)
            lines += [shown] if shown.size else [each.v - taken]
        for each in loops:
            shown = each.modelled - line * (slope * each.u + offset)
            label = "hysteresis of the model" if each is loops[0] else ""
            axes.plot(each.u, shown, "--", color=MODELLED, linewidth=1.0, label=label, zorder=4)
            lines.append(shown)
        _frame(axes, lines)
    opened.axhline(0.0, color=FAINT, linewidth=1.0, zorder=0)
    first = found.loops[0].record
    raw.set_title("As recorded: output over input")
    behind.set_title("Behind the dynamics: v over input")
    opened.set_title("The same without the model's straight line")
    for axes in (raw, behind, opened):
        axes.set_xlabel(with_unit(first.input_name, first.input_unit))
    raw.set_ylabel(with_unit(first.output_name, first.output_unit))
    behind.set_ylabel(with_unit("v", first.output_unit))
    opened.set_ylabel(with_unit("v - line", first.output_unit))
    handles, labels = opened.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=min(len(labels), 5))
    return figure


def _drawn(found: LoopsBehind) -> list[_Drawn]:
    """Give the loops that repeat, by frequency; where none does, the records."""
    repeated = sorted(found.repeated, key=lambda each: each.frequency)
    if len(repeated) > MOST_DRAWN:
        chosen = np.linspace(0, len(repeated) - 1, MOST_DRAWN).round().astype(int)
        repeated = [repeated[k] for k in chosen]
    loops = []
    for each in repeated:
        loop, cycles = found.loops[each.record], each.cycles
        label = f"{each.frequency:.4g} Hz (noise +- {2.0 * each.shape.noise:.2g})"
        window = slice(cycles.start, min(cycles.stop, cycles.start + _MOST_POINTS))
        mean = _mean_cycle(loop, each)
        loops.append(_of(found, each.record, label, window, *mean))
    seen = {each.record for each in repeated}
    for number, loop in enumerate(found.loops):
        if number not in seen and len(loops) < MOST_DRAWN:
            start = loop.valid.start
            window = slice(start, min(loop.valid.stop, start + _MOST_POINTS))
            label = f"record {loop.name} (noise +- {loop.band:.2g})"
            loops.append(_of(found, number, label, window, np.empty(0), np.empty(0)))
    return loops


def _of(
    found: LoopsBehind, record: int, label: str, window: slice, mean_u: Array, mean_v: Array
) -> _Drawn:
    loop = found.loops[record]
    return _Drawn(
        label,
        loop.record.u[window],
        loop.record.y[window],
        loop.v[window],
        loop.modelled[window],
        mean_u,
        mean_v,
    )


def _mean_cycle(loop: LoopOfRecord, each: RepeatedLoop) -> tuple[Array, Array]:
    """Give input and signal over the phase, closed: the model, and the harmonics v has beside it.

    They are what is compared, and noise has little part in them.
    """
    cycles = each.cycles
    turned = np.mod(cycles.phase, 2.0 * np.pi)
    bins = int(np.clip(cycles.phase.size / cycles.cycles, 8, _BINS))
    place = np.minimum((turned * bins / (2.0 * np.pi)).astype(np.intp), bins - 1)
    count = np.bincount(place, minlength=bins)
    filled = count > 0
    shown = loop.modelled[cycles.window] + loop.offset + each.shape.beside_at(cycles.phase)
    mean_u, mean_v = (
        np.bincount(place, signal, bins)[filled] / count[filled]
        for signal in (loop.record.u[cycles.window], shown)
    )
    return np.append(mean_u, mean_u[0]), np.append(mean_v, mean_v[0])


def _frame(axes: Axes, values: list[Array]) -> None:
    """Show all lines; single samples far off, in a noisy record, must not flatten the loop."""
    low, high = min(each.min() for each in values), max(each.max() for each in values)
    room = 0.25 * (high - low)
    axes.set_ylim(low - room, high + room)


def _line(loops: list[_Drawn]) -> tuple[float, float]:
    u = np.concatenate([each.u for each in loops])
    v = np.concatenate([each.modelled for each in loops])
    centred = u - u.mean()
    slope = float(np.dot(centred, v)) / float(np.dot(centred, centred))
    return slope, float(v.mean() - slope * u.mean())


def _dots(axes: Axes, u: Array, v: Array, colour: Array) -> None:
    axes.plot(u, v, ".", color=colour, markersize=1.5, alpha=0.25, rasterized=True)
