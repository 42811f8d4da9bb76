"""Figures of a fleet: how its main numbers are distributed, and its loops on each other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

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
MOST_BEYOND = 6
"""Values beyond an end of an axis that are written there; all are in the table."""

_MOST_LINES = 600
_CENTRAL = 0.995
_FAR = 1.0
"""Widths of the range of the others by which odd devices may widen an axis: one far out would
squeeze the others into a bar."""


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
        values = fleet.table[name]
        known = ~np.isnan(values)
        widest = _histogram(at, values[known & ~is_odd])
        _limits(at, fleet, name)
        _odd_ones(at, values[known & is_odd], widest)
        at.set_title(words)
        at.set_xlabel(with_unit("", fleet.table.units[name]).strip())
        at.set_ylabel("devices")
    named: dict[str, Artist] = {}
    for at in axes:
        handles, labels = at.get_legend_handles_labels()
        named |= dict(zip(labels, handles, strict=True))
    figure.legend(list(named.values()), list(named), loc="outside lower center", ncols=3)
    return figure


def _histogram(axes: Axes, usual: Array) -> tuple[float, float]:
    """Draw the devices that are not odd, and give how wide the axis may become for odd ones."""
    if not usual.size:
        return -np.inf, np.inf
    low, high = np.quantile(usual, [1.0 - _CENTRAL, _CENTRAL])
    room = 0.35 * (high - low) or 0.05 * abs(high) or 1.0
    low, high = max(low - room, usual.min()), min(high + room, usual.max())
    if high <= low:
        low, high = low - 0.5 * room, high + 0.5 * room
    bins = np.linspace(low, high, int(np.clip(np.sqrt(usual.size), 8, 40)) + 1)
    # What is beyond counts in the outermost bars: none is left out.
    axes.hist(np.clip(usual, low, high), bins=bins.tolist(), color=MEASURED, label="devices")
    return float(low - _FAR * (high - low)), float(high + _FAR * (high - low))


def _odd_ones(axes: Axes, odd: Array, widest: tuple[float, float]) -> None:
    """Mark odd devices where they are; those beyond the axis at its end, with their value."""
    if not odd.size:
        return
    near = odd[(odd >= widest[0]) & (odd <= widest[1])]
    low, high = axes.get_xlim() if np.isfinite(widest[0]) else (odd.min(), odd.max())
    room = 0.05 * (high - low) or 0.05 * abs(high) or 1.0
    if near.size:
        low, high = min(low, near.min() - room), max(high, near.max() + room)
    axes.set_xlim(low, high)
    inside = odd[(odd >= low) & (odd <= high)]
    looks: dict[str, Any] = {"color": MODELLED, "linestyle": "none", "zorder": 4}
    at: dict[str, Any] = {"transform": axes.get_xaxis_transform(), "label": "odd devices"}
    axes.plot(inside, np.full(inside.size, 0.03), marker="v", **looks, **at)
    for place, mark, beyond in ((0.02, "<", odd[odd < low]), (0.98, ">", odd[odd > high])):
        for height, value in enumerate(np.sort(beyond)[:MOST_BEYOND]):
            y = 0.9 - 0.09 * height
            axes.plot(place, y, marker=mark, transform=axes.transAxes, **looks)
            axes.annotate(
                f"{value:.3g}",
                (place, y),
                xycoords="axes fraction",
                xytext=(8 if mark == "<" else -8, 0),
                textcoords="offset points",
                ha="left" if mark == "<" else "right",
                va="center",
                fontsize=9,
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
    figure, (whole, opened) = blank(2, 1, 10.0, 4.9)
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
    opened.set_ylabel("output minus the line")
    handles, labels = whole.get_legend_handles_labels()
    if handles:
        figure.legend(handles, labels, loc="outside lower center", ncols=min(len(labels), 3))
    return figure


def _line(rising: tuple[float, ...], falling: tuple[float, ...], taken: float) -> Array:
    u = np.linspace(0.0, 1.0, len(rising))
    up, down = np.array(rising), np.array(falling)
    ends = 0.5 * (up + down)[[0, -1]]
    line = taken * (ends[0] + (ends[1] - ends[0]) * u)
    return np.column_stack(
        (np.concatenate((u, u[::-1])), np.concatenate((up - line, (down - line)[::-1])))
    )
