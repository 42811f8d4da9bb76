"""hyst adapt: follow a model's constants along a record."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from numpy.typing import NDArray

import hyst
from hyst._files import replacing_files, require_folder
from hyst.cli.arguments import (
    load_operator,
)
from hyst.cli.console import at_work, note, show_files, show_table
from hyst.cli.reading_options import read_told, reads_records

Files = Annotated[
    list[Path],
    typer.Argument(
        metavar="MODEL DATA",
        show_default=False,
        help="Model file and measured record; with --resume the record alone.",
    ),
]
Folder = Annotated[
    Path, typer.Option("-o", "--out", metavar="DIR", show_default=False, help="Where to write.")
]
Memory = Annotated[
    float | None,
    typer.Option(
        metavar="SECONDS",
        show_default="nothing is forgotten",
        help="Time over which the past is forgotten, for constants that drift.",
    ),
]
Spread = Annotated[
    float | None,
    typer.Option(
        metavar="SHARE", show_default="0.3", help="How far off the model may be: 0.3 is 30 percent."
    ),
]
Maps = Annotated[
    bool, typer.Option("--estimate-maps", help="Estimate the maps before and after the plays too.")
]
Resume = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        show_default=False,
        help="Go on from the estimator.json of an earlier run; it has the model and all options.",
    ),
]
Start = Annotated[
    int,
    typer.Option(
        metavar="N", min=0, help="First sample to learn from; earlier ones set the memory."
    ),
]

_ROWS = 2000
_SPREAD = 0.3
_HEADING = "Estimates along {}, bands of two standard errors"


def _only(records: tuple[hyst.Record, ...]) -> hyst.Record:
    if len(records) > 1:
        raise hyst.InputError(
            f"--table all gives {len(records)} records, adapt takes one; name one"
        )
    return records[0]


@reads_records
def adapt(
    files: Files,
    folder: Folder,
    how: dict[str, Any],
    start: Start = 0,
    memory: Memory = None,
    spread: Spread = None,
    estimate_maps: Maps = False,
    resume: Resume = None,
) -> None:
    """Estimate a model's constants sample by sample along a record; write them over time."""
    require_folder(folder)
    model_file, data = _model_and_data(files, resume)
    estimator: hyst.online.JointEstimator | None = None
    if resume is not None:
        _refuse_options_of_a_start(resume, memory is not None, spread is not None, estimate_maps)
        estimator, model = _resumed(resume, model_file)
    else:
        model = load_operator(model_file or data)
    about = model.description
    measured = _only(read_told(data, **how))
    history, record = _from_start(_without_delay(measured, about.delay), start)
    if estimator is None:
        estimator = _started(model, record.dt, memory, spread, estimate_maps)
    if history.size:
        estimator.follow(history)
    before = estimator.parameters
    with at_work("estimating") as say:
        trajectory = estimator.run(record, max(1, record.samples // _ROWS))
        _refuse_if_few_used(estimator, data)
        say("figure")
        picture = _picture(estimator.model, about, trajectory, _HEADING.format(data.name))
    names = ("model.json", "estimator.json", "parameters.csv", "parameters.png")
    estimator.description = _described(estimator, about, measured)
    with replacing_files(folder) as temporary:
        estimator.model.save(temporary / names[0])
        estimator.save(temporary / names[1])
        _write_parameters(temporary / names[2], trajectory)
        (temporary / names[3]).write_bytes(picture)
    _tell(estimator, before.tolist(), about)
    show_files([folder / name for name in names])


def _started(
    model: hyst.operators.Operator,
    dt: float,
    memory: float | None,
    spread: float | None,
    estimate_maps: bool,
) -> hyst.online.JointEstimator:
    """Make the estimator that knows nothing but the model yet."""
    widths = _SPREAD if spread is None else spread
    return hyst.online.JointEstimator(
        model,
        dt=dt,
        memory=math.inf if memory is None else memory,
        radius_spread=widths,
        weight_spread=widths,
        estimate_maps=estimate_maps,
    )


def _described(
    estimator: hyst.online.JointEstimator,
    about: hyst.operators.ModelDescription,
    measured: hyst.Record,
) -> hyst.operators.ModelDescription:
    """Give the model's description with the origin of the estimate in the place of its own."""
    asked = {name: each for name, each in estimator.settings.items() if name != "model"}
    return replace(
        about.of_estimate(),
        dt=measured.dt,
        provenance=hyst.operators.provenance.provenance([measured], asked),
    )


def _refuse_if_few_used(estimator: hyst.online.JointEstimator, data: Path) -> None:
    counts = estimator.counts
    if counts["refused"] >= counts["used"]:
        raise hyst.InputError(
            f"{data} led to an overflow at {counts['refused']} samples and taught at "
            f"{counts['used']}; give the columns in the units of the model"
        )


def _refuse_options_of_a_start(resume: Path, *given: bool) -> None:
    if any(given):
        raise hyst.InputError(
            f"{resume} has its own memory, spread and maps; leave out --memory, --spread and "
            "--estimate-maps with --resume"
        )


def _picture(
    model: hyst.operators.Operator,
    about: hyst.operators.ModelDescription,
    trajectory: hyst.online.Trajectory,
    heading: str,
) -> bytes:
    units = hyst.online.units_of_plays(model, about.input_unit, about.output_unit)
    return hyst.report.draw_estimates({"": trajectory}, {}, heading, units)


def _model_and_data(files: list[Path], resume: Path | None) -> tuple[Path | None, Path]:
    if len(files) == 2:
        return files[0], files[1]
    if len(files) == 1 and resume is not None:
        return None, files[0]
    wanted = "MODEL and DATA" if resume is None else "DATA, or MODEL and DATA,"
    raise hyst.InputError(f"there are {len(files)} files ({_names(files)}); give {wanted} here")


def _names(files: list[Path]) -> str:
    return ", ".join(str(each) for each in files)


def _resumed(
    path: Path, model_file: Path | None
) -> tuple[hyst.online.JointEstimator, hyst.operators.Operator]:
    """Give the estimator, and the model that says what its numbers mean."""
    estimator = hyst.load(path)
    if not isinstance(estimator, hyst.online.JointEstimator):
        raise hyst.InputError(f"{path} holds no joint estimator; give one that hyst adapt wrote")
    if model_file is None:
        return estimator, estimator.model
    given = load_operator(model_file)
    if given.to_dict() not in (estimator.settings["model"], estimator.model.to_dict()):
        raise hyst.InputError(
            f"{model_file} is not the model that {path} started from or ended with; leave the "
            "model out to go on, or --resume to start anew from it"
        )
    return estimator, given


def _without_delay(record: hyst.Record, delay: float) -> hyst.Record:
    """Set input and output side by side; part of a sample is taken off the input."""
    if delay == 0:
        return record
    whole = math.floor(delay)
    if abs(whole) >= record.samples:
        raise hyst.InputError(
            f"the model's delay is {delay:.4g} samples but the record has {record.samples}; "
            "give a longer record"
        )
    ahead, behind = max(-whole, 0), max(whole, 0)
    u = hyst.identification.later(record.u, delay - whole)[ahead : record.samples - behind]
    return replace(record, u=u, y=record.y[behind : record.samples - ahead])


def _from_start(record: hyst.Record, start: int) -> tuple[NDArray[np.float64], hyst.Record]:
    """Split a record into the inputs that only set the memory, and what is learnt from."""
    if start > record.samples - 2:
        raise hyst.InputError(
            f"--start is {start} but the record has {record.samples} samples; leave two or more to "
            "learn from"
        )
    return record.u[:start], record.slice(start, record.samples)


def _write_parameters(path: Path, trajectory: hyst.online.Trajectory) -> None:
    columns = [trajectory.time]
    headers = ["time [s]"]
    for index, name in enumerate(trajectory.names):
        columns += [trajectory.values[:, index], trajectory.standard_errors[:, index]]
        headers += [name, f"{name} standard error"]
    hyst.io.write_columns(path, headers, columns)


def _tell(
    estimator: hyst.online.JointEstimator,
    before: list[float],
    about: hyst.operators.ModelDescription,
) -> None:
    number = hyst.report.number
    rows = tuple(
        (name, number(start), number(value), number(error) if error > 0.0 else "held")
        for name, start, value, error in zip(
            estimator.names,
            before,
            estimator.parameters.tolist(),
            estimator.standard_errors.tolist(),
            strict=True,
        )
    )
    show_table(
        hyst.report.Table("Estimates", ("constant", "before", "after", "standard error"), rows)
    )
    if any(name.startswith(("front", "back")) for name in estimator.names):
        print("front, back: weights of the maps before and after the plays")
    counts = estimator.counts
    noise = number(estimator.noise)
    print(f"\nnoise of the output: {noise}; {counts['used']} samples used")
    if counts["skipped"] or counts["refused"]:
        note(f"{counts['skipped']} samples were not finite, {counts['refused']} led to an overflow")
    print(f"excitation: {estimator.excitation}")
    innovation = estimator.innovation
    if innovation.consistent:
        print(f"innovation: {innovation}")
    else:
        note(
            f"innovation: {innovation}; the bands are then too narrow, since they take errors for "
            "noise"
        )
    if innovation.replacements:
        print(f"search: another start did better, {innovation.replacements} of {innovation.rivals}")
    if about.verdict is not None and about.is_unfit:
        note(
            "the model it started from is unfit, and the estimate has its shape: "
            f"{about.verdict.sentences[0]}"
        )
