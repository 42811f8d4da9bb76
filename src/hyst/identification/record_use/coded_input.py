"""Records whose input is in codes of a driver: volts before anything else, and told at the end."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from hyst.errors import InputError
from hyst.identification.result.identified import Identified
from hyst.operators import Driver
from hyst.signals import Record

_COUNTS = (
    "",
    "1",
    "-",
    "code",
    "codes",
    "count",
    "counts",
    "lsb",
    "digit",
    "digits",
    "bit",
    "bits",
)
_DRIVE = "drive"  # the name of volts whose codes had one


def in_volts(record: Record, driver: Driver | None, name: str = _DRIVE) -> Record:
    """Give a record whose input is in codes with the volts that the driver gave.

    Parameters
    ----------
    record
        Its input is whole codes of the driver.
    driver
        Its table; None where the input is in volts already.
    name
        Of the volts.

    Raises
    ------
    InputError
        If the input has a unit that codes do not have, or a sample is no code of the driver; the
        first such index is named.
    """
    if driver is None:
        return record
    if not isinstance(driver, Driver):
        raise InputError(f"driver is a {type(driver).__name__}; give a hyst.Driver")
    if record.input_unit.strip().lower() not in _COUNTS:
        raise InputError(
            f"input {record.input_name!r} is in {record.input_unit!r}, and a driver's table is for "
            "an input in codes; leave the driver out, or name the column of codes"
        )
    try:
        u = driver.volts(record.u)
    except InputError as refusal:
        raise InputError(f"input {record.input_name!r}: {refusal}") from None
    return replace(record, u=u, input_name=name, input_unit=driver.unit)


def all_in_volts(records: Iterable[Record], driver: Driver | None) -> tuple[Record, ...]:
    """Give ``records`` as ``in_volts`` gives each with a ``driver``."""
    return tuple(in_volts(each, driver) for each in records)


def with_driver(found: Identified, driver: Driver | None) -> Identified:
    """Give a result whose description keeps the driver.

    Parameters
    ----------
    found
        As identified from volts.
    driver
        None changes nothing.
    """
    if driver is None:
        return found
    about = replace(found.description, driver=driver)
    return replace(found, description=about, model=found.model.with_description(about))
