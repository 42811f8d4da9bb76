"""hyst simulate: the output of a model for an input of the user's."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import hyst
from hyst.cli.arguments import (
    ModelFile,
    SampleRate,
    require_same_unit,
    sample_time_known,
)
from hyst.cli.console import note, show_files
from hyst.cli.driver_option import DriverOfInput, driver_of, says_codes
from hyst.cli.reading_options import InputColumn, reads_columns
from hyst.cli.scheduled import (
    ScheduleColumn,
    ScheduleValue,
    loaded,
    model_at_rest,
    read_signal,
    refuse_what_is_fixed,
)
from hyst.cli.time_column import time_column

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from hyst.operators import ModelDescription


@reads_columns
def simulate(
    model_file: ModelFile,
    data: Annotated[
        Path, typer.Argument(metavar="DATA", show_default=False, help="File with the input.")
    ],
    input_column: InputColumn,
    how: dict[str, Any],
    out: Annotated[
        Path,
        typer.Option("-o", "--out", metavar="FILE", show_default=False, help="CSV file to write."),
    ],
    with_delay: Annotated[
        bool,
        typer.Option("--with-delay", help="Let the output lag as in the record identified from."),
    ] = False,
    rate: SampleRate = None,
    driver: DriverOfInput = None,
    schedule_column: ScheduleColumn = None,
    schedule_value: ScheduleValue = None,
) -> None:
    """Compute the output of a model for an input, sample by sample."""
    model = loaded(model_file, schedule_column, schedule_value)
    about = model.description
    sample_time_known(model_at_rest(model), data, rate, "the record", **how)
    u, name, unit = hyst.io.read_column(data, input_column, **how)
    table = driver_of(driver) or (about.driver if says_codes(name, unit) else None)
    if table is not None:
        u, unit = table.volts(u), table.unit
    require_same_unit(unit, about.input_unit, "the input")
    late = about.delay if with_delay else 0
    if isinstance(model, hyst.Scheduled):
        refuse_what_is_fixed(["--with-delay"], [with_delay])
        y = model.run(u, read_signal(model, data, str(schedule_column), u.size, how)).y
    else:
        y = hyst.identification.late_output(model, u, late)
    headers, columns = time_column(data, rate, model.dt, u.size, **how)
    headers += [
        hyst.io.join_unit(about.input_name, about.input_unit),
        hyst.io.join_unit(about.output_name, about.output_unit),
    ]
    hyst.io.write_columns(out, headers, [*columns, u, y])
    _note_extrapolation(u, about)
    if with_delay and about.delay < 0:
        note(hyst.report.delay_sentence(about.delay, about.dt, about.delay_interval))
    show_files([out])


def _note_extrapolation(u: NDArray[np.float64], about: ModelDescription) -> None:
    low, high = about.input_low, about.input_high
    if low is None or high is None or (u.min() >= low and u.max() <= high):
        return
    note(
        f"the input goes from {u.min():.6g} to {u.max():.6g}, the model was identified from "
        f"{low:.6g} to {high:.6g}; beyond that it is a guess"
    )
