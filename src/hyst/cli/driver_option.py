"""The option --driver: the table of a converter that is commanded in codes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

import hyst

_HOW = "FILE|linear:.."
_LINEAR = "linear:"
_CODES = ("code", "codes", "count", "counts", "lsb")

DriverOfInput = Annotated[
    str | None,
    typer.Option(
        "--driver",
        metavar=_HOW,
        show_default=False,
        help="The input is in codes: its driver's table (columns code and volt), or "
        "linear:VOLTS_PER_CODE,VOLTS_OF_0,LOW,HIGH.",
    ),
]
DriverOfCommand = Annotated[
    str | None,
    typer.Option(
        "--driver",
        metavar=_HOW,
        show_default="that of the model file, if it has one",
        help="Give the command in codes too: the driver's table (columns code and volt), or "
        "linear:VOLTS_PER_CODE,VOLTS_OF_0,LOW,HIGH.",
    ),
]
DriverOfDrive = Annotated[
    str,
    typer.Option(
        "--driver",
        metavar=f"auto|none|{_HOW}",
        help="Of C: step in codes too. auto: by the driver of the model file; or the driver's "
        "table (columns code and volt), or linear:VOLTS_PER_CODE,VOLTS_OF_0,LOW,HIGH.",
    ),
]


def driver_of(text: str | None) -> hyst.Driver | None:
    """Read a driver as it was typed.

    Parameters
    ----------
    text
        A file, or ``linear:`` and four numbers with commas between them; None for no driver.

    Raises
    ------
    InputError
        If it is neither, or no driver has such a table.
    """
    if text is None:
        return None
    if not text.startswith(_LINEAR):
        return hyst.io.read_driver(Path(text))
    given = text.removeprefix(_LINEAR).split(",")
    try:
        scale, offset = (float(each) for each in given[:2])
        low, high = (int(each) for each in given[2:])
    except ValueError:
        raise hyst.InputError(
            f"--driver is {text!r}; give a file, or linear: with volts a code, volts of code 0, "
            "lowest and highest code, as linear:0.0366,0,0,4095"
        ) from None
    return hyst.Driver.linear(scale, offset, low, high)


def says_codes(name: str, unit: str) -> bool:
    """Tell whether a column called ``name`` in a ``unit`` is one of codes, by what it says."""
    return name.strip().lower() in _CODES or unit.strip().lower() in _CODES


def volts_of_record(
    record: hyst.Record, typed: hyst.Driver | None, known: hyst.Driver | None
) -> hyst.Record:
    """Give a record in volts where its input is in codes.

    Parameters
    ----------
    record
        As read.
    typed
        The driver that the user gives for inputs in codes; None if none was given.
    known
        That of a model, for columns that say that they are codes.
    """
    told = says_codes(record.input_name, record.input_unit)
    return hyst.identification.in_volts(record, typed or (known if told else None))


def refuse_several_drivers(models: Iterable[hyst.Operator], records: Iterable[hyst.Record]) -> None:
    """Refuse records in codes that models with different drivers would read differently."""
    drivers = {each.description.driver for each in models} - {None}
    coded = [each for each in records if says_codes(each.input_name, each.input_unit)]
    if len(drivers) > 1 and coded:
        raise hyst.InputError(
            f"the input {coded[0].input_name!r} is in codes and the models have {len(drivers)} "
            "different drivers; give that of the record with --driver"
        )


def refuse_codes(driver: hyst.Driver | None, source: str) -> None:
    """Refuse an input that says codes where a model has a ``driver`` and volts are taken."""
    if driver is not None:
        raise hyst.InputError(
            f"the input of {source} is in codes and the model takes {driver.unit or 'volts'}, and "
            "a file that grows is not converted; log the drive in volts"
        )


def common_driver(models: Iterable[hyst.Operator]) -> hyst.Driver | None:
    """Give the driver that models have in their descriptions, if they agree on one."""
    drivers = {each.description.driver for each in models} - {None}
    return drivers.pop() if len(drivers) == 1 else None


def driver_for(text: str | None, about: hyst.ModelDescription) -> hyst.Driver | None:
    """Give the driver that was typed, or else that of the model.

    Parameters
    ----------
    text
        As typed.
    about
        Of the model, whose input the driver gives.

    Raises
    ------
    InputError
        As ``driver_of``, or if the driver gives another unit than the model takes.
    """
    driver = driver_of(text) or about.driver
    if driver is not None and hyst.signals.units_differ(driver.unit, about.input_unit):
        if text is not None and text.startswith(_LINEAR):  # says no unit
            return replace(driver, unit=about.input_unit)
        raise hyst.InputError(
            f"the driver gives {driver.unit!r} but the model takes {about.input_unit!r}; hyst "
            "converts no units, so convert the table, or correct its header"
        )
    return driver


def driver_or_word(text: str, about: hyst.ModelDescription) -> hyst.Driver | str:
    """Give the driver that was typed for a model or an inverse, or the word auto or none.

    Parameters
    ----------
    text
        As typed.
    about
        Of what is exported.
    """
    driver = None if text in ("auto", "none") else driver_of(text)
    if driver is None:
        return text
    unit = about.output_unit if about.is_inverse else about.input_unit
    return replace(driver, unit=unit) if text.startswith(_LINEAR) else driver


def range_of_codes(
    input_range: tuple[float, float] | None, driver: hyst.Driver | None
) -> tuple[float, float] | None:
    """Give the range that a command may have: of its limits what a driver's codes reach.

    Parameters
    ----------
    input_range
        The limits; None for none.
    driver
        None for a drive that takes any volts.

    Raises
    ------
    InputError
        If no code is within the limits.
    """
    if driver is None:
        return input_range
    low, high = driver.volt_range
    if input_range is None:
        return low, high
    driver.codes_within(*input_range)
    return max(low, input_range[0]), min(high, input_range[1])
