"""The plant of a controller from an identification: dynamics, hysteresis, and what is not known."""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from typing import Any, final

import numpy as np

from hyst.checks.numbers import as_not_negative
from hyst.control.linear_system import LinearSystem, as_linear_system
from hyst.control.plants.far_zeros import without_far_zeros
from hyst.control.plants.parts import delayed_by, front_and_dynamics
from hyst.errors import InputError, NotInvertibleError
from hyst.models import ContinuousDynamics, LinearDynamics
from hyst.operators import ModelDescription, Operator, operator_from_dict
from hyst.operators.dynamics_errors import DynamicsErrors
from hyst.operators.model_file import MODEL, read_file

_FAR = 3.0  # times half the sample rate: zeros beyond it are seen as dead time alone


@final
@dataclass(frozen=True, eq=False)
class IdentifiedPlant:
    """Hysteresis and plant of an identification, as ``identified_plant`` gives them.

    A plant wherever a linear system goes: ``as_linear_system`` takes its ``system``.

    Parameters
    ----------
    dynamics
        The plant behind the hysteresis, sampled, whole samples of delay beside the matrices; its
        gain at rest is 1 as hyst identifies it, for the hysteresis has the units.
    hysteresis
        In front; its description has input, ranges and verdict of the model.
    continuous
        The continuous plant with its dead time whose zero-order hold the dynamics are; None where
        there is none.
    errors
        How well the dynamics are known over frequency; None where that was not kept.
    name
        What messages call it.
    notes
        What limits its use, a sentence each.
    """

    dynamics: LinearDynamics
    hysteresis: Operator
    continuous: ContinuousDynamics | None
    errors: DynamicsErrors | None
    name: str
    notes: tuple[str, ...]
    system: LinearSystem = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "system", as_linear_system(self.dynamics))

    @property
    def dt(self) -> float:
        """Sample time, s."""
        return self.dynamics.dt

    @property
    def delay(self) -> float:
        """Delay of the plant in whole samples, s; parts of one are in the dynamics."""
        return self.dynamics.delay * self.dynamics.dt

    @property
    def gain(self) -> float:
        """Gain at rest."""
        return self.dynamics.dc_gain()

    def slopes(
        self, low: float = 1.0, high: float = 1.0, standard_errors: float = 3.0
    ) -> tuple[float, float]:
        """Give the slopes of the true hysteresis after an inverse, which are not those identified.

        Parameters
        ----------
        low, high
            Least and largest slope of the identified hysteresis after the inverse; 1 and 1 of the
            exact one.
        standard_errors
            How many of the slope of the hysteresis count, >= 0.

        Returns
        -------
        low, high : float
            For noise of the records alone: a hysteresis of another shape is not in it.

        Raises
        ------
        InputError
            If the identification does not tell how well the slope is known.
        """
        count = as_not_negative(standard_errors, "standard_errors")
        error = None if self.errors is None else self.errors.slope_error
        if error is None:
            raise InputError(
                f"{self.name} does not tell how well the slope of its hysteresis is known; "
                "identify again, or give slopes that hold"
            )
        return low * max(1.0 - count * error, 0.0), high * (1.0 + count * error)

    def continuous_plant(self) -> ContinuousDynamics:
        """Give the continuous plant, for a design in continuous time.

        Zeros beyond three times half the sample rate become the dead time ``sum Re(1 / zero)`` that
        they are there: noise trades one for the other, and both have the same samples.

        Raises
        ------
        InputError
            If there is none, or a zero in the right half plane is left, which no observer can
            invert.
        """
        if self.continuous is None:
            raise InputError(
                f"{self.name} has no continuous form: {self.notes[0]}; design in discrete time"
            )
        plant = without_far_zeros(self.continuous, _FAR * np.pi / self.dt)
        right = [each for each in plant.zeros() if each.real >= 0.0]
        if right:
            raise InputError(
                f"{self.name} is nonminimum phase in continuous time, zero at {_said(right[0])} "
                "1/s; design in discrete time, or take a minimum phase plant and that zero into Wu"
            )
        return plant


def identified_plant(source: Any) -> IdentifiedPlant:
    """Take plant, hysteresis and what is not known of the plant from an identification.

    Parameters
    ----------
    source
        What ``hyst.identify(..., family="hammerstein")`` gave, its model, or its model file, which
        has all of it; also any model of hysteresis with linear dynamics behind it.

    Returns
    -------
    IdentifiedPlant

    Raises
    ------
    InputError
        If there are no dynamics behind the hysteresis, or some before it; if they are not stable;
        if the output was ahead of the input; or the file cannot be read.

    Examples
    --------
    >>> import hyst
    >>> stage = hyst.models.resonance(200.0, 0.03, dt=1e-4, delay=3)
    >>> plant = identified_plant(stage @ hyst.PrandtlIshlinskii([0.3], [1.0], 0.6))
    >>> plant.system.order, plant.dt, round(plant.delay, 6), plant.hysteresis.kind
    (5, 0.0001, 0.0003, 'prandtl-ishlinskii')
    """
    model, name = _model_of(source)
    about = model.description
    hysteresis, dynamics = front_and_dynamics(model, name)
    if about.delay < 0.0:
        raise InputError(
            f"the output {name} was identified from was {-about.delay:.4g} samples ahead of the "
            "input, which no plant is; align the channels and identify again"
        )
    if about.dt is not None and abs(about.dt - dynamics.dt) > 1e-9 * dynamics.dt:
        raise InputError(
            f"{name} has dynamics of dt = {dynamics.dt:.6g} s and a record of {about.dt:.6g} s; "
            "identify again"
        )
    dynamics = delayed_by(dynamics, float(about.delay))
    _require_stable(dynamics, name)
    continuous, notes = _continuous(dynamics)
    return IdentifiedPlant(
        dynamics,
        hysteresis.with_description(_of_front(about)),
        continuous,
        about.dynamics_errors,
        name,
        notes + _outside(dynamics),
    )


def _model_of(source: Any) -> tuple[Operator, str]:
    if isinstance(source, str | os.PathLike):
        saved = read_file(source)
        data = saved.content.get("model")
        kind = data.get("kind") if isinstance(data, dict) else None
        if saved.format is not MODEL or kind in ("tracking-controller", "scheduled"):
            raise InputError(
                f"{source} holds a {kind or saved.format.holds}, not one input's model; give a "
                "model file, as hyst identify --family hammerstein writes"
            )
        try:
            model = operator_from_dict(data)
        except InputError as error:
            raise InputError(f"{source}: {error}") from None
        return model.with_description(saved.description), str(source)
    model = getattr(source, "model", source)
    if not isinstance(model, Operator):
        raise InputError(
            f"the plant is a {type(source).__name__}; give what hyst.identify gave, its model, or "
            "a model file"
        )
    return model, "the model"


def _of_front(about: ModelDescription) -> ModelDescription:
    """Give what holds of the hysteresis alone: its output was never measured, the delay is G's."""
    return replace(
        about,
        output_low=None,
        output_high=None,
        delay=0,
        delay_interval=None,
        errors={},
        dynamics_errors=None,
    )


def _require_stable(dynamics: LinearDynamics, name: str) -> None:
    if not dynamics.is_stable():
        worst = dynamics.poles()[0]
        raise InputError(
            f"the dynamics of {name} are not stable: pole {_said(worst)} in the plane of z, of "
            f"modulus {abs(worst):.6g}; stabilize the actuator first and identify the stable loop"
        )


def _continuous(dynamics: LinearDynamics) -> tuple[ContinuousDynamics | None, tuple[str, ...]]:
    try:
        return dynamics.to_continuous(), ()
    except NotInvertibleError as error:
        return None, (str(error),)


def _outside(dynamics: LinearDynamics) -> tuple[str, ...]:
    """Name zeros that no stable inverse has: the plant is nonminimum phase."""
    outside = [each for each in dynamics.zeros() if abs(each) >= 1.0 and each.imag >= 0.0]
    told = []
    for z in outside:
        s = np.log(complex(z)) / dynamics.dt
        real_negative = z.imag == 0.0 and z.real < 0.0
        where = "between samples" if real_negative else f"{abs(s) / (2.0 * np.pi):.4g} Hz"
        told.append(
            f"the plant is nonminimum phase: zero {_said(z)} in the plane of z, {where}, outside "
            "the unit circle; no controller can invert it"
        )
    return tuple(told)


def _said(value: complex) -> str:
    if abs(value.imag) <= 1e-9 * abs(value):
        return f"{value.real:.4g}"
    return f"{value.real:.4g} {'+' if value.imag > 0 else '-'} {abs(value.imag):.4g}j"
