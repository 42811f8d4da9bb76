"""What was learnt from repetition to repetition: error, output, and what is left of it."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from hyst.compensation import LearningCompensator
from hyst.report.canvas import FAINT, MEASURED, MODELLED, SECOND, blank, drawn, with_unit
from hyst.report.learning_tables import best_index, noise_of

Array = NDArray[np.float64]

_GREEN = "#047857"


@drawn
def draw_learning(
    learner: LearningCompensator,
    dt: float | None = None,
    *,
    output: tuple[str, str] = ("output", ""),
    command: tuple[str, str] = ("command", ""),
    heading: str = "",
) -> Figure:
    """Draw the error against the repetition, and reference, output, error and command over time.

    First, best and last repetition are shown; a grey band in the last errors is twice the noise.

    Parameters
    ----------
    learner
        With one repetition or more.
    dt
        Sample time, s; None to count samples.
    output, command
        Names and units of both signals.
    heading
        Line above the figure; empty for none.

    Returns
    -------
    bytes
        PNG.
    """
    figure, axes = blank(2, 3, 10.0, 9.0)
    against, drive, whole, first_error, close, difference = axes
    _draw_errors(against, learner, output[1])
    samples = np.arange(learner.y_ref.size)
    t, time = (samples, "sample") if dt is None else (samples * dt, "time [s]")
    shown = _shown(learner)
    whole.plot(t, learner.y_ref, color=MEASURED, linewidth=3.0, alpha=0.5, label="reference")
    history = learner.history
    start = history[0].command
    for label, k, colour in shown:
        each = history[k]
        error = each.y_measured - learner.y_ref
        whole.plot(t, each.y_measured, color=colour, linewidth=1.0, label=label)
        first_error.plot(t, error, color=colour, linewidth=0.9, label=label)
        drive.plot(t, each.command, color=colour, linewidth=1.0, label=label)
        if k > 0:
            close.plot(t, error, color=colour, linewidth=0.8, label=label)
            difference.plot(t, each.command - start, color=colour, linewidth=1.0, label=label)
    difference.plot(t, learner.command - start, "--", color="#111827", label="next")
    if len(shown) == 1:
        close.plot(t, history[0].y_measured - learner.y_ref, color=shown[0][2], label=shown[0][0])
    noise = noise_of(learner)
    if noise is not None:
        close.axhspan(-2.0 * noise, 2.0 * noise, color=FAINT, alpha=0.7, zorder=0, linewidth=0.0)
    titles = {
        drive: "Command",
        whole: "Reference and output",
        first_error: "Error",
        close: "Error, the first left out" if len(shown) > 1 else "Error",
        difference: "Change of the command since the first",
    }
    for each_axes, title in titles.items():
        each_axes.set(title=title, xlabel=time)
        each_axes.margins(x=0.01)
        each_axes.legend(loc="best")
    drive.set_ylabel(with_unit(*command))
    difference.set_ylabel(with_unit("change", command[1]))
    whole.set_ylabel(with_unit(*output))
    for each_axes in (first_error, close):
        each_axes.set_ylabel(with_unit("error", output[1]))
        each_axes.axhline(0.0, color=FAINT, zorder=0)
    if heading:
        figure.suptitle(heading)
    return figure


def _shown(learner: LearningCompensator) -> list[tuple[str, int, str]]:
    """Give label, index and colour of first, best and last repetition, each once."""
    last, best = len(learner.history) - 1, best_index(learner)
    named: dict[int, list[str]] = {}
    for what, k in (("first", 0), ("best", best), ("last", last)):
        named.setdefault(k, []).append(what)
    colours = {"first": MODELLED, "best": SECOND, "last": _GREEN}
    return [
        (f"{k + 1}: {', '.join(words)}", k, colours[words[0]]) for k, words in sorted(named.items())
    ]


def _draw_errors(axes: Axes, learner: LearningCompensator, unit: str) -> None:
    history, best = learner.history, best_index(learner)
    number = np.arange(1, len(history) + 1)
    rms = np.array([each.error_rms for each in history])
    largest = np.array([each.error_largest for each in history])
    axes.plot(number, largest, "s--", color=MEASURED, markersize=4.0, label="largest")
    axes.plot(number, rms, "o-", color=SECOND, label="rms")
    axes.plot(number[best], rms[best], "o", color=SECOND, markersize=11.0, fillstyle="none")
    noise = noise_of(learner)
    if noise is not None:
        axes.axhline(noise, color=_GREEN, linestyle=":", label="noise")
    if np.concatenate([rms, largest]).min() > 0.0:
        axes.set_yscale("log")
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set_xlim(0.5, len(history) + 0.5)
    axes.set(title="Error against repetition", xlabel="repetition")
    axes.set_ylabel(with_unit("error", unit))
    axes.legend(loc="best")
