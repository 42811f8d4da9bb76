"""What is known of one device: its model and numbers, or why there are none."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from typing import Any

from hyst.errors import InputError
from hyst.operators import Operator

IDENTIFIED, FAILED = "identified", "failed"


@dataclass(frozen=True, eq=False)
class Device:
    """One device of a fleet.

    Parameters
    ----------
    identifier, file
        Its name, and where its record was.
    failure
        Why there is no model; empty where there is one.
    is_final
        Whether a failure is one of the record, which another run would only repeat.
    family
        Of the model.
    verdict, sentence
        How far the model can be trusted, and why.
    numbers
        Quantities by name.
    parameters
        Value and standard error by name; NaN where there is none.
    left_out
        Why many of its samples are no measurements of it, a sentence by finding of the diagnosis.
    rising, falling
        Modelled loop on an even grid of the drive, both axes from 0 to 1.
    model
        The model; None where there is none, or it is in a file.
    """

    identifier: str
    file: str = ""
    failure: str = ""
    is_final: bool = True
    family: str = ""
    verdict: str = ""
    sentence: str = ""
    numbers: Mapping[str, float] = field(default_factory=dict)
    parameters: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    left_out: Mapping[str, str] = field(default_factory=dict)
    rising: tuple[float, ...] = ()
    falling: tuple[float, ...] = ()
    model: Operator | None = None

    @property
    def status(self) -> str:
        """``identified`` or ``failed``."""
        return FAILED if self.failure else IDENTIFIED

    def to_dict(self) -> dict[str, Any]:
        """Give everything but the model as values of JSON."""
        told = asdict(replace(self, model=None))
        told.pop("model")
        told["left_out"] = dict(self.left_out)
        told["numbers"] = {name: _plain(each) for name, each in self.numbers.items()}
        told["parameters"] = {
            name: [_plain(each) for each in pair] for name, pair in self.parameters.items()
        }
        return told

    @classmethod
    def from_dict(cls, data: Any, model: Operator | None = None) -> Device:
        """Rebuild a device from ``to_dict()`` and its model.

        Parameters
        ----------
        data
            What ``to_dict()`` gave.
        model
            Its model.

        Raises
        ------
        InputError
            If an entry is missing or unknown.
        """
        known = {each.name for each in fields(cls)} - {"model"}
        if not isinstance(data, dict) or set(data) != known:
            raise InputError("an entry of the journal is of another version of hyst")
        told = dict(data)
        told["numbers"] = {name: _number(each) for name, each in data["numbers"].items()}
        told["parameters"] = {
            name: (_number(pair[0]), _number(pair[1])) for name, pair in data["parameters"].items()
        }
        for name in ("rising", "falling"):
            told[name] = _floats(data[name])
        return cls(**told, model=model)


def _plain(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _number(value: float | None) -> float:
    return math.nan if value is None else float(value)


def _floats(values: Sequence[float]) -> tuple[float, ...]:
    return tuple(float(each) for each in values)
