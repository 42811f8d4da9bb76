"""Models over a second signal on the command line: its options, and what the verbs do with it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import hyst
from hyst._files import replacing
from hyst.cli.arguments import load_operator, numbers
from hyst.cli.console import at_work, note, show_files, show_table
from hyst.cli.exit_codes import DONE, UNFIT
from hyst.cli.fitted import HowToRead, write_fitted

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from hyst.operators import ModelDescription

Schedule = Annotated[
    str | None,
    typer.Option(
        metavar="S,S,..",
        show_default=False,
        help="Value of a second signal, as temperature, at which each record was taken: one model "
        "over it.",
    ),
]
ScheduleName = Annotated[
    str | None, typer.Option(metavar="NAME", show_default=False, help="What it is called.")
]
ScheduleUnit = Annotated[
    str | None, typer.Option(metavar="UNIT", show_default=False, help="Its unit.")
]
ValidateSchedule = Annotated[
    str | None,
    typer.Option(metavar="S,S,..", show_default=False, help="Its value for each --validate."),
]
ScheduleColumn = Annotated[
    str | None,
    typer.Option(
        metavar="COL", show_default=False, help="Column of the second signal of a scheduled model."
    ),
]
ScheduleValue = Annotated[
    float | None,
    typer.Option(
        metavar="S", show_default=False, help="Take a scheduled model as it is at this value."
    ),
]


@dataclass(frozen=True)
class About:
    """The second signal of records, as typed.

    Parameters
    ----------
    schedule, validate_schedule
        Its values for records and validation records.
    name, unit
        What it is.
    """

    schedule: str | None
    name: str | None
    unit: str | None
    validate_schedule: str | None

    def is_given(self) -> bool:
        """Tell whether there is one.

        Raises
        ------
        InputError
            If there is none, but more is said of it.
        """
        more = (self.name, self.unit, self.validate_schedule)
        if self.schedule is None and any(each is not None for each in more):
            raise hyst.InputError(
                "--schedule-name, --schedule-unit and --validate-schedule say more of --schedule; "
                "give it too"
            )
        return self.schedule is not None


def identify_over(
    data: Sequence[Path],
    validate: Sequence[Path] | None,
    folder: Path,
    files: HowToRead,
    about: About,
    asked: dict[str, Any],
) -> int:
    """Identify a model over a second signal, and write it, its numbers and a report at each value.

    Parameters
    ----------
    data, validate
        Files of records.
    folder
        Where to write.
    files
        How they are read.
    about
        The second signal.
    asked
        Further arguments of ``hyst.identify_scheduled``.
    """
    validate_schedule = about.validate_schedule
    if bool(validate) != (validate_schedule is not None):
        raise hyst.InputError(
            "--validate and --validate-schedule belong together where --schedule is given; give a "
            "value for each validation record"
        )
    with at_work("identifying") as say:
        say("reading")
        records, judged = files.records(data), files.validation(validate)
        values, at_validation = numbers(str(about.schedule), "schedule"), list[float]()
        if validate_schedule is not None:
            at_validation = numbers(validate_schedule, "validate-schedule")
        found = hyst.identify_scheduled(
            records,
            values,
            name=about.name or "s",
            unit=about.unit or "",
            validation=judged,
            validation_at=at_validation,
            progress=say,
            **asked,
        )
        say("report")
        written = _write(found, records, values, folder, files.sources)
    print(found.summary())
    show_files(written)
    return UNFIT if found.verdict.level == hyst.operators.verdict.UNFIT else DONE


def _write(
    found: hyst.IdentifiedSchedule,
    records: Sequence[hyst.Record],
    values: Sequence[float],
    folder: Path,
    sources: list[str],
) -> tuple[Path, ...]:
    folder.mkdir(exist_ok=True)
    written = [folder / "model.json", folder / "metrics.json"]
    found.model.save(written[0])
    with replacing(written[1]) as temporary:
        text = json.dumps(found.to_dict(), indent=2, allow_nan=False)
        temporary.write_text(text + "\n", encoding="utf-8")
    for value, result in zip(found.values, found.results, strict=True):
        places = [i for i, each in enumerate(values) if each == value]
        own, named = [records[i] for i in places], [sources[i] for i in places]
        pages = write_fitted(result, own, (), folder / f"at_{value:.6g}", named)
        written += [each for each in pages if each.suffix == ".html"]
    return tuple(written)


def loaded(path: Path, column: str | None, value: float | None) -> hyst.Operator | hyst.Scheduled:
    """Read a model file; a scheduled model stays one where its signal has a column.

    Parameters
    ----------
    path
        The model file.
    column, value
        Where the second signal is, or its value.

    Raises
    ------
    InputError
        If the file holds something else, or the second signal is not told or not needed.
    """
    found = hyst.load(path)
    if not isinstance(found, hyst.Scheduled):
        if column is not None or value is not None:
            raise hyst.InputError(
                f"{path} follows no second signal; leave out --schedule-column and --schedule-value"
            )
        return load_operator(path)
    if (column is None) == (value is None):
        raise hyst.InputError(
            f"{path} follows {found.name}; give its column with --schedule-column, or one value "
            "with --schedule-value"
        )
    return found if value is None else frozen(found, value)


def loaded_at(path: Path, value: float | None) -> Any:
    """Read what a file holds; if a value is given, a scheduled model as it is there."""
    return hyst.load(path) if value is None else loaded(path, None, value)


def frozen(model: hyst.Scheduled, value: float) -> hyst.Operator:
    """Give a scheduled model as it is at one value; one outside its schedule is told."""
    operator = model.at(value)
    if model.outside(value):
        _tell_outside(model, f"{model.name} = {value:.6g} is")
    return operator


def model_at_rest(model: hyst.Operator | hyst.Scheduled) -> hyst.Operator:
    """Give a model as it is at its first value, for what holds at all of them."""
    return model.models[0] if isinstance(model, hyst.Scheduled) else model


def read_signal(
    model: hyst.Scheduled, path: Path, column: str, count: int, how: dict[str, Any]
) -> NDArray[np.float64]:
    """Read the second signal of a scheduled model, and say where it is outside the schedule.

    Parameters
    ----------
    model
        The model.
    path, column, how
        As of ``hyst.io.read_column``.
    count
        Samples of the other signal.
    """
    s, _, unit = hyst.io.read_column(path, column, **how)
    if hyst.signals.units_differ(unit, model.unit):
        raise hyst.InputError(
            f"{model.name} is in {unit!r} but the model's in {model.unit!r}; hyst converts no "
            "units, so convert the column, or correct its header"
        )
    if s.size != count:
        raise hyst.InputError(
            f"column {column!r} has {s.size} numbers and the other {count}; give one for each"
        )
    outside = int(model.outside(s).sum())
    if outside:
        _tell_outside(model, f"{model.name} is at {outside} of {count} samples")
    return s


def command_over(
    model: hyst.Scheduled,
    y_ref: NDArray[np.float64],
    s: NDArray[np.float64],
    history: Sequence[float],
    input_range: tuple[float, float] | None,
    despite_verdict: bool,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Give the command that makes the output follow a reference, and the output predicted.

    Parameters
    ----------
    model
        The model.
    y_ref, s
        Reference and second signal.
    history
        Inputs that the actuator passed just before.
    input_range
        That the command must keep; None for any.
    despite_verdict
        Whether an unfit model is used nevertheless.

    Raises
    ------
    InputError
        If the reference is out of reach, or the verdict is ``unfit``.
    NotInvertibleError
        As ``Scheduled.inverse``.
    """
    hyst.operators.verdict.refuse_if_unfit(
        model.description.verdict, "no command is made", despite_verdict
    )
    inverse = model.inverse()
    memory, solved = model.initial_state(), inverse.initial_state()
    if len(history):
        passed = model.run(history, float(s[0]))
        memory, solved = passed.state, inverse.run(passed.y, float(s[0])).state
    u = inverse.run(y_ref, s, solved).y
    predicted = model.run(u, s, memory).y
    if input_range is not None:
        beyond = (u < input_range[0]) | (u > input_range[1])
        if beyond.any():
            k = int(beyond.argmax())
            raise hyst.InputError(
                f"reference[{k}] = {y_ref[k]:.6g} needs an input of {u[k]:.6g}, outside "
                f"{input_range[0]:.6g} to {input_range[1]:.6g}; give a reference within reach, or "
                "other --limits"
            )
    rounding = float(abs(predicted - y_ref).max())
    unit = f" {model.description.output_unit}" if model.description.output_unit else ""
    print(
        f"exact for the model (rounding {rounding:.2g}{unit}); how far the actuator is from the "
        "model, hyst info and metrics.json tell at each value"
    )
    print(f"command from {u.min():.6g} to {u.max():.6g}")
    tell_virgin(not len(history) and memory.size > 0)
    return u, predicted


def tell_virgin(is_virgin: bool) -> None:
    """Say that no history was given to a model with memory, where that is so."""
    if is_virgin:
        print(
            "memory taken as virgin, as of an actuator never driven; if it was driven, give the "
            "turns of the drive just before with --history"
        )


def compensate_over(
    model: hyst.Scheduled,
    y_ref: NDArray[np.float64],
    s: NDArray[np.float64],
    history: str | None,
    input_range: tuple[float, float] | None,
    despite_verdict: bool,
    out: Path,
    time: tuple[list[str], list[Any]],
) -> None:
    """Write the command for a reference while the second signal moves.

    Parameters
    ----------
    model, y_ref, s, input_range, despite_verdict
        As of ``command_over``.
    history
        As typed.
    out
        The file to write.
    time
        Headers and columns that come first.
    """
    turns = () if history is None else numbers(history, "history")
    done = command_over(model, y_ref, s, turns, input_range, despite_verdict)
    write_command(out, model.description, time, (y_ref, *done))
    show_files([out])


def write_command(
    out: Path,
    about: ModelDescription,
    time: tuple[list[str], list[Any]],
    signals: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
) -> None:
    """Write reference, command and predicted output.

    Parameters
    ----------
    out
        The file to write.
    about
        Of the model, for units.
    time
        Headers and columns that come first.
    signals
        The three.
    """
    headers, columns = time
    named = (
        ("reference", about.output_unit),
        ("command", about.input_unit),
        ("predicted", about.output_unit),
    )
    headers = [*headers, *(hyst.io.join_unit(*each) for each in named)]
    hyst.io.write_columns(out, headers, [*columns, *signals])


def refuse_what_is_fixed(given: dict[str, bool]) -> None:
    """Refuse options that a model whose constants move does not take.

    Parameters
    ----------
    given
        By option: whether it was typed.
    """
    for option, typed in given.items():
        if typed:
            raise hyst.InputError(
                f"{option} is for models whose constants stand still; leave it out, or take the "
                "model at one value with --schedule-value"
            )


def tell(found: hyst.Scheduled) -> None:
    """Print the constants of a scheduled model over its signal."""
    unit = f" {found.unit}" if found.unit else ""
    moving, names = set(found.moving()), found.models[0].parameters().names
    rows = tuple(
        (name, *(f"{each.values[i]:.6g}" for each in found.parameters()))
        for i, name in enumerate(names)
        if name in moving
    )
    header = ("constant", *(f"{value:.6g}{unit}" for value in found.values))
    show_table(hyst.report.Table(f"over {found.name}, by straight lines", header, rows))
    print(f"{len(names) - len(rows)} of {len(names)} constants are the same at all values")
    try:
        found.inverse()
        print("invertible while it moves")
    except (hyst.NotInvertibleError, hyst.InputError) as refusal:
        print(f"not invertible while it moves: {refusal}")


def _tell_outside(model: hyst.Scheduled, what: str) -> None:
    note(
        f"{what} outside {model.values[0]:.6g} to {model.values[-1]:.6g}, where the model is "
        "known; its constants are held at the end there"
    )
