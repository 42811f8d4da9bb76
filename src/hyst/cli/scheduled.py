"""Models over a second signal on the command line: its options, and what the verbs do with it."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
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

    def is_given(self, others: Mapping[str, bool]) -> bool:
        """Tell whether there is one.

        Parameters
        ----------
        others
            Options that do not go with it, and for each whether it was typed.

        Raises
        ------
        InputError
            If there is none, but more is said of it; or there is one beside what it excludes.
        """
        for option, typed in others.items():
            if self.schedule is not None and typed:
                raise hyst.InputError(f"{option} is not for --schedule; give one of them")
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
        found = with_driver_over(found, files.driver)
        written = _write(found, records, values, folder, files.sources)
    print(found.summary())
    show_files(written)
    return UNFIT if found.verdict.level == hyst.operators.verdict.UNFIT else DONE


def with_driver_over(
    found: hyst.IdentifiedSchedule, driver: hyst.Driver | None
) -> hyst.IdentifiedSchedule:
    """Give a result over a second signal whose descriptions keep the ``driver``, if any."""
    if driver is None:
        return found
    results = tuple(hyst.identification.with_driver(each, driver) for each in found.results)
    about = replace(found.description, driver=driver)
    return replace(found, model=found.model.with_description(about), results=results)


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


def refuse_what_is_fixed(options: Sequence[str], given: Sequence[bool]) -> None:
    """Refuse options that a model whose constants move does not take.

    Parameters
    ----------
    options, given
        The options, and for each whether it was typed.
    """
    for option, typed in zip(options, given, strict=True):
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
