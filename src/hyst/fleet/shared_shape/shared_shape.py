"""The shape that a fleet of devices has in common, and how its devices differ."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Self, final

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_number, as_positive
from hyst.errors import HystError, InputError
from hyst.fleet.shared_shape.device_fit import fit_device
from hyst.fleet.shared_shape.device_result import SharedIdentified
from hyst.fleet.shared_shape.estimation import Estimated, estimate, evenly
from hyst.fleet.shared_shape.free_constants import (
    FreeConstants,
    free_constants,
    independent,
    scale_columns,
    with_offset,
)
from hyst.fleet.shared_shape.population import Population
from hyst.fleet.shared_shape.shape_file import (
    read_shape,
    shape_from_dict,
    shape_to_dict,
    write_shape,
)
from hyst.fleet.shared_shape.signals_used import Used, used_of
from hyst.fleet.shared_shape.told_of_device import told_of_device
from hyst.identification.record_use.used_samples import Data, prepare, require_same_units
from hyst.operators import Operator
from hyst.signals import Record

Array = NDArray[np.float64]

FEWEST_DEVICES = 5
"""From which a scatter is estimated."""

SHOW_THE_SHAPE = 60
"""Devices, spread evenly over the fleet, that tell which constants can be told apart."""


@final
@dataclass(frozen=True, eq=False, repr=False)
class SharedShape:
    """A shape of hysteresis that devices share, and the population that they are drawn from.

        constants of device d = mean + basis z_d,    z_d ~ N(0, covariance)

    It is made by ``estimate``, from records of a fleet, or by ``of_model``, from one model, and
    then identifies a device from few samples.

    Parameters
    ----------
    constants
        The mean device and the directions in which others differ from it.
    population
        How far they do; None: no population is known, gain, input scale and offset are free.
    output_range
        Of the fleet's outputs, output units.
    delay
        Samples by which measured outputs lag.
    scatter
        Standard deviation of the fleet along named directions: ``gain`` and ``input scale`` are
        scales of the signals, others are constants; a share of the constant, of an offset a share
        of the output's range. Those that are 0 are left out: devices share them.
    devices
        How many devices it was estimated from.
    left_out
        Those that were not, by their place among the records, with the reason.
    """

    constants: FreeConstants
    population: Population | None
    output_range: float
    delay: float = 0.0
    scatter: dict[str, float] = field(default_factory=dict)
    devices: int = 0
    left_out: dict[int, str] = field(default_factory=dict)

    @classmethod
    def estimate(
        cls, model: Operator, records: Sequence[Record], *, delay: float = 0.0
    ) -> SharedShape:
        """Estimate mean and scatter of a fleet.

        Mean, scatter along every direction and noise are those of greatest restricted likelihood
        over the devices that belong together; a direction along which nothing scatters is shared.
        Devices of another kind, and records that cannot be used, are left out and named.

        Parameters
        ----------
        model
            The shape as an operator, as ``hyst.identify`` finds it for one device of the fleet or
            for all: where the estimate starts, and of which kind it is.
        records
            One of each device, at least five that can be used. Drives may differ.
        delay
            Samples by which all outputs lag their inputs.

        Returns
        -------
        SharedShape

        Raises
        ------
        InputError
            If the model is no operator, what is given is no sequence of records, units differ, or
            fewer than five records can be used.

        Notes
        -----
        Mixed effects with restricted maximum likelihood: M. J. Lindstrom, D. M. Bates, Biometrics
        46 (1990), 673-687.

        Examples
        --------
        >>> import numpy as np, hyst
        >>> from hyst.fleet import SharedShape
        >>> rng, u = np.random.default_rng(1), np.sin(np.linspace(0.0, 25.0, 300))
        >>> u *= np.linspace(1.0, 0.4, 300)
        >>> typical = hyst.PrandtlIshlinskii([0.5, 0.3], [0.1, 0.3], p0=1.0)
        >>> def measured(gain):
        ...     y = gain * typical(u) + 0.002 * rng.standard_normal(u.size)
        ...     return hyst.Record(u, y, dt=1e-3)
        >>> fleet = [measured(1.0 + 0.05 * rng.standard_normal()) for _ in range(20)]
        >>> shape = SharedShape.estimate(typical, fleet)
        >>> {name: round(share, 2) for name, share in shape.scatter.items()}
        {'gain': 0.04}
        >>> found = shape.identify(measured(1.07))
        >>> found.verdict.level
        'good'
        """
        usable, left_out = _usable(model, records, delay)
        fleet = [used_of(data) for data in usable.values()]
        if len(fleet) < FEWEST_DEVICES:
            first = next(iter(left_out.values()), "")
            more = f"; the first that cannot: {first}" if first else ""
            raise InputError(
                f"{len(fleet)} records can be used; how devices scatter is estimated from "
                f"{FEWEST_DEVICES} or more{more}"
            )
        span = float(np.median([np.ptp(each.y) for each in fleet]))
        shown = evenly(fleet, SHOW_THE_SHAPE)
        found = estimate(free_constants(with_offset(model), shown, span), fleet, span)
        return cls._of(found, list(usable), left_out, span, delay)

    @classmethod
    def of_model(cls, model: Operator, *, delay: float = 0.0) -> SharedShape:
        """Hold the shape of a model: gain, input scale and offset alone are free, without a prior.

        Parameters
        ----------
        model
            Any operator whose constants can take a scale.
        delay
            Samples by which outputs lag their inputs.

        Returns
        -------
        SharedShape

        Raises
        ------
        InputError
            If it is no operator, or the delay is not finite.

        Examples
        --------
        >>> import numpy as np, hyst
        >>> from hyst.fleet import SharedShape
        >>> u = np.sin(np.linspace(0.0, 20.0, 200)) * np.linspace(1.0, 0.5, 200)
        >>> typical = hyst.PrandtlIshlinskii([0.5, 0.3], [0.1, 0.3], p0=1.0)
        >>> record = hyst.Record(u, 1.3 * typical(0.9 * u) + 0.2, dt=1e-3)
        >>> found = SharedShape.of_model(typical).identify(record)
        >>> bool(np.abs(found.predict(u) - record.y).max() < 1e-6)
        True
        """
        shape = with_offset(_as_operator(model))
        basis = np.zeros((len(shape.parameters()), 0))
        return cls(FreeConstants(shape, basis), None, 1.0, as_number(delay, "delay"))

    def identify(self, record: Record) -> SharedIdentified:
        """Identify a device from a record, which may be short.

        Parameters
        ----------
        record
            Of one device; a loop or two.

        Returns
        -------
        SharedIdentified
            With a verdict that tells a device that is none of the fleet.

        Raises
        ------
        InputError
            If it is no record, or has another sample time than the shape can be brought to.
        NotIdentifiableError
            If a signal is constant, or the input does not turn.
        """
        data = _prepared(self.constants.model, record, self.delay)
        used = used_of(data)
        constants, span = self.constants, self.output_range
        if self.population is None:
            span = float(np.ptp(used.y))
            constants = _scales(constants.model, used, span)
        fit = fit_device(constants, self.population, used, span)
        return told_of_device(constants, fit, data, used, span)

    @property
    def model(self) -> Operator:
        """The mean device."""
        return self.constants.model

    def __repr__(self) -> str:
        seen = ", ".join(f"{name} {value:.2g}" for name, value in self.scatter.items())
        return f"SharedShape({self.model.kind}, {self.devices} devices; scatter: {seen or 'none'})"

    def to_dict(self) -> dict[str, Any]:
        """Give everything as plain numbers, lists and text, every double exact."""
        return shape_to_dict(self)

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Rebuild from ``to_dict()``.

        Parameters
        ----------
        data
            What it gave, or the same read from a file.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**shape_from_dict(data))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a file that ``SharedShape.load`` reads: JSON, every double exact.

        Parameters
        ----------
        path
            The file to create or replace; it is written whole or not at all.

        Raises
        ------
        InputError
            If the folder cannot be made, or the path is a folder.
        """
        write_shape(path, self.to_dict(), self.model.description)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Read back what ``save`` wrote.

        Parameters
        ----------
        path
            The file.

        Raises
        ------
        InputError
            If the file is not there, holds no shared shape or one of another version, or an entry
            is missing, unknown or not allowed.
        """
        return cls(**read_shape(path))

    @classmethod
    def _of(
        cls,
        found: Estimated,
        places: list[int],
        left_out: dict[int, str],
        span: float,
        delay: float,
    ) -> SharedShape:
        sizes = np.sqrt(found.scatter.variances)
        scatter = {
            name: float(size) for name, size in zip(found.names, sizes, strict=True) if size > 0.0
        }
        other = {
            place: "another kind: it lies too far from the other devices of the fleet to count"
            for place, belongs in zip(places, found.belongs, strict=True)
            if not belongs
        }
        count = int(found.belongs.sum())
        everyone = dict(sorted((left_out | other).items()))
        return cls(found.constants, found.population, span, float(delay), scatter, count, everyone)


def _usable(
    model: Operator, records: Sequence[Record], delay: float
) -> tuple[dict[int, Data], dict[int, str]]:
    """Take the records that can be used, by their places, and why others cannot."""
    shape, late = _as_operator(model), as_number(delay, "delay")
    if isinstance(records, Record) or not isinstance(records, Sequence):
        raise InputError("records is no list of records; give one record of each device")
    require_same_units(records)
    usable, left_out = dict[int, Data](), dict[int, str]()
    for place, record in enumerate(records):
        try:
            usable[place] = _prepared(shape, record, late)
        except HystError as error:
            left_out[place] = str(error)
    return usable, left_out


def _prepared(model: Operator, record: Record, delay: float) -> Data:
    data = prepare(record if isinstance(record, Record) else (record,), "auto", delay)
    model.require_possible_time(record.dt)
    return data


def _as_operator(model: Operator) -> Operator:
    if not isinstance(model, Operator):
        raise InputError(f"the model is of type {type(model).__name__}; give an operator")
    return model


def _scales(model: Operator, used: Used, output_range: float) -> FreeConstants:
    """Give the scales of both signals and the offset as the only directions."""
    as_positive(output_range, "the range of the output")
    own = model.parameters()
    offset = np.zeros(len(own))
    offset[[i for i, name in enumerate(own.names) if name.split(".")[-1] == "offset"][-1]] = 1.0
    basis = np.column_stack([output_range * offset, *scale_columns(model).values()])
    every = FreeConstants(model, basis)
    effect = every.linearized(used, np.zeros(every.size))[1] / output_range
    kept = independent(effect.T @ effect, np.arange(every.size))
    return FreeConstants(model, basis[:, kept])
