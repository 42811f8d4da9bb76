"""The model itself, as its operators say they are best drawn: weights, curves, maps or loops."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hyst.operators import Chained, Operator, Portrait
from hyst.operators.portrait import Panel
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
from hyst.report.forc_figure import draw_density

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


@dataclass(frozen=True, eq=False)
class _Part:
    """One operator of a model with its portrait and the signals around it."""

    portrait: Portrait
    before: Array
    after: Array
    labels: Labels
    standard_errors: Mapping[str, float]
    memoryless: bool
    is_first: bool


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
    panels = model_panels(model, u, labels, standard_errors)
    figure, axes = blank(len(panels), 1, 10.0 if len(panels) > 1 else 5.0, 3.9)
    for (_, draw), free in zip(panels, axes, strict=True):
        draw(free)
    if heading:
        figure.suptitle(heading)
    return figure


def model_panels(
    model: Operator, u: Array, labels: Labels, standard_errors: Mapping[str, float]
) -> list[tuple[Panel, Callable[[Axes], None]]]:
    """Give what there is to see of a model, panel by panel, and what draws it.

    Parameters
    ----------
    model, u, labels, standard_errors
        As for ``draw_model``.
    """
    parts = _parts(model, u, labels, standard_errors)
    panels = [(part, panel) for part in parts for panel in part.portrait.panels]
    if all(panel == "loop" for _, panel in panels):
        # Nothing to see inside: the whole says more than its pieces.
        return [("loop", partial(draw_whole_loop, model=model, u=u, labels=labels))]
    return [(panel, _brush(panel, part)) for part, panel in panels]


def _brush(panel: Panel, part: _Part) -> Callable[[Axes], None]:
    return lambda axes: _BRUSHES[panel](axes, part)


def draw_whole_loop(axes: Axes, model: Operator, u: Array, labels: Labels) -> None:
    """Draw the output of a model over its input ``u``, with ``labels``, on ``axes``."""
    memoryless = model.traits().memoryless
    _draw_loop(axes, _Part(Portrait(()), u, model(u), labels, {}, memoryless, is_first=True))


def _parts(
    model: Operator, u: Array, labels: Labels, standard_errors: Mapping[str, float]
) -> list[_Part]:
    """Take a model apart; a signal is called by what comes before it."""
    stages = list(stages_with_signals(model, u))
    units = _units([stage for stage, _, _ in stages], labels.input_unit, labels.output_unit)
    name, parts = "its input", []
    for (stage, before, after), (unit_before, unit_after) in zip(
        stages, pairwise(units), strict=True
    ):
        portrait, is_first = stage.portrait(), before is u
        called = Labels(
            labels.input_name if is_first else name,
            unit_before,
            labels.output_name if after is stages[-1][2] else "its output",
            unit_after,
        )
        memoryless = stage.traits().memoryless
        parts.append(_Part(portrait, before, after, called, standard_errors, memoryless, is_first))
        if "weights" in portrait.panels:
            name = "output of the plays"
    return parts


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
    keeps = [stage.keeps_unit() for stage in stages]
    return [
        input_unit if all(keeps[:i]) else output_unit if all(keeps[i:]) else ""
        for i in range(len(stages) + 1)
    ]


def _draw_weights(axes: Axes, part: _Part) -> None:
    portrait, labels = part.portrait, part.labels
    count = portrait.p.size
    errors = {"p": np.zeros(count), "r": np.zeros(count)}
    for name, value in part.standard_errors.items():
        entry = _ENTRY.fullmatch(name)
        if entry and 1 <= int(entry[2]) <= count and np.isfinite(value):
            errors[entry[1]][int(entry[2]) - 1] = value
    axes.vlines(portrait.r, 0.0, portrait.p, color=MODELLED, linewidth=1.6)
    axes.errorbar(
        portrait.r,
        portrait.p,
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
    axes.set_title(f"Weights over radii (p0 = {portrait.p0:.3g})")
    axes.set_xlabel(with_unit("radius r", labels.input_unit))
    what = "weight p, +- one standard error" if part.standard_errors else "weight p"
    axes.set_ylabel(with_unit(what, ratio_unit(labels.output_unit, labels.input_unit)))


def _draw_curve(axes: Axes, part: _Part) -> None:
    portrait, labels = part.portrait, part.labels
    assert portrait.curve is not None, "this panel comes with a curve"
    has_plays = "weights" in portrait.panels
    end = max(0.5 * float(np.ptp(part.before)), float(portrait.r.max(initial=0.0)))
    rising = np.union1d(np.linspace(0.0, end, 200), portrait.r)
    axes.plot(rising, portrait.curve(rising), color=MODELLED, label="plays")
    if has_plays:
        axes.plot(
            rising, portrait.p0 * rising, color=SECOND, linestyle="--", label="linear part p0"
        )
        axes.plot(portrait.r, portrait.curve(portrait.r), ".", color=MODELLED)
        axes.legend(loc="upper left")
    axes.set_title("Loading curve of the plays" if has_plays else "Loading curve")
    whose = "their" if has_plays else "the"
    axes.set_xlabel(with_unit(f"rise of {whose} input from rest", labels.input_unit))
    axes.set_ylabel(with_unit(f"rise of {whose} output", labels.output_unit))


def _draw_map(axes: Axes, part: _Part) -> None:
    order = np.argsort(part.before)
    x, y = part.before[order], part.after[order]
    slope = (y[-1] - y[0]) / (x[-1] - x[0]) if x[-1] > x[0] else 0.0
    axes.plot(x, y - y[0] - slope * (x - x[0]), color=MODELLED)
    axes.axhline(0.0, color=FAINT, zorder=0)
    axes.set_title("Envelope map" if part.is_first else "Output map")
    axes.set_xlabel(with_unit(part.labels.input_name, part.labels.input_unit))
    what = f"its output minus {slope:.3g} times its input"
    axes.set_ylabel(with_unit(what, part.labels.output_unit))


def _draw_loop(axes: Axes, part: _Part) -> None:
    # Sorted by its input, the output of a model with memory would jump from branch to branch.
    order = np.argsort(part.before) if part.memoryless else np.arange(part.before.size)
    axes.plot(part.before[order], part.after[order], color=MODELLED)
    axes.set_title("The straight line" if part.memoryless else "Output over input")
    axes.set_xlabel(with_unit(part.labels.input_name, part.labels.input_unit))
    axes.set_ylabel(with_unit(part.labels.output_name, part.labels.output_unit))


def _draw_relays(axes: Axes, part: _Part) -> None:
    portrait = part.portrait
    draw_density(axes, portrait.thresholds, portrait.density, part.labels.input_unit)
    axes.set_title(f"Density of the relays (p0 = {portrait.p0:.3g})")


_BRUSHES: dict[Panel, Callable[[Axes, _Part], None]] = {
    "weights": _draw_weights,
    "curve": _draw_curve,
    "map": _draw_map,
    "loop": _draw_loop,
    "relays": _draw_relays,
}
