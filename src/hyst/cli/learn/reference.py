"""The wanted output of a repeated motion, and its sample time from wherever it is told."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.checks.numbers import as_positive
from hyst.cli.arguments import require_same_unit
from hyst.cli.console import note

_STAMPS_ROUNDED = 1e-3


@dataclass(frozen=True, eq=False)
class Reference:
    """What the output should do.

    Parameters
    ----------
    file, how
        Where it stands, and its options of reading.
    y
        Wanted output, shape (N,), output units.
    name, unit
        Of it.
    dt
        Sample time, s; None while nothing tells it.
    rate_given
        Whether it is what the user typed.
    """

    file: Path
    how: dict[str, Any]
    y: NDArray[np.float64]
    name: str
    unit: str
    dt: float | None
    rate_given: bool = False

    @property
    def rate(self) -> float | None:
        """Samples per second."""
        return None if self.dt is None else 1.0 / self.dt

    def timed(
        self, model: hyst.Operator, records: Sequence[hyst.Record], rate: float | None
    ) -> Reference:
        """Give it with a sample time, from the model or the records where its file has none.

        Parameters
        ----------
        model
            Whose sample time it must have, if it has one.
        records
            Measured ones.
        rate
            Of measured files, as typed.
        """
        found, given = self.dt, self.rate_given
        if found is None and model.dt is not None:
            found = model.dt
            if not records and rate is None:
                note(f"the reference is taken to have the model's sample time, {found:.6g} s")
        elif found is None and rate is not None:
            found, given = 1.0 / as_positive(rate, "--rate", "samples per second"), True
        elif found is None and records:
            found = records[0].dt
        if found is not None and model.dt is not None:
            # Printed stamps are rounded.
            if abs(found - model.dt) > _STAMPS_ROUNDED * model.dt:
                model.require_sample_time(found, "the reference")
            found = model.dt
        return replace(self, dt=found, rate_given=given)


def read_reference(
    file: Path,
    column: str,
    how: dict[str, Any],
    about: hyst.ModelDescription,
    rate: float | None,
) -> Reference:
    """Read the wanted output.

    Parameters
    ----------
    file, column
        Where it stands.
    how
        Table and format of the file.
    about
        Of the model, for units.
    rate
        Samples per second, as typed.

    Raises
    ------
    InputError
        If it cannot be read, has another unit than the model's output, or uneven times.
    """
    y, name, unit = hyst.io.read_column(file, column, **how)
    require_same_unit(unit, about.output_unit, "the reference")
    if rate is not None:
        dt = 1.0 / as_positive(rate, "--reference-rate", "samples per second")
        return Reference(file, how, y, name, unit, dt, rate_given=True)
    found = hyst.io.read_time_step(file, **how)
    if found is not None and found[1] is None:
        raise hyst.InputError(
            f"the time column {found[0]!r} of {file.name} has no even steps in a known unit, so "
            "the measured output cannot be set beside it; give --reference-rate"
        )
    return Reference(file, how, y, name, unit, None if found is None else found[1])
