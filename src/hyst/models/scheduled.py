"""A model whose constants follow a slow second signal, as temperature or bias."""

from __future__ import annotations

import functools
import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants
from hyst.checks.numbers import as_number
from hyst.errors import InputError
from hyst.models.schedule_run import ScheduledSystem
from hyst.models.schedule_stages import as_models, moving_places, require_that_memory_is_kept
from hyst.models.scheduled_inverse import ScheduledInverse
from hyst.operators import ModelDescription, Operator
from hyst.operators.model_file import MODEL, write_file
from hyst.operators.parameters import Parameters
from hyst.operators.plain_data import as_text
from hyst.operators.registry import entries, operator_from_dict
from hyst.operators.stage import Stage
from hyst.operators.verdict import LEVELS

Array = NDArray[np.float64]


@final
@dataclass(frozen=True, eq=False, init=False)
class Scheduled(ScheduledSystem):
    """A model whose constants follow a second signal: straight lines between models.

    ``c(s) = c_i + (s - s_i) / (s_{i+1} - s_i) (c_{i+1} - c_i)`` for ``s_i <= s < s_{i+1}``, c the
    constants of the operator; outside the values they are held at the nearer end, which results
    tell. The memory is kept while constants change: a play keeps its output, which the next sample
    moves into the band of now, ``z_k = max(u_k - r(s_k), min(u_k + r(s_k), z_{k-1}))``. The output
    so follows the second signal also while the input rests.

    Parameters
    ----------
    models
        Operators of one structure, one for each value, that differ in their constants alone.
    values
        Values of the second signal, ascending.
    name, unit
        What the second signal is.

    Raises
    ------
    InputError
        If there is one value only, values are not finite or not ascending, there is not one model
        for each, or the models differ in structure, size, sample time, initial memory or units.

    Examples
    --------
    >>> from hyst import PrandtlIshlinskii
    >>> cold = PrandtlIshlinskii([0.5], [0.2], p0=1.0)
    >>> warm = PrandtlIshlinskii([0.7], [0.1], p0=1.2)
    >>> model = Scheduled([cold, warm], [20.0, 40.0], name="temperature", unit="degC")
    >>> model.at(30.0).p0
    1.1
    >>> model([0.0, 1.0, 0.5], 30.0).tolist() == model.at(30.0)([0.0, 1.0, 0.5]).tolist()
    True
    >>> u, t = [0.0, 1.0, 0.5, 0.8], [20.0, 25.0, 35.0, 40.0]
    >>> bool(abs(model.inverse()(model(u, t), t) - u).max() < 1e-15)
    True
    """

    models: tuple[Operator, ...]
    values: Array
    name: str
    unit: str

    kind = "scheduled"

    def __init__(
        self,
        models: Sequence[Operator],
        values: ArrayLike,
        name: str = "s",
        unit: str = "",
    ) -> None:
        given, at = as_models(models), as_constants(values, "values")
        if at.size != len(given):
            raise InputError(f"{len(given)} models but {at.size} values; give one for each")
        wrong = np.flatnonzero(np.diff(at) <= 0.0)
        if wrong.size:
            i = int(wrong[0])
            raise InputError(
                f"values[{i + 1}] = {at[i + 1]:.6g} comes after {at[i]:.6g}; give values that "
                "ascend"
            )
        object.__setattr__(self, "models", given)
        object.__setattr__(self, "values", at)
        object.__setattr__(self, "name", as_text("name", name) or "s")
        object.__setattr__(self, "unit", as_text("unit", unit))
        common = common_description(given)
        if common != ModelDescription():
            vars(self).update(vars(self.with_description(common)))

    @property
    def dt(self) -> float | None:
        """The sample time the models are made for, seconds; None if any will do."""
        return self.models[0].dt

    def initial_state(self) -> Array:
        """Give the memory before the first sample, which the models share."""
        return self.models[0].initial_state()

    def at(self, value: float) -> Operator:
        """Give the model at one value of the second signal, an ordinary operator.

        Parameters
        ----------
        value
            Of the second signal; outside the schedule the model at its end is given
            (``outside(value)`` tells).

        Returns
        -------
        Operator
            With the bits of ``run`` at that value; where the kernel scales constants, as by a
            sample time, to rounding.

        Raises
        ------
        InputError
            If the value is not a finite number.
        """
        s = as_number(value, self.name)
        knot = int(np.searchsorted(self.values[1:], s, side="right"))
        if knot + 1 == self.values.size or s <= self.values[knot]:
            return self._described(self.models[knot], self.description)
        low, high = (self.models[i].parameters().values for i in (knot, knot + 1))
        share = (s - self.values[knot]) / (self.values[knot + 1] - self.values[knot])
        first = self.models[knot]
        constants = first.nearest_parameters(low + share * (high - low))
        about = self.description.of_estimate()
        return self._described(first.with_parameters(constants), about)

    def inverse(self) -> ScheduledInverse:
        """Give the exact inverse, which takes the wanted output and the second signal.

        Its memory is that of the model: each sample solves ``y = f(u, memory)`` with the constants
        of now and then moves the memory as the model does. ``at(value).inverse()`` is the inverse
        at one value.

        Raises
        ------
        NotInvertibleError
            If a stage cannot be solved, or would not be strictly monotone at some value; the
            condition and the value are named.
        """
        return ScheduledInverse(self)

    @property
    def knot_stages(self) -> tuple[tuple[Stage, ...], ...]:
        """The stages at each value of the schedule, which differ in their constants alone."""
        return self._stages

    @functools.cached_property
    def _stages(self) -> tuple[tuple[Stage, ...], ...]:
        middles = 0.5 * (self.values[1:] + self.values[:-1])
        require_that_memory_is_kept(self.models, [self.at(each) for each in middles])
        return tuple(each.stages() for each in self.models)

    def parameters(self) -> list[Parameters]:
        """Give the constants at each value."""
        return [each.parameters() for each in self.models]

    def moving(self) -> tuple[str, ...]:
        """Give the names of the constants that are not the same at all values."""
        names = self.models[0].parameters().names
        return tuple(names[i] for i in np.flatnonzero(moving_places(self.models)))

    def in_units(self, input_scale: float, output_scale: float) -> Scheduled:
        """Give the same model in other units of input and output.

        Parameters
        ----------
        input_scale, output_scale
            By which the numbers of input and output grow.
        """
        models = [each.in_units(input_scale, output_scale) for each in self.models]
        return Scheduled(models, self.values, self.name, self.unit)

    def to_dict(self) -> dict[str, Any]:
        """Give kind, name, unit, values and models."""
        return {
            "kind": self.kind,
            "name": self.name,
            "unit": self.unit,
            "values": self.values.tolist(),
            "models": [each.to_dict() for each in self.models],
        }

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Scheduled:
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
        given = entries(data, required=("name", "unit", "values", "models"))
        if not isinstance(given["models"], list):
            raise InputError("scheduled: 'models' must be a list of operators")
        models = [operator_from_dict(each) for each in given["models"]]
        return cls(models, given["values"], given["name"], given["unit"])

    def save(
        self, path: str | os.PathLike[str], description: ModelDescription | None = None
    ) -> None:
        """Write a model file, which ``hyst.load`` reads back, every double exact.

        Parameters
        ----------
        path
            The file to create or replace.
        description
            What the numbers mean; the model's own if left out.

        Raises
        ------
        InputError
            If the folder does not exist.
        """
        about = self.description if description is None else description
        write_file(path, MODEL, {"model": self.to_dict()}, about)

    def __eq__(self, other: object) -> bool:
        """Tell whether values, names and models are the same."""
        return isinstance(other, Scheduled) and self.to_dict() == other.to_dict()

    def __hash__(self) -> int:
        """Give the hash of the models."""
        return hash((self.name, self.unit, self.models))

    def __reduce__(self) -> tuple[Any, ...]:
        """Carry what it is made of, not the compiled chains."""
        return Scheduled.from_dict, (self.to_dict(),), self._carried()

    @staticmethod
    def _described(model: Operator, about: ModelDescription) -> Operator:
        return model.with_description(about) if about != ModelDescription() else model


def common_description(models: Sequence[Operator]) -> ModelDescription:
    """Give what holds of all models: ranges that all were identified from, and the worst verdict.

    Parameters
    ----------
    models
        Of a schedule.
    """
    all_ = [each.description for each in models]
    lows = [each.input_low for each in all_]
    highs = [each.input_high for each in all_]
    verdicts = [each.verdict for each in all_ if each.verdict is not None]
    low = None if None in lows else max(each for each in lows if each is not None)
    high = None if None in highs else min(each for each in highs if each is not None)
    if low is not None and high is not None and low >= high:
        low = high = None
    return replace(
        all_[0],
        input_low=low,
        input_high=high,
        output_low=None,
        output_high=None,
        errors={},
        provenance=None,
        verdict=max(verdicts, key=lambda each: LEVELS.index(each.level), default=None),
    )
