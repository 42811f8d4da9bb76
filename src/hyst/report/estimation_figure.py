"""Figure of estimates over time: weights, radii and the rest, with bands."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hyst.online import Trajectory
from hyst.report.canvas import FAINT, blank, drawn, ratio_unit, with_unit

_COLOURS = ("#c2410c", "#1d4ed8", "#047857", "#7c3aed", "#db2777", "#0e7490", "#854d0e", "#4b5563")


@drawn
def draw_estimates(
    trajectories: Mapping[str, Trajectory],
    truth: Mapping[str, float],
    heading: str,
    units: tuple[str, str] = ("", ""),
) -> Figure:
    """Draw parameters over time: a row for each estimator; radii, weights, offset and maps beside.

    Parameters
    ----------
    trajectories
        By label.
    truth
        True values by name, drawn as lines; may be empty.
    heading
        Line above the figure; empty for none.
    units
        Of the plays' input and output, for the value axes; empty where unknown.

    Returns
    -------
    bytes
        PNG. Bands are two standard errors on either side.
    """
    groups = {
        label: {key: names for key, names in _groups(each).items() if names}
        for label, each in trajectories.items()
    }
    columns = max(len(each) for each in groups.values())
    figure, axes = blank(columns, len(groups), 4.6 * columns, 0.5 + 3.2 * len(groups))
    for row, (label, trajectory) in enumerate(trajectories.items()):
        panels = axes[row * columns : (row + 1) * columns]
        for panel in panels[len(groups[label]) :]:
            panel.set_visible(False)
        for panel, (what, names) in zip(panels, groups[label].items(), strict=False):
            _draw(panel, trajectory, names, truth)
            panel.set_title(f"{label}: {what}" if label else what)
            panel.set_ylabel(_with_unit(what, *units))
    if heading:
        figure.suptitle(heading)
    return figure


def _groups(trajectory: Trajectory) -> dict[str, list[str]]:
    names = trajectory.names
    radii = [name for name in names if name.startswith("r[")]
    weights = [name for name in names if name == "p0" or name.startswith("p[")]
    offset = [name for name in names if name == "offset"]
    scale = [name for name in names if name == "scale"]
    moving = {name: bool(trajectory.standard_errors[:, i].any()) for i, name in enumerate(names)}
    # Maps are held unless asked for, and what is held says nothing.
    maps = [name for name in names if name.startswith(("front", "back")) and moving[name]]
    grouped = {
        "scale": scale,
        "radii": radii,
        "weights": weights,
        "offset": offset,
        "weights of maps": maps,
    }
    # An offset of hundreds of units would flatten the maps' weights, which are about 1. Of other
    # constants each may have another size.
    known = {name for each in grouped.values() for name in each}
    others = [name for name in names if moving[name] and name not in known]
    return grouped | {name: [name] for name in others if not name.startswith(("front", "back"))}


def _with_unit(what: str, input_unit: str, output_unit: str) -> str:
    """Label the value axis; the weights of maps are pure numbers."""
    if what == "radii":
        return with_unit("radius", input_unit)
    if what == "weights":
        return with_unit("weight", ratio_unit(output_unit, input_unit))
    if what == "offset":
        return with_unit("offset", output_unit)
    return "weight" if what == "weights of maps" else what


def _draw(axes: Axes, trajectory: Trajectory, names: list[str], truth: Mapping[str, float]) -> None:
    for index, name in enumerate(names):
        colour = _COLOURS[index % len(_COLOURS)]
        place = trajectory.names.index(name)
        value, error = trajectory.values[:, place], trajectory.standard_errors[:, place]
        if name in truth:
            axes.axhline(truth[name], color=FAINT, linewidth=1.0, zorder=1)
        if np.isfinite(error).any():
            low, high = value - 2.0 * error, value + 2.0 * error
            axes.fill_between(trajectory.time, low, high, color=colour, alpha=0.15, linewidth=0.0)
        axes.plot(trajectory.time, value, color=colour, label=name)
    spread = np.concatenate([trajectory.of(name) for name in names])
    margin = 0.15 * float(np.ptp(spread)) or 0.1 * abs(float(spread[0])) or 1.0
    # Bands are wide at first; the axis shows the estimates.
    axes.set_ylim(float(spread.min()) - margin, float(spread.max()) + margin)
    axes.set_xlabel("time [s]")
    axes.legend(loc="best", ncols=2)
