"""The model itself: weights over radii, the loading curve of the plays, and its map if any."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hyst.models import (
    LinearDynamics,
    MasingOperator,
    PrandtlIshlinskii,
    RambergOsgood,
    RateDependentPrandtlIshlinskii,
)
from hyst.operators import Affine, Chained, DeadZone, Operator
from hyst.report.canvas import (
    FAINT,
    MEASURED,
    MODELLED,
    SECOND,
    blank,
    drawn,
    ratio_unit,
    with_unit,
)

Array = NDArray[np.float64]

_ENTRY = re.compile(r"(?:.*\.)?([pr])\[(\d+)\]")


@dataclass(frozen=True)
class Labels:
    """Names and units of the two signals.

    Parameters
    ----------
    input_name, input_unit, output_name, output_unit
        As text.
    """

    input_name: str
    input_unit: str
    output_name: str
    output_unit: str


@drawn
def draw_model(
    model: Operator,
    u: Array,
    labels: Labels,
    standard_errors: Mapping[str, float],
    heading: str,
) -> Figure:
    """Draw what a model is made of.

    Parameters
    ----------
    model
        Any operator.
    u
        An input that covers the range of interest, shape (N,).
    labels
        Names and units.
    standard_errors
        Of the parameters by name; those of p and r are drawn.
    heading
        Line above the figure; empty for none.

    Returns
    -------
    bytes
        PNG.
    """
    stages = list(stages_with_signals(model, u))
    units = _units([stage for stage, _, _ in stages], labels.input_unit, labels.output_unit)
    parts = [
        (_at_rest(stage), before, after, *pair)
        for (stage, before, after), pair in zip(stages, pairwise(units), strict=True)
    ]
    parts = [part for part in parts if _is_drawn(part[0])]
    count = sum(2 if isinstance(part[0], PrandtlIshlinskii) else 1 for part in parts)
    figure, axes = blank(max(count, 1), 1, 10.0 if count > 1 else 5.0, 3.9)
    free = iter(axes)
    for stage, before, after, unit_before, unit_after in parts:
        if isinstance(stage, PrandtlIshlinskii):
            _draw_weights(next(free), stage, standard_errors, unit_before, unit_after)
            _draw_loading_curve(next(free), stage, before, unit_before, unit_after)
        elif isinstance(stage, RambergOsgood | MasingOperator):
            _draw_curve(next(free), stage, before, unit_before, unit_after)
        else:
            axes_of_map = next(free)
            axes_of_map.set_title("Envelope map" if before is u else "Output map")
            name = labels.input_name if before is u else "output of the plays"
            axes_of_map.set_xlabel(with_unit(name, unit_before))
            _draw_map(axes_of_map, before, after, unit_after)
    if not parts:
        _draw_line(axes[0], u, model, labels)
    if heading:
        figure.suptitle(heading)
    return figure


def stages_with_signals(model: Operator, u: Array) -> Iterator[tuple[Operator, Array, Array]]:
    """Go through the operators a model is made of, with the signal before and after each.

    Parameters
    ----------
    model
        Any operator.
    u
        Its input, shape (N,).

    Yields
    ------
    tuple
        Operator, its input, its output.

    Examples
    --------
    >>> from hyst.operators import Affine
    >>> [float(after[0]) for _, _, after in stages_with_signals(
    ...     Affine(2.0) @ Affine(1.0, 1.0), np.array([3.0]))]
    [4.0, 8.0]
    """
    if not isinstance(model, Chained):
        yield model, u, model(u)
        return
    signal = u
    for stage in model.parts:
        for leaf, before, after in stages_with_signals(stage, signal):
            yield leaf, before, after
            signal = after


def _units(stages: list[Operator], input_unit: str, output_unit: str) -> list[str]:
    """Units of the signals before and after every stage; empty where a gain has changed them."""
    keeps = [_keeps_unit(stage) for stage in stages]
    return [
        input_unit if all(keeps[:i]) else output_unit if all(keeps[i:]) else ""
        for i in range(len(stages) + 1)
    ]


def _keeps_unit(stage: Operator) -> bool:
    """Tell whether what goes through is only bent, turned over, shifted or delayed."""
    if isinstance(stage, Affine):
        return abs(stage.gain) == 1.0
    if isinstance(stage, DeadZone):
        return bool(np.isclose(stage.weights[stage.thresholds == 0.0].sum(), 1.0, rtol=1e-9))
    return isinstance(stage, LinearDynamics) and bool(np.isclose(stage.dc_gain(), 1.0, rtol=1e-6))


def _at_rest(stage: Operator) -> Operator:
    """Take the plays that a rate-dependent bank becomes at low rates; others as they are."""
    return stage.at_rest() if isinstance(stage, RateDependentPrandtlIshlinskii) else stage


def _is_drawn(stage: Operator) -> bool:
    return isinstance(stage, PrandtlIshlinskii | DeadZone | RambergOsgood | MasingOperator)


def _draw_weights(
    axes: Axes,
    plays: PrandtlIshlinskii,
    standard_errors: Mapping[str, float],
    unit_before: str,
    unit_after: str,
) -> None:
    errors = {"p": np.zeros(plays.p.size), "r": np.zeros(plays.p.size)}
    for name, value in standard_errors.items():
        entry = _ENTRY.fullmatch(name)
        if entry and 1 <= int(entry[2]) <= plays.p.size and np.isfinite(value):
            errors[entry[1]][int(entry[2]) - 1] = value
    axes.vlines(plays.r, 0.0, plays.p, color=MODELLED, linewidth=1.6)
    axes.errorbar(
        plays.r,
        plays.p,
        xerr=errors["r"],
        yerr=errors["p"],
        fmt="o",
        markersize=4.5,
        color=MODELLED,
        ecolor=MEASURED,
        elinewidth=1.0,
        capsize=2.5,
    )
    axes.axhline(0.0, color=FAINT, zorder=0)
    axes.set_xlim(left=0.0)
    axes.set_title(f"Weights over radii (p0 = {plays.p0:.3g})")
    axes.set_xlabel(with_unit("radius r", unit_before))
    what = "weight p, +- one standard error" if standard_errors else "weight p"
    axes.set_ylabel(with_unit(what, ratio_unit(unit_after, unit_before)))


def _draw_loading_curve(
    axes: Axes, plays: PrandtlIshlinskii, signal: Array, unit_before: str, unit_after: str
) -> None:
    end = max(0.5 * float(np.ptp(signal)), float(plays.r.max(initial=0.0)))
    rising = np.unique(np.concatenate([np.linspace(0.0, end, 200), plays.r]))
    axes.plot(rising, plays.initial_loading_curve(rising), color=MODELLED, label="plays")
    axes.plot(rising, plays.p0 * rising, color=SECOND, linestyle="--", label="linear part p0")
    axes.plot(plays.r, plays.initial_loading_curve(plays.r), ".", color=MODELLED)
    axes.set_title("Loading curve of the plays")
    axes.set_xlabel(with_unit("rise of their input from rest", unit_before))
    axes.set_ylabel(with_unit("rise of their output", unit_after))
    axes.legend(loc="upper left")


def _draw_curve(
    axes: Axes,
    stage: RambergOsgood | MasingOperator,
    signal: Array,
    unit_before: str,
    unit_after: str,
) -> None:
    rising = np.linspace(0.0, 0.5 * float(np.ptp(signal)), 200)
    axes.plot(rising, stage.curve(rising), color=MODELLED)
    axes.set_title("Loading curve")
    axes.set_xlabel(with_unit("rise of the input from rest", unit_before))
    axes.set_ylabel(with_unit("rise of the output", unit_after))


def _draw_map(axes: Axes, before: Array, after: Array, unit_after: str) -> None:
    order = np.argsort(before)
    x, y = before[order], after[order]
    slope = (y[-1] - y[0]) / (x[-1] - x[0]) if x[-1] > x[0] else 0.0
    axes.plot(x, y - y[0] - slope * (x - x[0]), color=MODELLED)
    axes.axhline(0.0, color=FAINT, zorder=0)
    axes.set_ylabel(with_unit(f"its output minus {slope:.3g} times its input", unit_after))


def _draw_line(axes: Axes, u: Array, model: Operator, labels: Labels) -> None:
    y = model(u)
    # Sorted by its input, the output of a model with memory would jump from branch to branch.
    memoryless = model.traits().memoryless
    order = np.argsort(u) if memoryless else np.arange(u.size)
    axes.plot(u[order], y[order], color=MODELLED)
    axes.set_title("The straight line" if memoryless else "Output over input")
    axes.set_xlabel(with_unit(labels.input_name, labels.input_unit))
    axes.set_ylabel(with_unit(labels.output_name, labels.output_unit))
