"""What a problem must satisfy for a disturbance observer to exist: sec. 4 of the paper."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.control.disturbance_observer.internal_model import InternalModel
from hyst.control.disturbance_observer.problem import ObserverProblem
from hyst.control.disturbance_observer.stacked_gain import feedback_matrix
from hyst.control.linear_system import LinearSystem, balanced
from hyst.control.zeros_and_poles import zeros_and_poles
from hyst.errors import InputError

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_AXIS = 1e-9  # of the largest pole: nearer to the axis than this is on it
_SAME = 1e-6  # relative distance of an eigenvalue and a zero that coincide
_RANK = 1e-13  # smallest singular value of a scaled matrix of full rank


def check_assumptions(problem: ObserverProblem) -> None:
    """Refuse a problem that breaks an assumption, each with its own message.

    Parameters
    ----------
    problem
        Plant, controller, weights and internal model.

    Raises
    ------
    InputError
        If a system has several inputs or outputs or is sampled, the plant is not strictly proper,
        an assumption 1 to 6 does not hold, a weight is unstable or 0, or the controller does not
        stabilize the plant.
    """
    for name, system in (
        ("the plant", problem.plant),
        ("the controller", problem.controller),
        ("Wu", problem.Wu),
        ("Wp", problem.Wp),
    ):
        _check_kind(name, system)
    _check_plant(problem.plant)
    check_internal_model(problem.internal_model)
    _check_zeros(problem.plant, problem.internal_model)
    _check_weight("Wu", problem.Wu)
    _check_weight("Wp", problem.Wp)
    _check_controller(problem.plant, problem.controller)


def check_noise_weight(weight: LinearSystem | None) -> None:
    """Refuse a weight of noise that is no stable system of one input and output.

    Raises
    ------
    InputError
        If the weight is not.
    """
    if weight is not None:
        _check_kind("the noise weight", weight)
        _check_weight("the noise weight", weight)


def _check_kind(name: str, system: LinearSystem) -> None:
    if (system.inputs, system.outputs) != (1, 1):
        raise InputError(
            f"{name} has {system.inputs} inputs and {system.outputs} outputs; the observer is for "
            "one of each, so design one for each axis"
        )
    if system.dt != 0.0:
        raise InputError(
            f"{name} is sampled, dt = {system.dt:g} s; design in continuous time and discretize "
            "the observer"
        )


def _check_plant(plant: LinearSystem) -> None:
    if plant.order == 0:
        raise InputError("the plant has no states; give its dynamics, they limit the observer")
    if plant.D[0, 0] != 0.0:
        raise InputError(
            f"the plant has a direct feedthrough of {plant.D[0, 0]:.4g}; the observer needs a "
            "strictly proper Pn, so add the pole of the sensor or the amplifier"
        )
    unstable = _not_left(plant.poles())
    if unstable.size:
        raise InputError(
            f"assumption 2: the plant is not stable, pole at {_text(unstable[0])} 1/s"
            + _way_out(
                unstable[0],
                float(np.abs(plant.poles()).max()),
                "give the damping it has, or stabilize it first",
                "stabilize it first and give the stable loop as the plant",
            )
        )
    # First, for a realization of nothing has no modes to see.
    if zeros_and_poles(plant).gain == 0.0:
        raise InputError(
            "the plant's gain is zero: its input does not reach its output; check B and C"
        )
    seen = least_seen(plant.A, plant.C, plant.poles())
    if seen is not None:
        raise InputError(
            f"assumption 3: the plant is not observable, its mode {_text(seen)} 1/s does not reach "
            "the output; give a minimal realization (control.minreal)"
        )


def check_internal_model(model: InternalModel) -> None:
    """Refuse an internal model that its output does not show, or without an eigenvalue at 0.

    Raises
    ------
    InputError
        If the model is one of these.
    """
    eigenvalues = np.linalg.eigvals(model.A_d).astype(complex)
    hidden = least_seen(model.A_d, model.C_d, eigenvalues)
    if hidden is not None:
        number = "assumption 4: " if hidden.real >= 0.0 else ""
        raise InputError(
            f"{number}(A_d, C_d) is not observable, its mode {_text(hidden)} 1/s is no part of d; "
            "leave that state out or give it a weight in C_d"
        )
    size = float(np.abs(eigenvalues).max(initial=0.0))
    # Of a chain of integrators the eigenvalues are only known to a root of the rounding.
    if np.abs(eigenvalues).min() > 1e-6 * max(size, 1e-300):
        closest = eigenvalues[np.argmin(np.abs(eigenvalues))]
        raise InputError(
            f"assumption 6: A_d has no eigenvalue at 0, the closest is {_text(closest)} 1/s; add "
            "an integrator, InternalModel.integrator() + yours, for Q(0) = 1"
        )


def _check_zeros(plant: LinearSystem, model: InternalModel) -> None:
    zeros = zeros_and_poles(plant).zeros
    eigenvalues = np.linalg.eigvals(model.A_d).astype(complex)
    scale = max(float(np.abs(plant.poles()).max()), float(np.abs(zeros).max(initial=0.0)))
    for value in eigenvalues:
        near = np.abs(zeros - value) < _SAME * max(abs(value), 1e-3 * scale)
        if near.any():
            raise InputError(
                f"assumption 5: the eigenvalue {_text(value)} 1/s of A_d is a zero of the plant, "
                "which blocks that disturbance from the output; take it out of the internal model"
            )
    right = _not_left(zeros, scale)
    if right.size:
        raise InputError(
            f"assumption 1: the plant is not minimum phase, zero at {_text(right[0])} 1/s"
            + _way_out(
                right[0],
                scale,
                "the inverse in the observer would ring there for ever, so give the damping it has",
                "its inverse in the observer would be unstable, so take the zero into Wu",
            )
        )


def _check_weight(name: str, weight: LinearSystem) -> None:
    unstable = _not_left(weight.poles())
    if unstable.size:
        raise InputError(
            f"{name} is not stable, pole at {_text(unstable[0])} 1/s; move the pole into the left "
            "half plane, an integrator to a frequency below those that matter"
        )
    if zeros_and_poles(weight).gain == 0.0:
        raise InputError(f"{name} is zero; give a weight, a small number if nothing is asked")


def _check_controller(plant: LinearSystem, controller: LinearSystem) -> None:
    poles = np.linalg.eigvals(feedback_matrix(plant, controller)).astype(complex)
    unstable = _not_left(poles)
    if unstable.size:
        raise InputError(
            f"the controller does not stabilize the plant: their loop has a pole at "
            f"{_text(unstable[0])} 1/s; lower its gain or check its sign"
        )


def _not_left(values: ComplexArray, scale: float | None = None) -> ComplexArray:
    """Those that are not in the open left half plane, the worst first."""
    size = float(np.abs(values).max(initial=0.0)) if scale is None else scale
    found = values[values.real >= -_AXIS * size] if size else values
    return found[np.argsort(-found.real)]


def _way_out(value: complex, size: float, at_border: str, beyond: str) -> str:
    if abs(value.real) <= _AXIS * size:
        return f", on the border of stability; {at_border}"
    return f"; {beyond}"


def least_seen(A: Array, C: Array, eigenvalues: ComplexArray) -> complex | None:
    """Find a mode that the output does not show, by the test of Popov, Belevitch and Hautus.

    Of the matrices A and C, with the eigenvalues of A.
    """
    n = A.shape[0]
    size = float(np.abs(eigenvalues).max(initial=0.0)) or 1.0
    scaled = balanced(LinearSystem(A / size, np.ones((n, 1)), C, np.zeros((1, 1))))
    row = scaled.C / max(float(np.linalg.norm(scaled.C)), 1e-300)
    for value in eigenvalues:
        matrix = np.vstack([value / size * np.eye(n) - scaled.A, row])
        if np.linalg.svd(matrix, compute_uv=False)[-1] < _RANK:
            return complex(value)
    return None


def _text(value: complex) -> str:
    if abs(value.imag) <= 1e-9 * abs(value):
        return f"{value.real:.4g}"
    return f"{value.real:.4g} {'+' if value.imag > 0 else '-'} {abs(value.imag):.4g}j"
