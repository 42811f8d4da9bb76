"""Tables of loops behind the dynamics."""

from __future__ import annotations

import math

import numpy as np

from hyst.compensation import LoopsBehind
from hyst.report.table import Table, number, with_unit


def loops_table(found: LoopsBehind) -> Table:
    """List how far the loop of each record is from the hysteresis of the model.

    Parameters
    ----------
    found
        The loops.

    Returns
    -------
    Table
    """
    unit = found.loops[0].record.output_unit
    return Table(
        "Loops by record: v from the output minus v by the model's hysteresis, mean taken out",
        (
            "record",
            "samples seen",
            "seen up to [Hz]",
            with_unit("rms", unit and f"[{unit}]"),
            "rms [% of range]",
            "max [% of range]",
            "beside noise [%]",
            with_unit("noise +-", unit and f"[{unit}]"),
            with_unit("mean", unit and f"[{unit}]"),
        ),
        tuple(
            (
                each.name,
                str(each.valid.stop - each.valid.start),
                "all" if each.seen_through.band is None else number(each.seen_through.band),
                number(each.metrics.rms),
                f"{each.metrics.rms_percent:.3f}",
                f"{each.metrics.max_percent:.3f}",
                f"{each.beside_noise_percent:.3f}",
                number(each.band, 3),
                number(each.offset, 3),
            )
            for each in found.loops
        ),
    )


def repeated_loops_table(found: LoopsBehind) -> Table:
    """List gain, phase and area of each loop that repeats, by frequency, beside the model's.

    Parameters
    ----------
    found
        The loops.

    Returns
    -------
    Table
        Without rows where no input repeats.
    """
    first = found.loops[0].record
    unit = f"[{first.input_unit}]" if first.input_unit else ""
    return Table(
        "Loops by frequency",
        (
            "frequency [Hz]",
            "record",
            "cycles",
            with_unit("input from", unit),
            with_unit("to", unit),
            "gain [% of model]",
            "phase [degrees]",
            "area",
            "standard error",
            "of the model",
        ),
        tuple(
            (
                number(each.frequency),
                found.loops[each.record].name,
                str(each.cycles.cycles),
                number(each.cycles.low),
                number(each.cycles.high),
                "-" if math.isnan(abs(each.ratio)) else f"{100.0 * abs(each.ratio):.2f}",
                f"{float(np.degrees(np.angle(each.ratio))):.2f}",
                number(each.area),
                number(each.area_standard_error, 2),
                number(each.modelled_area),
            )
            for each in sorted(found.repeated, key=lambda loop: loop.frequency)
        ),
    )
