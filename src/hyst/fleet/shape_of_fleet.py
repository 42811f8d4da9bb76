"""The shape that all devices of a fleet share, given or estimated from the fleet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from hyst.errors import HystError, InputError
from hyst.fleet.choice import spread_order
from hyst.fleet.device_fit import Settled
from hyst.fleet.folder import ResultFolder
from hyst.fleet.shared_shape.shared_shape import SharedShape
from hyst.fleet.sources import Measurement
from hyst.operators import Operator
from hyst.signals import Record

SHARED = "shared"
SHAPE_FILE = "shape.json"

PLAYS = 12
"""Of the device where the estimate starts, unless told: what one short record cannot tell apart the
fleet can, and plays too many do no harm where plays too few do."""

SHARED_TOLD = (
    "That is of single devices; here all share one shape, estimated from the fleet (shape.json)."
)

MOST_RECORDS, MOST_TYPICAL = 200, 15
"""Records a shape is estimated from, and devices the typical one is chosen among."""


def as_shape(shape: Any) -> Any:
    """Check a shape: ``"shared"``, None, or what identifies a record.

    Parameters
    ----------
    shape
        One of these; of a model its shape is taken.

    Raises
    ------
    InputError
        If it is something else.
    """
    if shape is None or (isinstance(shape, str) and shape == SHARED):
        return shape
    if isinstance(shape, Operator):
        return SharedShape.of_model(shape)
    if not callable(getattr(shape, "identify", None)):
        raise InputError(f"shape is {shape!r}; give 'shared', a hyst.fleet.SharedShape, or a model")
    return shape


def estimated_shape(
    measured: Sequence[Measurement], settled: Settled, folder: ResultFolder | None
) -> SharedShape:
    """Estimate the shape of a fleet from records spread over it; in a folder, only once.

    Parameters
    ----------
    measured
        The fleet.
    settled
        With what single devices are identified: the middle one of some is where it starts.
    folder
        Where the shape is kept; None for nowhere.

    Raises
    ------
    InputError
        If too few records can be used.
    """
    file = None if folder is None else folder.path / SHAPE_FILE
    if file is not None and file.exists():
        return SharedShape.load(file)
    order = spread_order(len(measured))[:MOST_RECORDS]
    records = [each for k in order if (each := _loaded(measured[k])) is not None]
    if not records:
        raise InputError("no record of the fleet can be read, so it has no shape; see its files")
    typical = _typical(records[:MOST_TYPICAL], settled)
    delay = 0.0 if settled.delay is None else settled.delay / records[0].dt
    shape = SharedShape.estimate(typical, records, delay=delay)
    if file is not None:
        shape.save(file)
    return shape


def to_start_from(settled: Settled, asked: Mapping[str, Any]) -> Settled:
    """Give with what the device is identified that the estimate of a shape starts from.

    Parameters
    ----------
    settled
        With what single devices are.
    asked
        What the user gave.
    """
    if "plays" in asked or "plays" not in settled.options:
        return settled
    return replace(settled, options={**settled.options, "plays": PLAYS})


def shape_of_folder(folder: Path) -> SharedShape:
    """Read the shape of a fleet that was identified with ``shape="shared"``.

    Parameters
    ----------
    folder
        Of the fleet.

    Raises
    ------
    InputError
        If it has none.
    """
    if not (folder / SHAPE_FILE).exists():
        raise InputError(
            f"{folder} has no {SHAPE_FILE}; identify that fleet with --shape shared first"
        )
    return SharedShape.load(folder / SHAPE_FILE)


def _loaded(measurement: Measurement) -> Record | None:
    try:
        return measurement.load()
    except (HystError, OSError):
        return None  # it fails again, and is told, when its turn comes


def _typical(records: Sequence[Record], settled: Settled) -> Operator:
    """Give the model of the device whose output has the middle range of some."""
    found: dict[float, Operator] = {}
    refusal: Exception | None = None
    for each in records:
        try:
            found[float(np.ptp(each.y))] = settled.identified(each).model
        except HystError as error:
            refusal = error
    if not found:
        raise InputError(f"no record of the fleet gives a model to start from: {refusal}")
    return found[sorted(found)[len(found) // 2]]
