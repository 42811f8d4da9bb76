"""What moves the output, part by part."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.problem import model_output
from hyst.identification.fit.stages import without_part
from hyst.identification.record_use.used_samples import Data
from hyst.operators import Operator
from hyst.operators.plain_data import as_number

Array = NDArray[np.float64]

HYSTERESIS, CREEP, DRIFT = "hysteresis", "creep", "drift"
DRIFT_OR_CREEP = "drift, or creep that looks like it"
BEFORE = "settling from before the record"
NOISE, LACKS = "noise", "what the model lacks"


@dataclass(frozen=True)
class OutputPart:
    """One part of what moves the output, over the samples used.

    Parameters
    ----------
    name
        Of the part.
    rms
        About its mean, output units; NaN where the records do not tell it.
    percent
        The same, of the output's range.
    in_model
        Whether the model has it.
    """

    name: str
    rms: float
    percent: float
    in_model: bool

    def to_dict(self) -> dict[str, Any]:
        """Give everything as plain numbers and text."""
        known = not np.isnan(self.rms)
        return {
            "name": self.name,
            "rms": as_number("rms", self.rms) if known else None,
            "percent": as_number("percent", self.percent) if known else None,
            "in_model": self.in_model,
        }


def motion_of(
    data: Data,
    operator: Operator,
    beside: Mapping[str, Array],
    noise: float,
    creep_is_told: bool,
) -> tuple[OutputPart, ...]:
    """Take apart what moves the output of records.

    Parameters
    ----------
    data
        The records, without what is beside the model.
    operator
        The model.
    beside
        By name, over the samples in use: what was taken out, output units.
    noise
        Of the records, output units rms.
    creep_is_told
        Whether the records tell that there is none, where the model has none.
    """
    measured = data.with_past().records
    span = max(r.y.max() for r in measured) - min(r.y.min() for r in measured)
    whole = model_output(data, operator)
    alone = without_part(operator, "creep")
    hysteresis = whole if alone is None else model_output(data, alone)
    creep = np.zeros_like(whole) if alone is None else whole - hysteresis
    left = float(np.std(data.measured() - whole))
    open_creep = alone is None and not creep_is_told
    parts = [
        (HYSTERESIS, float(np.std(hysteresis)), True),
        (CREEP, float("nan") if open_creep else float(np.std(creep)), alone is not None),
    ]
    for name, values in beside.items():
        told = DRIFT_OR_CREEP if open_creep and name == DRIFT else name
        parts.append((told, float(np.std(values)), False))
    parts.append((NOISE, min(noise, left), False))
    parts.append((LACKS, math.sqrt(max(left**2 - noise**2, 0.0)), False))
    return tuple(
        OutputPart(name, rms, 100.0 * rms / float(span), in_model) for name, rms, in_model in parts
    )


def motion_lines(parts: tuple[OutputPart, ...], unit: str) -> list[str]:
    """Give a table for the terminal.

    Parameters
    ----------
    parts
        Of ``motion_of``.
    unit
        Of the output, with a space before it; empty if unknown.
    """
    lines = [f"{'what moves the output':38s} {'rms':>12s}   of range"]
    for each in parts:
        outside = not each.in_model and each.name not in (NOISE, LACKS)
        where = "   not in the model" if outside and each.rms else ""
        size = (
            "not told by these records"
            if np.isnan(each.rms)
            else f"{each.rms:12.4g}{unit}   {each.percent:.3f} %{where}"
        )
        lines.append(f"{each.name:38s} {size}")
    return lines
