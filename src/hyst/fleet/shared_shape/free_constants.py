"""The constants of a shape that may differ from device to device, in numbers without a scale.

    constants = those of the mean + basis @ z

An entry of z is a share of its constant (of the output's range, for an offset that is 0). Constants
on a bound of their own, and those that others make up for, are held.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.errors import InputError
from hyst.fleet.shared_shape.signals_used import Used
from hyst.operators import Affine, Operator
from hyst.operators.stage import Stage

Array = NDArray[np.float64]

SCALES = {"gain": (1.0, 2.0), "input scale": (2.0, 1.0)}
"""Factors of input and output."""

MOST_DIRECTIONS = 40
"""Beyond, constants are taken together to the directions that move the output most."""

SMALLEST_UNIT = 0.02
"""Of the largest constant of its array: a constant near 0 does not scatter in shares of itself."""

MADE_UP_FOR = 1e-8
"""Share of a constant's effect on the output that others leave: below, it is held."""

ROUNDING = 1e-9
"""Share of a constant by which a limit may be missed."""

REDUCED = 1e-7
"""Of the largest effect of a direction: smaller ones are held where directions are reduced."""


@dataclass(frozen=True, eq=False)
class FreeConstants:
    """The mean of the fleet and the directions in which its devices differ from it.

    Parameters
    ----------
    model
        The mean device.
    basis
        Shape (constants, q).
    scales
        Which scales of signals are its first columns, of ``SCALES``: they move with the mean.
    """

    model: Operator
    basis: Array
    scales: tuple[str, ...] = ()

    @property
    def size(self) -> int:
        """Number of directions q."""
        return int(self.basis.shape[1])

    @functools.cached_property
    def values(self) -> Array:
        """The constants of the mean."""
        return self.model.parameters().values

    @functools.cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the constants."""
        return self.model.parameters().names

    @functools.cached_property
    def start(self) -> Array:
        """The state before the first sample, as the engine takes it."""
        return self.model.initial_state()[None, :]

    def stages(self, dt: float) -> tuple[Stage, ...]:
        """Give the stages at a sample time."""
        if self.model.dt is None:
            return self._stages
        return self.model.at_sample_time(dt).stages()

    @functools.cached_property
    def _stages(self) -> tuple[Stage, ...]:
        return self.model.stages()

    def linearized(self, used: Used, z: Array) -> tuple[Array, Array]:
        """Give output and its derivative by z over the samples used, shapes (n,) and (n, q).

        Parameters
        ----------
        used
            A record.
        z
            Shape (q,), of which device.

        Raises
        ------
        InputError
            If the output overflows.
        """
        chain = _engine.Chain(self.stages(used.dt))
        chain.set_parameters(self.constants(z))
        y, by_constants = np.empty((1, used.u.size)), np.empty((used.u.size, self.values.size))
        if chain.run(self.start.copy(), used.u[None, :], y) >= 0:
            raise InputError("the model overflows on this record; check the units of its input")
        chain.jacobian(self.start[0].copy(), used.u, by_constants)
        return y[0, used.window], by_constants[used.window] @ self.basis

    def constants(self, z: Array) -> Array:
        """Give the constants of a device within the bounds of its class."""
        low, high = self._bounds
        return np.asarray(np.clip(self.values + self.basis @ z, low, high))

    def operator(self, z: Array) -> Operator:
        """Give a device as an operator, with constants in the order that its class asks for."""
        ordered = self.model.nearest_parameters(self.constants(z))
        made: Operator = self.model.with_parameters(ordered)
        return made

    def moved(self, z: Array) -> Self:
        """Give the same directions around another mean."""
        model = self.operator(z).with_description(self.model.description)
        columns = scale_columns(model)
        basis = self.basis.copy()
        for i, name in enumerate(self.scales):
            basis[:, i] = columns[name]
        return replace(self, model=model, basis=basis)

    def directions(self) -> tuple[str, ...]:
        """Give names of the directions: scales, constants, and mixtures of them by number."""
        single = np.count_nonzero(self.basis, axis=0) == 1
        largest = np.abs(self.basis).argmax(axis=0)
        others = range(len(self.scales), self.size)
        return self.scales + tuple(
            self.names[largest[i]] if single[i] else f"direction {i + 1}" for i in others
        )

    @functools.cached_property
    def _bounds(self) -> tuple[Array, Array]:
        own = self.model.parameters()
        return own.lower, own.upper

    @functools.cached_property
    def limits(self) -> tuple[Array, Array]:
        """Rows and least values of linear inequalities that every z must keep."""
        own = self.model.parameters()
        unit = np.eye(own.values.size)
        below, above = np.isfinite(own.lower), np.isfinite(own.upper)
        rows = [unit[below], -unit[above]]
        least = [own.lower[below], -own.upper[above]]
        kept = self.model.inequalities()
        rows.append(kept.rows)
        least.append(kept.least)
        of_constants, bounds = np.concatenate(rows), np.concatenate(least)
        of_z = of_constants @ self.basis
        room = of_constants @ self.values - bounds
        size = np.linalg.norm(of_z, axis=1)
        # What the mean itself does not keep, no device has to.
        held = (room >= 0.0) & (size > 0.0)
        return of_z[held] / size[held, None], -room[held] / size[held]

    def within(self, z: Array, covariance: Array) -> Array:
        """Give the likeliest z that keeps the limits of the class.

        Parameters
        ----------
        z, covariance
            Mean and covariance of a normal distribution: of what it says, the part on the limit
            that z breaks most is taken, one limit after the other.
        """
        rows, least = self.limits
        for _ in range(3 * len(least)):
            excess = rows @ z - least
            if excess.size == 0 or excess.min() >= -ROUNDING:
                return z
            worst = rows[int(excess.argmin())]
            across = covariance @ worst
            size = float(worst @ across)
            if size <= ROUNDING**2:
                break
            z = z - across * (float(excess.min()) / size)
        return z


def with_offset(model: Operator) -> Operator:
    """Give a model with a free zero of its sensor, which every device has.

    Parameters
    ----------
    model
        The shape.
    """
    if is_offset(model).any():
        return model
    return (Affine(1.0, 0.0) @ model).with_description(model.description)


def free_constants(model: Operator, fleet: list[Used], output_range: float) -> FreeConstants:
    """Choose what may differ from device to device.

    Parameters
    ----------
    model
        The shape, with an offset.
    fleet
        Records that show it.
    output_range
        Of their outputs, as large as an offset of 0 may scatter.

    Returns
    -------
    FreeConstants
    """
    own = model.parameters()
    effects = effects_of(model, fleet, output_range)
    free = np.flatnonzero((own.values > own.lower) & (own.values < own.upper))
    unit = units_of(model, output_range)
    scaled = effects * np.outer(unit, unit)
    # An offset first; and a gain of 1 is what is held of a scale that two stages could take.
    order = np.argsort(np.isin(np.abs(own.values[free]), (1.0,)), kind="stable")
    offsets = is_offset(model)[free][order]
    order = np.concatenate([order[offsets], order[~offsets]])
    kept = free[independent(scaled[np.ix_(free, free)], order)]
    basis = np.diag(unit)[:, kept]
    if kept.size > MOST_DIRECTIONS:
        sizes, vectors = np.linalg.eigh(scaled[np.ix_(kept, kept)])
        largest = np.arange(sizes.size)[::-1][:MOST_DIRECTIONS]
        largest = largest[sizes[largest] > REDUCED * sizes[-1]]
        basis = basis @ vectors[:, largest]
    columns = scale_columns(model)
    return FreeConstants(model, np.column_stack([*columns.values(), basis]), tuple(columns))


def scale_columns(model: Operator) -> dict[str, Array]:
    """Give the derivatives of the constants by the logarithms of the scales they can take.

    Parameters
    ----------
    model
        The mean.
    """
    columns = {}
    for name, ends in SCALES.items():
        try:
            factors = model.parameter_scales(*ends)
        except InputError:
            continue
        # Every factor is a power of the scale, and the scale is 2.
        columns[name] = np.asarray(np.log2(factors) * model.parameters().values)
    return columns


def effects_of(model: Operator, fleet: list[Used], output_range: float) -> Array:
    """Give mean products of what the constants do to the output, shape (constants, constants).

    Parameters
    ----------
    model, fleet, output_range
        As of ``free_constants``; in units of that range.
    """
    every = FreeConstants(model, np.eye(len(model.parameters())))
    total = np.zeros((every.size, every.size))
    for used in fleet:
        jacobian = every.linearized(used, np.zeros(every.size))[1] / output_range
        total += jacobian.T @ jacobian / jacobian.shape[0]
    return total / len(fleet)


def is_offset(model: Operator) -> NDArray[np.bool_]:
    """Tell which constants are zeros of sensors.

    Parameters
    ----------
    model
        With the constants.
    """
    return np.array([name.split(".")[-1] == "offset" for name in model.parameters().names])


def units_of(model: Operator, output_range: float) -> Array:
    """Give the size of every constant, shape (constants,).

    Parameters
    ----------
    model
        With the constants.
    output_range
        Size of an offset.
    """
    own = model.parameters()
    size = np.abs(own.values)
    arrays = np.array([name.split("[")[0] for name in own.names])
    for each in set(arrays):
        of_array = arrays == each
        size[of_array] = np.maximum(size[of_array], SMALLEST_UNIT * size[of_array].max())
    size[is_offset(model)] = output_range
    size[size == 0.0] = 1.0
    return size


def independent(effects: Array, order: NDArray[np.intp]) -> NDArray[np.intp]:
    """Give the columns that none of those before make up for, by their sums of products.

    Parameters
    ----------
    effects
        Shape (k, k).
    order
        In which columns are taken.
    """
    kept: list[int] = []
    for at in order:
        own = effects[at, at]
        if own <= 0.0:
            continue
        left = own
        if kept:
            beside = effects[np.ix_(kept, kept)]
            across = effects[kept, at]
            scale = np.sqrt(np.diag(beside))
            solved = np.linalg.lstsq(beside / np.outer(scale, scale), across / scale, rcond=1e-13)
            left = own - float(across / scale @ solved[0])
        if left > MADE_UP_FOR * own:
            kept.append(int(at))
    return np.sort(np.array(kept, dtype=np.intp))
