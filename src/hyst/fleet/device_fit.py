"""One device: load its record, fit its model, tell its numbers; whatever happens is an answer."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.errors import HystError, InputError
from hyst.fleet.device import Device
from hyst.fleet.loop_of_model import ModelLoop, loop_of_model
from hyst.fleet.sources import Measurement
from hyst.identification import Identified, identify
from hyst.signals import Record, units_differ

Array = NDArray[np.float64]

_TO_DEVIATION = 1.4826
"""Standard deviation of normal numbers over the median of their sizes."""


_MANY = 0.02
"""Share of the samples of a record that are worth a word if they are left out."""


@dataclass(frozen=True, eq=False)
class Settled:
    """What every device of a fleet is fitted with.

    Parameters
    ----------
    options
        Keyword arguments of ``hyst.identify``, family and size among them.
    delay
        Of the fleet, s, held; None where the options say.
    shape
        What identifies a record by a shape that the fleet shares, by ``identify(record)``; None
        where each device has its own.
    input_unit, output_unit
        Of the fleet; empty where no record tells.
    """

    options: Mapping[str, Any] = field(default_factory=dict)
    delay: float | None = None
    shape: Any = None
    input_unit: str = ""
    output_unit: str = ""

    def identified(self, record: Record) -> Identified:
        """Identify the model of one device.

        Parameters
        ----------
        record
            Its record.
        """
        if self.shape is not None:
            return self.shape.identify(record)  # type: ignore[no-any-return]
        options = dict(self.options)
        if self.delay is not None:
            in_samples = self.delay / record.dt
            near = round(in_samples)
            # A whole number of samples of one record is one of another with the same sample time.
            options["delay"] = near if abs(in_samples - near) < 1e-6 else in_samples
        return identify(record, **options)


def fit_device(work: tuple[Measurement, Settled]) -> Device:
    """Fit the model of one device.

    Parameters
    ----------
    work
        The device, and what all devices are fitted with.

    Returns
    -------
    Device
        One that failed says why in a sentence.
    """
    measurement, settled = work
    try:
        record = measurement.load()
        _require_units(record, settled)
        return device_of(measurement, record, settled.identified(record))
    except Exception as error:
        # A fleet goes on without a device, whatever is wrong with it.
        return failed(measurement, *sentence_of(error))


def failed(measurement: Measurement, sentence: str, is_final: bool) -> Device:
    """Give a device without a model.

    Parameters
    ----------
    measurement
        The device.
    sentence
        What is wrong.
    is_final
        Whether another run would only repeat it.
    """
    return Device(measurement.identifier, measurement.file, sentence, is_final)


def sentence_of(error: Exception) -> tuple[str, bool]:
    """Say what is wrong in one line, and whether the same record would fail again."""
    if isinstance(error, HystError):
        return " ".join(str(error).split()), True
    if isinstance(error, OSError | MemoryError):
        return f"{type(error).__name__}: {' '.join(str(error).split())}", False
    what = f"{type(error).__name__}: {' '.join(str(error).split())}"
    return f"hyst itself failed on this record, {what}; report it", True


def _require_units(record: Record, settled: Settled) -> None:
    for what, unit, own in (
        ("input", record.input_unit, settled.input_unit),
        ("output", record.output_unit, settled.output_unit),
    ):
        if units_differ(unit, own):
            raise InputError(
                f"the {what} is in {unit!r}, that of the fleet in {own!r}; hyst converts no units, "
                "so convert the column, or correct its header"
            )


def device_of(measurement: Measurement, record: Record, found: Identified) -> Device:
    """Tell the numbers of a device whose model was found.

    Parameters
    ----------
    measurement, record, found
        The device, its record and its model.
    """
    loop = loop_of_model(found.model, record.u, record.dt)
    rising, falling = (tuple(np.round(each, 5).tolist()) for each in loop.normalized())
    named = zip(found.parameter_names, found.parameter_values, found.standard_errors, strict=True)
    return Device(
        measurement.identifier,
        measurement.file,
        family=found.family,
        verdict=found.verdict.level,
        sentence=" ".join(found.verdict.sentences),
        numbers=_numbers(record, found, loop),
        parameters={name: (float(value), float(error)) for name, value, error in named},
        left_out=_left_out(record, found),
        rising=rising,
        falling=falling,
        model=found.model,
    )


def _left_out(record: Record, found: Identified) -> dict[str, str]:
    """Say what was found in many samples that are therefore no part of the fit."""
    diagnosis = getattr(found, "diagnosis", None)  # a shape that is shared looks for none
    return {
        each.name: each.sentence
        for each in (() if diagnosis is None else diagnosis.findings)
        if each.severity == "left out" and each.samples.size > _MANY * len(record)
    }


def _numbers(record: Record, found: Identified, loop: ModelLoop) -> dict[str, float]:
    metrics = found.metrics["training"]
    error = record.y - found.predict(record.u)
    return {
        "samples": float(len(record)),
        "rms_error": metrics.rms,
        "rms_percent": metrics.rms_percent,
        "max_error": metrics.max_abs,
        "noise": _noise(error),
        "input_range": float(np.ptp(record.u)),
        "output_range": float(np.ptp(record.y)),
        "gain": loop.gain,
        "hysteresis_percent": 100.0 * float(np.abs(loop.width).max()),
        "bend_percent": 100.0 * float(np.abs(loop.bend).max()),
        "delay": float(found.delay),
    }


def _noise(error: Array) -> float:
    """Give the standard deviation of what changes from sample to sample, bad samples aside."""
    steps = np.abs(np.diff(error))
    return float(_TO_DEVIATION * np.median(steps) / math.sqrt(2.0)) if steps.size else math.nan
