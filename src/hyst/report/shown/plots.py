"""What ``plot`` of a record, a model, a result and a comparison draws, and on which axes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_vector
from hyst.errors import InputError
from hyst.identification import Comparison, Identified
from hyst.operators import Operator
from hyst.report.canvas import MEASURED, with_unit
from hyst.report.comparison_figures import (
    draw_errors_over_time,
    draw_hystereses,
    draw_loops_over_input,
)
from hyst.report.drawn_samples import drawn_path, drawn_samples
from hyst.report.error_figure import (
    draw_error_autocorrelation,
    draw_error_distribution,
    draw_error_over_input,
    draw_error_over_time,
)
from hyst.report.fitted_record import FittedRecord, fit_other_records, fit_records
from hyst.report.history_figure import draw_band, draw_output, draw_strokes
from hyst.report.loop_figure import draw_fitted_hysteresis, draw_fitted_loop
from hyst.report.model_figure import Labels, draw_whole_loop, model_panels
from hyst.report.shown.axes import Draw, Panels, drawn_on
from hyst.report.shown.interactive import interactive_figure
from hyst.signals import Record, units_differ

Array = NDArray[np.float64]

_STROKES, _SAMPLES = 8, 4000


def plot_record(
    record: Record, axes: Any, what: str | Sequence[str], interactive: bool
) -> Axes | Panels | Any:
    """Draw panels of a record.

    Parameters
    ----------
    record, axes, what, interactive
        As of ``Record.plot``, and what it is a method of.
    """
    u, y = record.u, record.y
    known: dict[str, Draw] = {
        "loop": partial(_draw_loop, record=record),
        "input": partial(_draw_signal, record=record, signal=u, role="input"),
        "output": partial(_draw_signal, record=record, signal=y, role="output"),
    }
    return _shown(known, axes, what, interactive)


def plot_identified(
    found: Identified,
    axes: Any,
    what: str | Sequence[str],
    records: Record | Sequence[Record] | None,
    interactive: bool,
) -> Axes | Panels | Any:
    """Draw panels of a result.

    Parameters
    ----------
    found, axes, what, records, interactive
        As of ``Identified.plot``, and what it is a method of.
    """
    fits = _fitted(found, records)
    known: dict[str, Draw] = {
        "loop": partial(draw_fitted_loop, fits=fits),
        "hysteresis": partial(draw_fitted_hysteresis, fits=fits),
        "output": partial(_draw_output, fit=fits[0]),
        "strokes": partial(draw_strokes, fit=fits[0]),
        "band": partial(draw_band, fit=fits[0]),
        "residual": partial(draw_error_over_time, fits=fits),
        "residual-input": partial(draw_error_over_input, fits=fits),
        "distribution": partial(draw_error_distribution, fits=fits),
        "autocorrelation": partial(draw_error_autocorrelation, fits=fits),
        "memory": partial(_draw_memory, found=found, fits=fits),
    }
    return _shown(known, axes, what, interactive)


def plot_comparison(
    found: Comparison, axes: Any, what: str | Sequence[str], interactive: bool
) -> Axes | Panels | Any:
    """Draw panels of a comparison.

    Parameters
    ----------
    found, axes, what, interactive
        As of ``Comparison.plot``, and what it is a method of.
    """
    known: dict[str, Draw] = {
        "loops": partial(_with_legend, draw=draw_loops_over_input, found=found),
        "hysteresis": partial(_with_legend, draw=draw_hystereses, found=found),
        "errors": partial(_with_legend, draw=draw_errors_over_time, found=found),
    }
    return _shown(known, axes, what, interactive)


def plot_operator(
    model: Operator,
    axes: Any,
    what: str | Sequence[str] | None,
    u: ArrayLike | None,
    interactive: bool,
) -> Axes | Panels | Any:
    """Draw panels of a model.

    Parameters
    ----------
    model, axes, what, u, interactive
        As of ``Operator.plot``, and what it is a method of.
    """
    drive = _drive_over_range(model) if u is None else finite_vector(u, "u")
    about = model.description
    labels = Labels(about.input_name, about.input_unit, about.output_name, about.output_unit)
    known: dict[str, Draw] = {"loop": partial(draw_whole_loop, model=model, u=drive, labels=labels)}
    for name, draw in model_panels(model, drive, labels, {}):
        known.setdefault(name, draw)
    return _shown(known, axes, tuple(known) if what is None else what, interactive)


def _shown(
    known: Mapping[str, Draw], axes: Any, what: str | Sequence[str], interactive: bool
) -> Axes | Panels | Any:
    """Draw the panels that are asked for, on axes or as an interactive figure."""
    names = (what,) if isinstance(what, str) else tuple(what)
    for name in names:
        if name not in known:
            raise InputError(f"what is {name!r}; choose one or more of {', '.join(known)}")
    if not names:
        raise InputError(f"what names no panel; choose one or more of {', '.join(known)}")
    draws = [known[name] for name in names]
    if not interactive:
        return drawn_on(axes, what, draws)
    if axes is not None:
        raise InputError(
            "axes and interactive=True are given; an interactive figure is not drawn on axes of "
            "matplotlib, so give one of them"
        )
    return interactive_figure(draws)


def _fitted(
    found: Identified, records: Record | Sequence[Record] | None
) -> tuple[FittedRecord, ...]:
    if records is None:
        return fit_records(found, found.kept_records(), ())[0]
    given = (records,) if isinstance(records, Record) else tuple(records)
    for each in given:
        if not isinstance(each, Record):
            raise InputError(f"records has a {type(each).__name__}; give a hyst.Record or several")
        _refuse_other_units(found, each)
    if not given:
        raise InputError("records is empty; give at least one, or leave it out")
    return fit_other_records(found, given)


def _refuse_other_units(found: Identified, record: Record) -> None:
    for what in ("input_unit", "output_unit"):
        own, its = getattr(found.description, what), getattr(record, what)
        if units_differ(own, its):
            raise InputError(
                f"{what} of a record is {its!r} and of the model {own!r}; hyst converts no units, "
                "so convert the signal, or correct its unit"
            )


def _draw_loop(axes: Axes, record: Record) -> None:
    axes.plot(*drawn_path(record.u, record.y), color=MEASURED, linewidth=1.0, label="record")
    axes.set_title("Loop")
    axes.set_xlabel(with_unit(record.input_name, record.input_unit))
    axes.set_ylabel(with_unit(record.output_name, record.output_unit))


def _draw_signal(axes: Axes, record: Record, signal: Array, role: str) -> None:
    shown = drawn_samples(signal)
    name, unit = getattr(record, f"{role}_name"), getattr(record, f"{role}_unit")
    axes.plot(shown * record.dt, signal[shown], color=MEASURED, linewidth=1.0, label="record")
    axes.set_title(role.capitalize())
    axes.set_xlabel("time [s]")
    axes.set_ylabel(with_unit(name, unit))
    axes.margins(x=0.01)


def _draw_output(axes: Axes, fit: FittedRecord) -> None:
    draw_output(axes, fit)
    axes.set_xlabel("time [s]")
    axes.legend(loc="upper right", ncols=3)


def _draw_memory(axes: Axes, found: Identified, fits: tuple[FittedRecord, ...]) -> None:
    """Draw what the model remembers by, or its loop where it has nothing inside to see."""
    about = found.description
    labels = Labels(about.input_name, about.input_unit, about.output_name, about.output_unit)
    errors = dict(zip(found.parameter_names, found.standard_errors.tolist(), strict=True))
    u = np.concatenate([fit.record.u for fit in fits])
    panels = model_panels(found.model, u, labels, errors)
    remembering = [draw for name, draw in panels if name in ("weights", "relays", "curve")]
    (remembering or [draw for _, draw in panels])[0](axes)


def _with_legend(axes: Axes, draw: Callable[[Axes, Comparison], None], found: Comparison) -> None:
    draw(axes, found)
    low, high = axes.get_ylim()
    entries = len(axes.get_legend_handles_labels()[1])
    axes.set_ylim(low, high + (0.03 + 0.075 * entries) * (high - low))
    # On a ground of its own, for errors that are cut off go through it.
    axes.legend(loc="upper left", frameon=True, framealpha=0.85, edgecolor="none")


def _drive_over_range(model: Operator) -> Array:
    """Give swings that shrink within the range a model was identified over."""
    low, high = model.description.input_low, model.description.input_high
    if low is None or high is None or not low < high:
        raise InputError(
            "the model does not say over which range it holds; give u, an input to draw it over"
        )
    swings = np.linspace(1.0, 0.2, _SAMPLES)
    wave = np.sin(np.linspace(0.0, 2.0 * np.pi * _STROKES, _SAMPLES)) * swings
    return 0.5 * (low + high) + 0.5 * (high - low) * wave
