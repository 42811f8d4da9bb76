"""hyst loop: the hysteresis behind the dynamics, seen in new records, and whether rate moves it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

import hyst
from hyst._files import replacing_files, require_folder
from hyst.cli.arguments import (
    ModelFile,
    load_operator,
    refuse_inputs_as_outputs,
    require_same_unit,
)
from hyst.cli.console import at_work, note, show_files, show_table
from hyst.cli.exit_codes import DONE, UNFIT
from hyst.cli.fitted import Folder, HowToRead
from hyst.cli.reading_options import reads_records

if TYPE_CHECKING:
    from hyst.compensation import LoopsBehind

Records = Annotated[
    list[Path],
    typer.Argument(
        metavar="RECORD...",
        show_default=False,
        help="New records: sines or triangles of one amplitude at several frequencies, three "
        "periods of each or more.",
    ),
]
Band = Annotated[
    float | None,
    typer.Option(
        metavar="HZ",
        show_default=False,
        help="Highest frequency to invert; by default all, or what zeros and noise allow.",
    ),
]
Level = Annotated[
    float,
    typer.Option(metavar="P", help="Chance to call loops different that differ by noise alone."),
]
Tolerance = Annotated[
    float,
    typer.Option(metavar="PERCENT", help="Distance of two loops, of range, that does not matter."),
]

FIGURE, NUMBERS = "loops.png", "metrics.json"


@reads_records
def loop(
    model_file: ModelFile,
    data: Records,
    how: dict[str, Any],
    folder: Folder,
    band: Band = None,
    level: Level = 0.01,
    tolerance: Tolerance = 0.5,
) -> int:
    """See the loop behind the dynamics of a model in new sines, and test if rate moves it."""
    require_folder(folder)
    with at_work("loops") as say:
        model = load_operator(model_file)
        files = HowToRead(how, {}, (None, None), known_driver=model.description.driver)
        say("reading")
        records = files.records(data)
        names = _names(files.sources)
        _refuse_other_units(model.description, records, names)
        outputs = [folder / name for name in (FIGURE, NUMBERS, *_tables(len(records)))]
        also = [] if how["output_file"] is None else [how["output_file"]]
        refuse_inputs_as_outputs(outputs, [model_file, *data, *also])
        say("inverting the dynamics")
        found = hyst.compensation.loops_behind(
            model, records, band=band, level=level, tolerance=tolerance, names=names
        )
        say("figure")
        with replacing_files(folder) as temporary:
            _write(found, temporary, files.sources, str(model_file))
    _tell(found, model.description)
    show_files(outputs)
    return DONE if found.holds else UNFIT


def _names(sources: Sequence[str]) -> list[str]:
    """Call records by their files, and by more of the path where files are called alike."""
    short = [Path(each).name for each in sources]
    return short if len(set(short)) == len(short) else list(sources)


def _tables(count: int) -> list[str]:
    return [f"loop-{number}.csv" for number in range(1, count + 1)]


def _refuse_other_units(
    about: hyst.ModelDescription, records: Sequence[hyst.Record], names: Sequence[str]
) -> None:
    for name, record in zip(names, records, strict=True):
        require_same_unit(record.input_unit, about.input_unit, f"the input of {name}")
        require_same_unit(record.output_unit, about.output_unit, f"the output of {name}")


def _write(found: LoopsBehind, folder: Path, sources: Sequence[str], model: str) -> None:
    numbers = found.to_dict() | {"model": model, "files": list(sources)}
    text = json.dumps(numbers, indent=2, allow_nan=False, ensure_ascii=False)
    (folder / NUMBERS).write_text(text + "\n", encoding="utf-8")
    (folder / FIGURE).write_bytes(hyst.report.draw_loops_behind(found))
    for name, each in zip(_tables(len(found.loops)), found.loops, strict=True):
        record, seen = each.record, each.valid
        join = hyst.io.join_unit
        headers = [
            "time [s]",
            join(record.input_name, record.input_unit),
            join(record.output_name, record.output_unit),
            join("v", record.output_unit),
            join("v by the model", record.output_unit),
            join("v +-", record.output_unit),
        ]
        band = np.full(len(record), each.band)
        columns = (record.time, record.u, record.y, each.v, each.modelled, band)
        hyst.io.write_columns(folder / name, headers, [column[seen] for column in columns])


def _tell(found: LoopsBehind, about: hyst.ModelDescription) -> None:
    for sentence in found.sentences():
        print(sentence)
    show_table(hyst.report.loops_table(found))
    by_frequency = hyst.report.repeated_loops_table(found)
    if by_frequency.rows:
        show_table(by_frequency)
    for sentence in found.notes:
        note(sentence)
    if about.is_unfit:
        note("the model was saved with the verdict unfit")
    for each in found.loops:
        _note_extrapolation(each.name, each.record, about)


def _note_extrapolation(name: str, record: hyst.Record, about: hyst.ModelDescription) -> None:
    low, high = about.input_low, about.input_high
    if low is None or high is None:
        return
    room = 0.01 * (high - low)
    if record.u.min() < low - room or record.u.max() > high + room:
        note(
            f"the input of {name} goes from {record.u.min():.6g} to {record.u.max():.6g}, the "
            f"model was identified from {low:.6g} to {high:.6g}; beyond that its hysteresis is a "
            "guess, the loop is not"
        )
