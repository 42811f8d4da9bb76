"""A model with hysteresis in front and linear dynamics behind it, taken apart."""

from __future__ import annotations

import numpy as np

from hyst.errors import InputError
from hyst.models import Delay, LinearDynamics
from hyst.models.state_space import StateSpace
from hyst.operators import Affine, Composition, Operator


def front_and_dynamics(model: Operator, name: str) -> tuple[Operator, LinearDynamics]:
    """Take a model apart: the hysteresis, and all linear dynamics behind it as one system.

    Parameters
    ----------
    model
        ``dynamics @ hysteresis``, of as many parts as it has.
    name
        What messages call it.

    Returns
    -------
    hysteresis : Operator
        What stands in front; a gain of 1 where there is nothing.
    dynamics : LinearDynamics

    Raises
    ------
    InputError
        If there are no dynamics behind the hysteresis, or some in front of it.
    """
    parts = list(_parts(model))
    behind: LinearDynamics | None = None
    while parts and isinstance(parts[-1], StateSpace | Delay):
        last = parts.pop()
        dt = next((each.dt for each in (last, model) if each.dt is not None), None)
        if dt is None:
            raise InputError(f"{name} has a delay of no sample time; give the delay its dt")
        own = _as_dynamics(last, dt)
        behind = own if behind is None else in_series(own, behind)
    if behind is None:
        raise InputError(
            f"{name} holds no dynamics behind a hysteresis, so there is no plant in it; name it "
            "under [hysteresis] and write the plant, or identify with --family hammerstein"
        )
    early = [each for each in parts if isinstance(each, StateSpace)]
    if early:
        raise InputError(
            f"{name} has dynamics of {early[0].order} states before or amid its hysteresis; an "
            "observer behind its inverse needs all of them behind it"
        )
    if not parts:
        return Affine(1.0), behind
    return parts[0] if len(parts) == 1 else Composition(tuple(parts)), behind


def has_dynamics_behind(model: Operator) -> bool:
    """Tell whether a model ends in linear dynamics, as one of hysteresis with dynamics does.

    Parameters
    ----------
    model
        Any operator.
    """
    return isinstance(_parts(model)[-1], StateSpace)


def delayed_by(dynamics: LinearDynamics, samples: float) -> LinearDynamics:
    """Give dynamics that answer later; parts of a sample lie on the line between two samples.

    Parameters
    ----------
    dynamics
        G.
    samples
        Further delay, >= 0.
    """
    whole = int(samples)
    late = LinearDynamics(
        dynamics.A, dynamics.B, dynamics.C, dynamics.D, dynamics.dt, dynamics.delay + whole
    )
    part = samples - whole
    if part == 0.0:
        return late
    between = LinearDynamics([[0.0]], [1.0], [part], 1.0 - part, dynamics.dt)
    return in_series(between, late)


def in_series(first: LinearDynamics, second: LinearDynamics) -> LinearDynamics:
    """Give one system for two, the second behind the first.

    Parameters
    ----------
    first, second
        Of one sample time.
    """
    n, m = first.order, second.order
    A = np.zeros((n + m, n + m))
    A[:n, :n], A[n:, n:], A[n:, :n] = first.A, second.A, np.outer(second.B, first.C)
    B = np.concatenate([first.B, second.B * first.D])
    C = np.concatenate([second.D * first.C, second.C])
    return LinearDynamics(A, B, C, first.D * second.D, first.dt, first.delay + second.delay)


def _parts(model: Operator) -> tuple[Operator, ...]:
    if not isinstance(model, Composition):
        return (model,)
    return tuple(part for each in model.parts for part in _parts(each))


def _as_dynamics(part: Operator, dt: float) -> LinearDynamics:
    if isinstance(part, StateSpace):
        return LinearDynamics(part.A, part.B, part.C, part.D, part.dt, part.delay)
    assert isinstance(part, Delay), "the loop takes no other"
    return delayed_by(LinearDynamics(np.zeros((0, 0)), [], [], 1.0, dt), float(part.samples))
