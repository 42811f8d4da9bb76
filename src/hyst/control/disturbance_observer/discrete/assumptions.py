"""What a problem must satisfy for a sampled observer to exist.

Zeros outside the circle, those that sampling makes and those of delays among them, are allowed:
nothing is inverted, so there is no assumption 1 here.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hyst.control.discretization import Method, discretize
from hyst.control.disturbance_observer.assumptions import check_internal_model, least_seen
from hyst.control.disturbance_observer.discrete.problem import SampledObserverProblem
from hyst.control.disturbance_observer.discrete.w_plane import factored, poles_in_w_plane
from hyst.control.disturbance_observer.stacked_gain import feedback_matrix
from hyst.control.linear_system import LinearSystem, as_linear_system
from hyst.control.sampled.plant import LARGEST_DELAY, SampledPlant, sampled_plant
from hyst.control.zeros_and_poles import zeros_and_poles
from hyst.errors import InputError

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_BORDER = 1e-12  # nearer to the circle than this is on it
_SAME = 1e-6  # relative distance of an eigenvalue and a zero that coincide
_LOUD = 0.1  # of the plant's largest gain below half the sample rate: a mode above it that matters
_TRIED = 240  # states of a plant whose delay is sampled faster, to see whether that helps
_LARGEST = 60  # states of an observer; a block has 64 with the controller's


def check_plant(plant: SampledPlant) -> None:
    """Refuse a plant that is not SISO, stable, observable, or is sampled too slowly.

    Raises
    ------
    InputError
        With what is wrong, which value it has, and what would do.
    """
    system = plant.system
    if system.order > _LARGEST:
        raise InputError(
            f"the sampled plant has {system.order} states with its delay of "
            f"{plant.delay / plant.dt:.4g} samples; at most {_LARGEST} can be run, so sample more "
            "slowly, or give a plant of lower order"
        )
    poles = system.poles()
    worst = poles[np.argmax(np.abs(poles))]
    if abs(worst) >= 1.0 - _BORDER:
        raise InputError(
            f"assumption 2: the plant is not stable, pole at z = {_text(worst)}; stabilize it "
            "first and give the stable loop as the plant"
        )
    if zeros_and_poles(system).gain == 0.0 and factored(system).gain == 0.0:
        raise InputError(
            "the plant's gain is zero: its input does not reach its output; check B and C"
        )
    _check_rate(plant)
    shifted = system.A - np.eye(system.order)
    seen = least_seen(shifted, system.C, np.linalg.eigvals(shifted).astype(complex))
    if seen is not None:
        raise InputError(
            f"assumption 3: the sampled plant is not observable, its mode z = {_text(1.0 + seen)} "
            "does not reach the output at the samples; give a minimal realization "
            "(control.minreal), or another dt"
        )


def _check_rate(plant: SampledPlant) -> None:
    """Refuse resonances above half the sample rate: samples show them at lower frequencies."""
    if plant.continuous is None:
        return
    nyquist = math.pi / plant.dt
    fast = np.unique(np.abs(plant.continuous.poles().imag))
    fast = fast[fast >= nyquist]
    if not fast.size:
        return
    below = np.abs(plant.continuous.response(1j * np.linspace(0.0, nyquist, 200))[:, 0, 0])
    there = np.abs(plant.continuous.response(1j * fast)[:, 0, 0])
    loud = fast[there >= _LOUD * below.max()]
    if loud.size:
        raise InputError(
            f"dt = {plant.dt:.4g} s is too slow for the plant: its resonance at {loud[-1]:.4g} "
            f"rad/s is above half the sample rate, {nyquist:.4g} rad/s; sample every "
            f"{0.5 * math.pi / loud[-1]:.2g} s or faster, or give a filter as part of the plant"
        )


def check_problem(problem: SampledObserverProblem) -> None:
    """Refuse a problem that breaks an assumption, each with its own message.

    Raises
    ------
    InputError
        If the internal model is not observable, has no eigenvalue at 0, one that is a zero of the
        plant or one above half the sample rate.
    """
    model, dt = problem.internal_model, problem.dt
    check_internal_model(model)
    eigenvalues = np.linalg.eigvals(model.A_d).astype(complex)
    fastest = float(np.abs(eigenvalues.imag).max())
    if fastest >= math.pi / dt:
        raise InputError(
            f"the internal model has a sine of {fastest:.4g} rad/s, above half the sample rate, "
            f"{math.pi / dt:.4g} rad/s; sample faster or leave it out"
        )
    sampled = poles_in_w_plane(problem.sampled_model.A_d)
    zeros = factored(problem.plant).zeros
    scale = float(np.abs(poles_in_w_plane(problem.plant.A)).min())
    for value, mapped in zip(eigenvalues, _in_order(eigenvalues, sampled, dt), strict=True):
        if (np.abs(zeros - mapped) < _SAME * max(abs(mapped), 1e-3 * scale)).any():
            raise InputError(
                f"assumption 5: the eigenvalue {_text(value)} 1/s of A_d is a zero of the sampled "
                "plant, which blocks that disturbance from the output; take it out of the internal "
                "model"
            )


def _in_order(eigenvalues: ComplexArray, sampled: ComplexArray, dt: float) -> list[complex]:
    """Which of the sampled eigenvalues is which."""
    expected = np.tanh(0.5 * dt * eigenvalues)
    return [complex(sampled[np.argmin(np.abs(sampled - each))]) for each in expected]


def check_controller(
    plant: SampledPlant, controller: LinearSystem, given: LinearSystem, method: Method
) -> None:
    """Refuse a sampled controller that does not stabilize the plant; tell a rate that would do.

    Parameters
    ----------
    plant
        Sampled.
    controller, given
        As it runs, and as it was given.
    method
        How it was sampled.

    Raises
    ------
    InputError
        If a pole of their loop is on or outside the circle.
    """
    worst = _worst(plant.system, controller)
    if abs(worst) < 1.0 - _BORDER:
        return
    start = (
        "the sampled controller does not stabilize the sampled plant: their loop has a pole at "
        f"z = {_text(worst)}"
    )
    continuous = plant.continuous
    if continuous is None or given.dt > 0.0:
        raise InputError(f"{start}; lower its gain or check its sign")
    for halvings in range(1, 12):
        dt = plant.dt / 2.0**halvings
        if plant.delay > LARGEST_DELAY * dt:
            break
        faster = sampled_plant(continuous, dt, plant.delay)
        if faster.system.order > _TRIED:
            break
        if abs(_worst(faster.system, discretize(given, dt, method))) < 1.0 - 1e-9:
            raise InputError(
                f"{start}; dt = {plant.dt:.4g} s is too slow for this controller, {dt:.3g} s "
                "would do, or lower its gain"
            )
    late = f", with a delay of {plant.delay:.4g} s at any sample time" if plant.delay else ""
    raise InputError(f"{start}{late}; lower its gain or check its sign")


def read_controller(system: object, dt: float) -> LinearSystem:
    """Read the controller, a system; one with another sample time than dt is refused.

    Raises
    ------
    InputError
        If it cannot be read, has several inputs or outputs, or has another dt.
    """
    read = as_linear_system(system, "the controller")
    if (read.inputs, read.outputs) != (1, 1):
        raise InputError(
            f"the controller has {read.inputs} inputs and {read.outputs} outputs; the observer is "
            "for one of each, so design one for each axis"
        )
    if read.dt > 0.0 and abs(read.dt - dt) > 1e-6 * dt:
        raise InputError(
            f"the controller has dt = {read.dt:.6g} s, the observer {dt:.6g} s; give the same for "
            "both, or the controller in continuous time"
        )
    return read


def check_weight(name: str, weight: LinearSystem, dt: float) -> None:
    """Refuse a weight of this name that is zero, or sampled with another sample time than dt.

    Raises
    ------
    InputError
        If it is.
    """
    if zeros_and_poles(weight).gain == 0.0:
        raise InputError(f"{name} is zero; give a weight, a small number if nothing is asked")
    if weight.dt > 0.0 and abs(weight.dt - dt) > 1e-6 * dt:
        raise InputError(
            f"{name} has dt = {weight.dt:.6g} s, the observer {dt:.6g} s; give the same for both, "
            "or the weight in continuous time"
        )


def _worst(plant: LinearSystem, controller: LinearSystem) -> complex:
    poles = np.linalg.eigvals(feedback_matrix(plant, controller)).astype(complex)
    return complex(poles[np.argmax(np.abs(poles))])


def _text(value: complex) -> str:
    if abs(value.imag) <= 1e-9 * abs(value):
        return f"{value.real:.6g}"
    return f"{value.real:.6g} {'+' if value.imag > 0 else '-'} {abs(value.imag):.4g}j"
