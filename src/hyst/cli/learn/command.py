"""hyst learn: the next command of a motion that repeats, from what the commands before led to."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

import hyst
from hyst.cli.arguments import (
    DespiteVerdict,
    ModelFile,
    history_of,
    load_operator,
    numbers,
    refuse_inputs_as_outputs,
)
from hyst.cli.command_over import tell_virgin, write_command
from hyst.cli.console import at_work, note
from hyst.cli.driver_option import DriverOfCommand, driver_for, range_of_codes
from hyst.cli.exit_codes import DONE, UNFIT
from hyst.cli.learn.coded import in_codes_of
from hyst.cli.learn.measured import read_measured
from hyst.cli.learn.reference import Reference, read_reference
from hyst.cli.learn.replay import Replayed, Wish, replay
from hyst.cli.learn.told import tell_files, tell_first, tell_learnt, write_extras
from hyst.cli.reading_options import may_read_records
from hyst.cli.scheduled import ScheduleValue, loaded
from hyst.cli.time_column import time_column

ReferenceFile = Annotated[
    Path,
    typer.Argument(metavar="REFERENCE", show_default=False, help="File with the wanted output."),
]
MeasuredFiles = Annotated[
    list[Path] | None,
    typer.Argument(
        metavar="[MEASURED]...",
        show_default=False,
        help="What was measured with the commands so far, in their order; none before the first.",
    ),
]
Column = Annotated[
    str,
    typer.Option(metavar="COL", show_default=False, help="Of the reference: name or index from 0."),
]
Out = Annotated[
    Path, typer.Option("-o", "--out", metavar="FILE", show_default=False, help="CSV to write.")
]
InputRange = Annotated[
    str | None,
    typer.Option(
        metavar="LOW,HIGH|none",
        show_default="the range the model was identified from",
        help="Range of the drive.",
    ),
]
RateLimit = Annotated[
    float | None,
    typer.Option(metavar="X", show_default=False, help="Largest rate of the drive, per second."),
]
Periodic = Annotated[
    bool,
    typer.Option("--periodic", help="The motion goes on without a pause: its end is its start."),
]
Noise = Annotated[
    float | None,
    typer.Option(
        metavar="S",
        show_default="from the repetitions",
        help="Standard deviation of the measured output's noise, output units.",
    ),
]
Slopes = Annotated[
    str | None,
    typer.Option(
        metavar="LOW,HIGH",
        show_default="as measured",
        help="Least and largest slope of the actuator behind the model's inverse.",
    ),
]
Repetitions = Annotated[
    int | None,
    typer.Option(
        metavar="N",
        min=1,
        show_default="as many as its length is of the reference's",
        help="How many repetitions each measured record holds.",
    ),
]
ReferenceRate = Annotated[
    float | None,
    typer.Option(
        metavar="HZ",
        show_default="its time column, or as measured",
        help="Samples of the reference per second.",
    ),
]
ReferenceTable = Annotated[
    int | None,
    typer.Option(metavar="N", show_default=False, help="Which of several tables it is in."),
]
ReferenceFormat = Annotated[
    str | None,
    typer.Option(metavar="FORMAT", show_default=False, help="Of its file, as --format."),
]
History = Annotated[
    str | None,
    typer.Option(
        metavar="U,U,...|FILE:COLUMN",
        show_default=False,
        help="Drive just before each repetition, which sets the memory: turns, or a record.",
    ),
]
Report = Annotated[
    Path | None,
    typer.Option(metavar="FILE", show_default=False, help="Page of HTML to write, with pictures."),
]
Figure = Annotated[
    Path | None, typer.Option(metavar="FILE", show_default=False, help="PNG to write.")
]


@may_read_records
def learn(
    model_file: ModelFile,
    reference: ReferenceFile,
    column: Column,
    out: Out,
    how: dict[str, Any],
    measured: MeasuredFiles = None,
    input_range: InputRange = None,
    rate_limit: RateLimit = None,
    periodic: Periodic = False,
    noise: Noise = None,
    history: History = None,
    slopes: Slopes = None,
    repetitions: Repetitions = None,
    reference_rate: ReferenceRate = None,
    reference_table: ReferenceTable = None,
    reference_format: ReferenceFormat = None,
    report: Report = None,
    figure: Figure = None,
    driver: DriverOfCommand = None,
    despite_verdict: DespiteVerdict = False,
    schedule_value: ScheduleValue = None,
) -> int:
    """Give the next command of a motion that repeats, learnt from the measured repetitions."""
    files = list(measured or [])
    read = [model_file, reference, *files]
    _refuse_clashes([out, report, figure], [*read, how["output_file"], _file_of(history)])
    model = _operator(model_file, schedule_value)
    about = model.description
    hyst.operators.verdict.refuse_if_unfit(about.verdict, "no command is made", despite_verdict)
    codes_of = driver_for(driver, about)
    whose = {"table": reference_table, "format": reference_format}
    wanted = read_reference(reference, column, whose, about, reference_rate)
    unit = wanted.unit or about.output_unit
    records = read_measured(files, how, about, unit, wanted.dt or model.dt, codes_of)
    wanted = wanted.timed(model, records, how["rate"])
    if rate_limit is not None and wanted.dt is None:
        raise hyst.InputError(
            "--rate-limit needs the sample time, and neither the reference nor the model tells it; "
            "give --reference-rate"
        )
    wish = Wish(
        range_of_codes(_range(input_range, about), codes_of),
        rate_limit,
        periodic,
        noise,
        None if history is None else history_of(history),
        None if slopes is None else _pair(slopes, "slopes", "the least and the largest slope"),
        repetitions,
    )
    names = [each.name for each in files]
    with at_work("learning") as say:
        done = replay(model, wanted, list(zip(names, records, strict=True)), wish, say)
    coded = in_codes_of(codes_of, done, model, wish)
    _write(done, about, wanted, out, (report, figure), read, coded)
    virgin = history is None and not periodic and model.initial_state().size > 0
    said = None if coded is None else coded.told(about.input_unit, about.output_unit)
    return _tell(done, about, [out, report, figure], virgin, said)


def _operator(file: Path, value: float | None) -> hyst.Operator:
    """Read a model file; a model over a second signal as it is at a value of that."""
    if value is None:
        return load_operator(file)
    found = loaded(file, None, value)
    assert isinstance(found, hyst.Operator)  # what is asked for at a value
    return found


def _refuse_clashes(outputs: list[Path | None], inputs: list[Path | None]) -> None:
    written = [each for each in outputs if each is not None]
    refuse_inputs_as_outputs(written, [each for each in inputs if each is not None])
    if len({each.resolve() for each in written}) < len(written):
        raise hyst.InputError("-o, --report and --figure name one file twice; name different ones")


def _file_of(history: str | None) -> Path | None:
    """Give the file that a history is in, if it is in one."""
    file, colon, _ = (history or "").rpartition(":")
    return Path(file) if colon else None


def _range(text: str | None, about: hyst.ModelDescription) -> tuple[float, float] | None:
    if text == "none":
        return None
    if text is not None:
        return _pair(text, "input-range", "the lowest and the highest drive, or none")
    if about.input_low is None or about.input_high is None:
        return None
    return about.input_low, about.input_high


def _pair(text: str, option: str, meant: str) -> tuple[float, float]:
    ends = numbers(text, option)
    if len(ends) != 2:
        raise hyst.InputError(f"--{option} is {text!r}; give {meant}")
    return ends[0], ends[1]


def _write(
    done: Replayed,
    about: hyst.ModelDescription,
    wanted: Reference,
    out: Path,
    extras: tuple[Path | None, Path | None],
    read: list[Path],
    coded: hyst.compensation.CodedCommand | None,
) -> None:
    """Write the page and the picture, and last the command, which is what is acted on."""
    write_extras(done, about, wanted, extras, read)
    rate = wanted.rate if wanted.rate_given else None
    time = time_column(wanted.file, rate, wanted.dt, wanted.y.size, **wanted.how)
    learner = done.learner
    expected = done.expected if coded is None else coded.y_predicted
    codes = None if coded is None else coded.codes
    write_command(out, about, time, (wanted.y, learner.command, expected), codes)


def _tell(
    done: Replayed,
    about: hyst.ModelDescription,
    files: list[Path | None],
    virgin: bool,
    of_codes: str | None,
) -> int:
    for sentence in done.notes:
        note(sentence)
    if done.learner.history:
        tell_learnt(done, about)
    else:
        tell_first(done, about)
        tell_virgin(virgin)
    if of_codes is not None:
        print(of_codes)
    tell_files(done, [each for each in files if each is not None])
    return UNFIT if about.is_unfit or done.stopped else DONE
