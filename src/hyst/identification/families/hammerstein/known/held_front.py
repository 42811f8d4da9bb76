"""A hysteresis that is known, with a gain and an offset after it that are not.

It is a family like any other to what fits it before dynamics, but in no registry: who gives
``front=`` has it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Self, final

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.families.family import Family, Start, Words
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.models import Delay, LinearDynamics
from hyst.operators import Affine, Composition, Operator

Array = NDArray[np.float64]

WHAT = "give an operator, a result of hyst.identify, or what hyst.load reads of a model file"

DEFAULT = "mpi"
"""The family in front where none is asked for."""

TOLD = (
    "the hysteresis was given and is held: only a gain and an offset after it, and the dynamics, "
    "were fitted"
)

_WORDS = Words(
    full_name="known hysteresis",
    equations=("y(t) = gain H[u](t) + offset",),
    explanations=("H is the hysteresis that was given, with all its constants held.",),
)


@final
@dataclass(frozen=True)
class HeldFront(Family):
    """A known hysteresis before dynamics: a gain and an offset are free.

    Parameters
    ----------
    operator
        The hysteresis.
    lags
        Of the creep behind it.
    """

    operator: Operator = None  # type: ignore[assignment]  # fields of the class before have defaults
    lags: int = 0

    def __post_init__(self) -> None:
        """Take name and words; a class with a name would be in the registry."""
        for name, value in (("name", "given"), ("words", _WORDS), ("has_memory", True)):
            object.__setattr__(self, name, value)
        object.__setattr__(self, "depends_on_rate", self.operator.dt is not None)

    def least_parameters(self, size: int) -> int:
        """Give two: gain and offset."""
        return 2

    def in_units(self, input_scale: float, output_scale: float) -> Self:
        """Give the hysteresis for an input in other units; its output takes the same factor."""
        return replace(self, operator=self.operator.in_units(input_scale, input_scale))

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Give the line through the output of the hysteresis and what is behind it."""
        data = overview.data
        return [self.start_from(data, data.joined(self.outputs(data)))]

    def outputs(self, data: Data) -> list[Array]:
        """Give the output of the hysteresis over the window of each record.

        Parameters
        ----------
        data
            The records.
        """
        return [
            v.u[window] for v, window in zip(self.behind(data).records, data.windows(), strict=True)
        ]

    def behind(self, data: Data) -> Data:
        """Give the records with what is behind the hysteresis as their drive.

        Parameters
        ----------
        data
            The records.

        Raises
        ------
        NotIdentifiableError
            If nothing in the hysteresis moves in one of them.
        """
        records = []
        for number, record in enumerate(data.records, 1):
            self.operator.require_possible_time(record.dt, f"record {number}")
            v = self.operator.at_sample_time(record.dt)(record.u)
            if not np.ptp(v) > 0.0:
                raise NotIdentifiableError(
                    f"the hysteresis that was given stands still at {v[0]:.6g} in record {number}; "
                    "it is of another input or unit than the record's"
                )
            records.append(replace(record, u=v))
        spans = [(float(each.u.min()), float(each.u.max())) for each in records]
        low, high = min(each[0] for each in spans), max(each[1] for each in spans)
        return replace(
            data, records=tuple(records), half_range=(high - low) / 2.0, measured_inputs=()
        )

    def start_from(self, data: Data, v: Array) -> Start:
        """Give the free parameters, from the line through a signal and the output.

        Parameters
        ----------
        data
            The records.
        v
            Shape (samples used,): what gain and offset make the output of.
        """
        # A power of two with which v is of the size of the output whatever its unit is.
        share = math.ldexp(1.0, -math.frexp(float(np.ptp(v)))[1])
        columns = np.column_stack([share * v, np.ones(v.size)])
        theta: Array = scipy.linalg.lstsq(columns, data.measured())[0]
        return self.parametrization(data.records[0].dt, share), theta

    def parametrization(self, dt: float, share: float = 1.0) -> HeldParametrization:
        """Give gain, over a share, and offset as free parameters, at a sample time.

        Parameters
        ----------
        dt
            Sample time, s.
        share
            Gain of a theta of 1.
        """
        held = self.operator.at_sample_time(dt)
        constants = held.parameters().values
        transform = np.zeros((constants.size + 2, 2))
        transform[-2:] = np.diag([share, 1.0])
        return HeldParametrization(
            template=_with_line(held, 1.0, 0.0),
            transform=transform,
            fixed=np.append(constants, [0.0, 0.0]),
            lower=np.full(2, -np.inf),
            upper=np.full(2, np.inf),
            is_linear=True,
            known=held,
        )


@final
@dataclass(frozen=True, eq=False)
class HeldParametrization(Parametrization):
    """Gain and offset after a hysteresis that is held.

    Parameters
    ----------
    known
        The hysteresis, in the present units.
    """

    known: Operator = None  # type: ignore[assignment]  # the fields before have defaults

    def in_units(self, theta: Array, input_scale: float, output_scale: float) -> Self:
        """Give the same in other units: the output of what is held takes the input's factor."""
        known = self.known.in_units(input_scale, input_scale)
        scales = np.array([output_scale / input_scale, output_scale])
        transform = self.transform.copy()
        transform[-2:] *= scales[:, None]
        return replace(
            self,
            template=_with_line(known, 1.0, 0.0),
            transform=transform,
            fixed=np.append(known.parameters().values, scales * self.fixed[-2:]),
            known=known,
        )


def as_held_front(value: Any, name: str) -> HeldFront | None:
    """Check a hysteresis that is given; None where there is none.

    Parameters
    ----------
    value, name
        What was given, and the option's name.

    Raises
    ------
    InputError
        If it is no operator, or nothing but dynamics.
    """
    if value is None or isinstance(value, HeldFront):
        return value
    operator = value
    if not isinstance(value, Operator):
        operator = getattr(value, "hysteresis", getattr(value, "model", value))
    if not isinstance(operator, Operator):
        said = repr(value) if isinstance(value, str) else f"of type {type(value).__name__}"
        raise InputError(f"{name} is {said}; {WHAT}")
    parts = operator.parts if isinstance(operator, Composition) else (operator,)
    while parts and isinstance(parts[-1], LinearDynamics | Delay):
        parts = parts[:-1]  # of a stage as a whole: its dynamics are what is looked for
    if not parts:
        raise InputError(f"{name} is {operator.kind} without a hysteresis before it; {WHAT}")
    return HeldFront(parts[0] if len(parts) == 1 else Composition(parts))


def require_one_hysteresis(front: HeldFront | None, hysteresis: Any) -> None:
    """Refuse a hysteresis that is asked for beside one that is given.

    Parameters
    ----------
    front
        What was given; None where nothing was.
    hysteresis
        The family in front as it was asked for; the default asks for none.

    Raises
    ------
    InputError
        If both are.
    """
    if front is None:
        return
    name = getattr(hysteresis, "name", hysteresis)
    options = isinstance(hysteresis, Family) and hysteresis != type(hysteresis)()
    if name != DEFAULT or options:
        raise InputError(
            f"front is given, so hysteresis {name!r} and its options have nothing to find; leave "
            "out front, or hysteresis and its options"
        )


def told_of(front: HeldFront | None) -> tuple[str, ...]:
    """Say that a hysteresis was given.

    Parameters
    ----------
    front
        What was given; None where nothing was.
    """
    return () if front is None else (TOLD,)


def _with_line(known: Operator, gain: float, offset: float) -> Operator:
    """Give a hysteresis with a line after it."""
    return Affine(gain, offset) @ known
