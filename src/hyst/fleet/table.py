"""The table of a fleet: a row for each device, columns by name."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.fleet.device import Device
from hyst.fleet.limits import broken_limits
from hyst.fleet.outliers import Judged
from hyst.fleet.quantities import ERROR, PARAMETER, QUANTITIES, unit_of

PASS, FAIL = "pass", "fail"


@dataclass(frozen=True, eq=False)
class FleetTable:
    """Columns of text or of numbers, all of one length.

    Parameters
    ----------
    columns
        By name: tuples of text, or vectors of float64 with NaN where there is no number.
    units
        Of the columns that have one, by name.

    Raises
    ------
    InputError
        If the columns differ in length.

    Examples
    --------
    >>> table = FleetTable({"identifier": ("a", "b"), "gain": np.array([1.0, 2.0])}, {})
    >>> len(table), table["gain"][1], table.row("b")
    (2, np.float64(2.0), {'identifier': 'b', 'gain': 2.0})
    """

    columns: Mapping[str, tuple[str, ...] | NDArray[np.float64]]
    units: Mapping[str, str]

    def __post_init__(self) -> None:
        lengths = {len(each) for each in self.columns.values()}
        if len(lengths) > 1:
            raise InputError(f"columns of a table have lengths {sorted(lengths)}; give one length")

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), ()))

    def __getitem__(self, name: str) -> Any:
        if name not in self.columns:
            raise InputError(f"the table has no column {name!r}; it has {', '.join(self.columns)}")
        return self.columns[name]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the columns."""
        return tuple(self.columns)

    def rows(self) -> Iterator[dict[str, Any]]:
        """Give the rows one after the other, as values by name of the column."""
        listed = {
            name: each if isinstance(each, tuple) else each.tolist()
            for name, each in self.columns.items()
        }
        for values in zip(*listed.values(), strict=True):
            yield dict(zip(listed, values, strict=True))

    def row(self, identifier: str) -> dict[str, Any]:
        """Give the row of one device.

        Parameters
        ----------
        identifier
            Of the device.

        Raises
        ------
        InputError
            If there is none of this name.
        """
        for each in self.rows():
            if each["identifier"] == identifier:
                return each
        raise InputError(f"the fleet has no device {identifier!r}")

    def header(self, name: str) -> str:
        """Give the name of a column with its unit.

        Parameters
        ----------
        name
            Of the column.
        """
        unit = self.units.get(name, "")
        return f"{name} [{unit}]" if unit else name


def table_of(
    devices: Sequence[Device],
    judged: Judged,
    limits: Mapping[str, Mapping[str, tuple[float | None, float | None]]],
    units: tuple[str, str],
) -> FleetTable:
    """Put the table of a fleet together.

    Parameters
    ----------
    devices
        In order.
    judged
        Which are odd.
    limits
        Of each device that has any, by identifier.
    units
        Of input and output.
    """
    reasons = {each.identifier: "; ".join(each.reasons) for each in judged.outliers}
    broken = {each.identifier: _broken(each, limits.get(each.identifier, {})) for each in devices}
    texts = {
        "identifier": [each.identifier for each in devices],
        "file": [each.file for each in devices],
        "status": [each.status for each in devices],
        "limits": [_passed(each.identifier, broken, limits) for each in devices],
        "limits_broken": ["; ".join(broken[each.identifier]) for each in devices],
        "outlier": ["yes" if each.identifier in reasons else "no" for each in devices],
        "outlier_why": [reasons.get(each.identifier, "") for each in devices],
        "family": [each.family for each in devices],
        "verdict": [each.verdict for each in devices],
        "sentence": [each.failure or each.sentence for each in devices],
    }
    numbers = {name: [each.numbers.get(name, math.nan) for each in devices] for name in QUANTITIES}
    numbers["distance"] = [judged.distances[each.identifier] for each in devices]
    for name in dict.fromkeys(name for each in devices for name in each.parameters):
        pairs = [each.parameters.get(name, (math.nan, math.nan)) for each in devices]
        numbers[PARAMETER + name] = [pair[0] for pair in pairs]
        numbers[ERROR + name] = [pair[1] for pair in pairs]
    columns: dict[str, Any] = {name: tuple(each) for name, each in texts.items()}
    columns |= {name: np.array(each, dtype=float) for name, each in numbers.items()}
    return FleetTable(columns, {name: unit_of(name, *units) for name in QUANTITIES})


def _broken(
    device: Device, limits: Mapping[str, tuple[float | None, float | None]]
) -> tuple[str, ...]:
    if not limits:
        return ()
    if device.failure:
        return ("there is no model",)
    parameters = {PARAMETER + name: value for name, (value, _) in device.parameters.items()}
    # Numbers of a model that is unfit say nothing of the device.
    unfit = ("the verdict is unfit",) if device.verdict == "unfit" else ()
    return unfit + broken_limits({**device.numbers, **parameters}, limits)


def _passed(
    identifier: str, broken: Mapping[str, tuple[str, ...]], limits: Mapping[str, Any]
) -> str:
    if not limits.get(identifier):
        return ""
    return FAIL if broken[identifier] else PASS
