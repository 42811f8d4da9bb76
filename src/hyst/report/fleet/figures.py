"""Figures of a fleet: how its main numbers are distributed, and its loops on each other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hyst.report.canvas import FAINT, MEASURED, MODELLED, SECOND, blank, drawn, with_unit

if TYPE_CHECKING:
    from hyst.fleet import Fleet

Array = NDArray[np.float64]

SHOWN = {
    "gain": "gain of the loop",
    "hysteresis_percent": "opening of the loop, of its height",
    "bend_percent": "bend of the loop, of its height",
    "rms_percent": "error of the model, of the range",
    "noise": "noise from sample to sample",
    "output_range": "stroke",
}
"""Numbers whose distribution is drawn, with their words."""

COLOURS = (MODELLED, SECOND, "#047857", "#7c3aed", "#be185d", "#0891b2")
MOST_NAMED = len(COLOURS)

_MOST_LINES = 600
_CENTRAL = 0.995
_FAR = 1.0
"""Widths of the range of the others beyond which odd devices are drawn at the edge."""


@drawn
def draw_fleet_distributions(fleet: Fleet) -> Figure:
    """Draw histograms of the main numbers with limits, the odd devices marked.

    Parameters
    ----------
    fleet
        At least one device has a model.

    Returns
    -------
    bytes
        PNG.
    """
    figure, axes = blank(3, 2, 13.0, 7.0)
    odd = {each.identifier for each in fleet.outliers}
    is_odd = np.array([each in odd for each in fleet.table["identifier"]])
    for at, (name, words) in zip(axes, SHOWN.items(), strict=True):
        _histogram(at, fleet.table[name], is_odd)
        _limits(at, fleet, name)
        at.set_title(words)
        at.set_xlabel(with_unit("", fleet.table.units[name]).strip())
    for at in axes[::3]:
        at.set_ylabel("devices")
    named: dict[str, Artist] = {}
    for at in axes:
        handles, labels = at.get_legend_handles_labels()
        named |= dict(zip(labels, handles, strict=True))
    figure.legend(list(named.values()), list(named), loc="outside lower center", ncols=3)
    return figure


def _histogram(axes: Axes, values: Array, is_odd: NDArray[np.bool_]) -> None:
    known = ~np.isnan(values)
    usual, odd = values[known & ~is_odd], values[known & is_odd]
    if usual.size:
        low, high = np.quantile(usual, [1.0 - _CENTRAL, _CENTRAL])
        room = 0.35 * (high - low) or 0.05 * abs(high) or 1.0
        low, high = max(low - room, usual.min()), min(high + room, usual.max())
        if high <= low:
            low, high = low - 0.5 * room, high + 0.5 * room
        bins = np.linspace(low, high, int(np.clip(np.sqrt(usual.size), 8, 40)) + 1)
        # What is beyond counts in the outermost bars: none is left out.
        axes.hist(np.clip(usual, low, high), bins=bins.tolist(), color=MEASURED, label="devices")
    if odd.size:
        if usual.size:
            # One far out would squeeze the others into a bar; the table has its value.
            odd = np.clip(odd, low - _FAR * (high - low), high + _FAR * (high - low))
        axes.plot(
            odd,
            np.full(odd.size, 0.03),
            "v",
            color=MODELLED,
            transform=axes.get_xaxis_transform(),
            label="odd devices",
            zorder=4,
        )


def _limits(axes: Axes, fleet: Fleet, name: str) -> None:
    """Draw the limits that most devices have: those of single devices are in the table."""
    pairs = [own[name] for own in fleet.limits.values() if name in own]
    for ends in zip(*pairs, strict=True):
        given = [each for each in ends if each is not None]
        if given:
            common = max(set(given), key=given.count)
            axes.axvline(common, color=SECOND, linestyle="--", label="limits")


@drawn
def draw_fleet_loops(fleet: Fleet) -> Figure:
    """Draw the modelled loops of all devices on each other, from 0 to 1, the odd ones in colour.

    Parameters
    ----------
    fleet
        At least one device has a model.

    Returns
    -------
    bytes
        PNG.
    """
    figure, (whole, opened) = blank(2, 1, 11.0, 4.9)
    odd = [each.identifier for each in fleet.outliers]
    named = dict(zip(odd, COLOURS, strict=False))
    devices = [each for each in fleet.devices if each.rising]
    usual = [each for each in devices if each.identifier not in odd]
    step = -(-len(usual) // _MOST_LINES) or 1
    for axes, taken in ((whole, 0.0), (opened, 1.0)):
        lines = [_line(each.rising, each.falling, taken) for each in usual[::step]]
        axes.add_collection(LineCollection(lines, colors=FAINT, linewidths=0.6))
        for each in devices:
            if each.identifier in odd:
                u, y = _line(each.rising, each.falling, taken).T
                colour = named.get(each.identifier, MODELLED)
                label = each.identifier if each.identifier in named else ""
                axes.plot(u, y, color=colour, linewidth=1.2, label=label, zorder=3)
        axes.autoscale_view()
        axes.set_xlabel("drive, from its lowest to its highest")
    whole.set_title("Modelled loops, each from 0 to 1")
    opened.set_title("The same without the line from end to end")
    whole.set_ylabel("output, from its lowest to its highest")
    handles, labels = whole.get_legend_handles_labels()
    if handles:
        figure.legend(handles, labels, loc="outside lower center", ncols=min(len(labels), 6))
    return figure


def _line(rising: tuple[float, ...], falling: tuple[float, ...], taken: float) -> Array:
    u = np.linspace(0.0, 1.0, len(rising))
    up, down = np.array(rising), np.array(falling)
    ends = 0.5 * (up + down)[[0, -1]]
    line = taken * (ends[0] + (ends[1] - ends[0]) * u)
    return np.column_stack(
        (np.concatenate((u, u[::-1])), np.concatenate((up - line, (down - line)[::-1])))
    )
