"""Section of a report on what a periodic drive tells apart: response, noise and distortion."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hyst.errors import NotIdentifiableError
from hyst.identification.families.hammerstein import (
    BestLinearApproximation,
    best_linear_approximation,
)
from hyst.report.canvas import MEASURED, MODELLED, SECOND, blank, drawn, ratio_unit, with_unit
from hyst.report.identification_report import Section
from hyst.report.table import Table, number
from hyst.signals import Record

Array = NDArray[np.float64]

_FEWEST_PERIODS = 3  # one to settle, two to tell noise


def distortion_sections(records: Sequence[Record], period: int | None) -> tuple[Section, ...]:
    """Give the section on noise and distortion, line by line of a periodic drive.

    Parameters
    ----------
    records
        As measured, all their periods; one for each realisation of the phases.
    period
        Samples of a period, or None for a drive without one.

    Returns
    -------
    tuple of Section
        None where there is no period, a record has fewer than three, or no line is in all records.
    """
    if period is None or any(len(record) < _FEWEST_PERIODS * period for record in records):
        return ()
    try:
        levels = best_linear_approximation(records, period)
    except NotIdentifiableError:
        return ()
    return (_section(levels, records, period),)


def _section(levels: BestLinearApproximation, records: Sequence[Record], period: int) -> Section:
    lines = np.rint(levels.silent_frequency * period * records[0].dt).astype(int)
    is_even, units = lines % 2 == 0, (records[0].input_unit, records[0].output_unit)
    texts = [
        "A periodic drive tells noise, which changes from period to period, from distortion, which "
        f"does not. The first period of each record was left out; {len(records)} "
        f"realisation{'s' * (len(records) > 1)} of the drive.",
    ]
    if not levels.silent_frequency.size:
        texts.append(
            "All lines are driven, so that one realisation shows no distortion; an odd-multisine "
            "leaves lines silent, where the output shows it."
        )
    if len(records) == 1:
        texts.append("Several realisations of the phases would show distortion at driven lines.")
    return Section(
        heading="Noise and distortion, line by line",
        texts=tuple(texts),
        table=levels_table(levels, is_even, *units),
        picture="distortion.png",
        png=draw_levels(levels, is_even, *units),
        caption="Best linear approximation with what noise and distortion do to it, and the output "
        "at lines nothing was put into.",
    )


def levels_table(
    levels: BestLinearApproximation,
    is_even: NDArray[np.bool_],
    input_unit: str,
    output_unit: str,
) -> Table:
    """Give the levels as medians over the lines.

    Parameters
    ----------
    levels
        The best linear approximation.
    is_even
        Which of the silent lines are even.
    input_unit, output_unit
        Units.

    Returns
    -------
    Table
    """
    gain = ratio_unit(output_unit, input_unit)
    rows = [
        ("gain of driven lines", np.abs(levels.response), gain),
        ("its standard deviation by noise", levels.noise, gain),
        ("by distortion, one realisation", levels.distortion, gain),
        ("output at silent even lines", levels.silent_output[is_even], output_unit),
        ("output at silent odd lines", levels.silent_output[~is_even], output_unit),
        ("standard deviation of both by noise", levels.silent_noise, output_unit),
    ]
    known = [row for row in rows if row[1].size and np.isfinite(row[1]).all()]
    return Table(
        "Median over the lines",
        ("", "lines", "median"),
        tuple(
            (with_unit(name, unit), str(values.size), number(float(np.median(values))))
            for name, values, unit in known
        ),
    )


@drawn
def draw_levels(
    levels: BestLinearApproximation,
    is_even: NDArray[np.bool_],
    input_unit: str,
    output_unit: str,
) -> Figure:
    """Draw gain, noise and distortion over frequency, and the output at silent lines.

    Parameters
    ----------
    levels, is_even, input_unit, output_unit
        As of ``levels_table``.

    Returns
    -------
    bytes
        PNG.
    """
    has_silent = levels.silent_frequency.size > 0
    figure, panels = blank(1 + has_silent, 1, 10.0 if has_silent else 6.0, 3.9)
    gain = {
        "gain": (np.abs(levels.response), MODELLED),
        "noise": (levels.noise, MEASURED),
        "distortion, one realisation": (levels.distortion, SECOND),
    }
    _draw(panels[0], levels.frequency, gain)
    panels[0].set_title("Driven lines")
    panels[0].set_ylabel(with_unit("gain", ratio_unit(output_unit, input_unit)))
    if has_silent:
        output = {
            "even lines": (np.where(is_even, levels.silent_output, np.nan), SECOND),
            "odd lines": (np.where(is_even, np.nan, levels.silent_output), MODELLED),
            "noise": (levels.silent_noise, MEASURED),
        }
        _draw(panels[1], levels.silent_frequency, output)
        panels[1].set_title("Output at silent lines: even and odd distortion")
        panels[1].set_ylabel(with_unit("amplitude", output_unit))
    return figure


def _draw(axes: Axes, frequency: Array, curves: dict[str, tuple[Array, str]]) -> None:
    for name, (values, color) in curves.items():
        # What is exactly zero, or not known, has no place on this scale.
        shown = np.isfinite(values) & (values > 0.0)
        if shown.any():
            axes.loglog(frequency[shown], values[shown], ".", color=color, label=name)
    axes.set_xlabel("frequency [Hz]")
    axes.legend()
