"""Where the records of a fleet come from: records, or what loads one where it is fitted."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol, runtime_checkable

from hyst.errors import InputError
from hyst.operators.provenance import data_hash
from hyst.signals import Record

MOST_NAMED = 5
"""Of a list of identifiers in a message."""


@runtime_checkable
class MeasurementSource(Protocol):
    """What names one device and loads its record; it is sent to where the record is fitted.

    It may have more: ``file``, a text for the table; ``fingerprint()``, a text that changes when
    the data do; ``limits``, of this device alone.
    """

    @property
    def identifier(self) -> str:
        """Name of the device, different from all others of the fleet."""

    def load(self) -> Record:
        """Give the record."""


@dataclass(frozen=True)
class Measurement:
    """A source with all that a fleet asks of one.

    Parameters
    ----------
    identifier
        Of the device.
    source
        What was given: a record, or what loads one.
    file
        For the table.
    limits
        Of this device alone, by quantity: lowest and highest value, None where there is none.
    """

    identifier: str
    source: Any
    file: str = ""
    limits: Mapping[str, tuple[float | None, float | None]] = field(default_factory=dict)

    def load(self) -> Record:
        """Give the record.

        Raises
        ------
        InputError
            If what was loaded is none.
        """
        if isinstance(self.source, Record):
            return self.source
        record = self.source.load()
        if not isinstance(record, Record):
            raise InputError(
                f"the source of {self.identifier} loads a {type(record).__name__}; it has to load "
                "a hyst.Record"
            )
        return record

    def fingerprint(self) -> str:
        """Give a text that is another one when the data are; empty where nothing tells."""
        if isinstance(self.source, Record):
            about = (self.source.input_unit, self.source.output_unit)
            return hashlib.sha256(repr((data_hash([self.source]), about)).encode()).hexdigest()
        told = getattr(self.source, "fingerprint", None)
        try:
            return str(told()) if callable(told) else ""
        except OSError:
            return ""  # loading it says what is wrong


def measurements_of(records: Any, identifiers: Sequence[str] | None) -> tuple[Measurement, ...]:
    """Name every record of a fleet.

    Parameters
    ----------
    records
        Records or sources, or a mapping of identifiers to them.
    identifiers
        Names in the order of the records; by default those of the sources, else numbers from 1.

    Raises
    ------
    InputError
        If there is no record, one is of another kind, names are missing, empty or given twice.
    """
    if isinstance(records, Mapping):
        if identifiers is not None:
            raise InputError("identifiers are given beside a mapping, which has its own; leave out")
        records, identifiers = list(records.values()), [str(each) for each in records]
    if isinstance(records, str | Record) or not isinstance(records, Iterable):
        raise InputError(
            f"records are of type {type(records).__name__}; give a list of hyst.Record, one a "
            "device (files: hyst fleet on the command line)"
        )
    given = list(records)
    if not given:
        raise InputError("the fleet has no record; give one for each device")
    if identifiers is not None and len(identifiers) != len(given):
        raise InputError(
            f"{len(identifiers)} identifiers for {len(given)} records; give one for each"
        )
    digits = len(str(len(given)))
    names = [
        _name_of(each, number, digits) if identifiers is None else identifiers[number - 1]
        for number, each in enumerate(given, 1)
    ]
    _require_different(names)
    return tuple(
        Measurement(name, each, str(getattr(each, "file", "")), getattr(each, "limits", {}))
        for name, each in zip(names, given, strict=True)
    )


def _name_of(source: Any, number: int, digits: int) -> str:
    if isinstance(source, Record):
        return f"{number:0{digits}d}"
    if not callable(getattr(source, "load", None)):
        raise InputError(
            f"record {number} is of type {type(source).__name__}; give a hyst.Record, or an object "
            "with identifier and load()"
        )
    return getattr(source, "identifier", f"{number:0{digits}d}")


def _require_different(names: Sequence[Any]) -> None:
    for number, each in enumerate(names, 1):
        if not isinstance(each, str) or not each.strip() or not each.isprintable():
            raise InputError(f"identifier {number} is {each!r}; give a text that can be printed")
    twice = [name for name, count in Counter(names).items() if count > 1]
    if twice:
        more = f" and {len(twice) - MOST_NAMED} more" if len(twice) > MOST_NAMED else ""
        raise InputError(
            f"identifiers are given twice: {', '.join(twice[:MOST_NAMED])}{more}; each device "
            "needs its own"
        )
