"""What a Q-filter is designed for: plant, controller and weights, checked."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.control.disturbance_observer.stacked_gain import feedback_matrix
from hyst.control.linear_system import LinearSystem, as_linear_system
from hyst.control.zeros_and_poles import ZerosAndPoles, zeros_and_poles
from hyst.errors import InputError

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_AXIS = 1e-9  # of the largest root: nearer to the axis than this is on it


@dataclass(frozen=True)
class QFilterProblem:
    """Nominal plant, controller and weights, in continuous time.

    ``q_filter_problem`` makes one from what a user has, and checks it.

    Parameters
    ----------
    plant, controller
        Pn and C, each with one input and one output.
    Wu, Wp
        Weights of the multiplicative uncertainty and of 1 - Q.
    """

    plant: LinearSystem
    controller: LinearSystem
    Wu: LinearSystem
    Wp: LinearSystem

    @cached_property
    def plant_factors(self) -> ZerosAndPoles:
        """Zeros, poles and gain of the plant."""
        return zeros_and_poles(self.plant)

    @cached_property
    def Wu_factors(self) -> ZerosAndPoles:
        """Those of Wu."""
        return zeros_and_poles(self.Wu)

    @cached_property
    def Wp_factors(self) -> ZerosAndPoles:
        """Those of Wp."""
        return zeros_and_poles(self.Wp)

    @cached_property
    def controller_factors(self) -> ZerosAndPoles:
        """Those of C."""
        return zeros_and_poles(self.controller)

    @cached_property
    def sensitivity(self) -> ZerosAndPoles:
        """Those of S0 = 1 / (1 + Pn C)."""
        through = float(self.plant.D[0, 0] * self.controller.D[0, 0])
        open_poles = np.concatenate([self.plant.poles(), self.controller.poles()])
        closed = np.linalg.eigvals(feedback_matrix(self.plant, self.controller)).astype(complex)
        return ZerosAndPoles(open_poles, closed, 1.0 / (1.0 + through))

    @property
    def plant_relative_degree(self) -> int:
        """By how many poles the plant has more than zeros."""
        return int(self.plant_factors.poles.size - self.plant_factors.zeros.size)

    @cached_property
    def kept_zeros(self) -> ComplexArray:
        """Zeros of the plant that are not in the open left half plane; Q must have them."""
        zeros = self.plant_factors.zeros
        return np.asarray(zeros[zeros.real >= -_AXIS * _size(self.plant_factors)])

    @cached_property
    def inverted_zeros(self) -> ComplexArray:
        """The others, which become poles of Q/Pn."""
        kept = self.kept_zeros
        return np.array([z for z in self.plant_factors.zeros if not (kept == z).any()], complex)

    @cached_property
    def features(self) -> ComplexArray:
        """All zeros and poles but those at 0, 1/s: where something happens."""
        parts = (self.plant_factors, self.Wu_factors, self.Wp_factors, self.sensitivity)
        found = np.concatenate([np.concatenate([each.zeros, each.poles]) for each in parts])
        return np.asarray(found[np.abs(found) > 1e-9 * np.abs(found).max(initial=1e-300)])


def q_filter_problem(plant: Any, controller: Any, Wu: Any, Wp: Any) -> QFilterProblem:
    """Read and check what a Q-filter is designed for.

    Parameters
    ----------
    plant, controller, Wu, Wp
        As for ``design_q_filter``.

    Raises
    ------
    InputError
        If one cannot be read, has several inputs or outputs or is sampled; the plant is unstable,
        has gain 0 or a zero at 0; a weight is unstable or 0; or the controller does not stabilize
        the plant.
    """
    problem = QFilterProblem(
        as_linear_system(plant, "the plant"),
        as_linear_system(controller, "the controller"),
        as_linear_system(Wu, "Wu"),
        as_linear_system(Wp, "Wp"),
    )
    for name, system in (
        ("the plant", problem.plant),
        ("the controller", problem.controller),
        ("Wu", problem.Wu),
        ("Wp", problem.Wp),
    ):
        check_kind(name, system)
    _check_plant(problem)
    for name, weight in (("Wu", problem.Wu), ("Wp", problem.Wp)):
        _refuse_right(weight.poles(), f"{name} is not stable", "move the pole to the left")
        if zeros_and_poles(weight).gain == 0.0:
            raise InputError(f"{name} is zero; give a weight, a small number if nothing is asked")
    _refuse_right(
        problem.sensitivity.poles,
        "the controller does not stabilize the plant",
        "lower its gain or check its sign",
    )
    return problem


def check_kind(name: str, system: LinearSystem) -> None:
    """Refuse a system that is not from one input to one output in continuous time.

    Parameters
    ----------
    name
        What messages call it.
    system
        As it was read.

    Raises
    ------
    InputError
        If it has several inputs or outputs, or is sampled.
    """
    if (system.inputs, system.outputs) != (1, 1):
        raise InputError(
            f"{name} has {system.inputs} inputs and {system.outputs} outputs; the Q-filter is for "
            "one of each, so design one for each axis"
        )
    if system.dt != 0.0:
        raise InputError(
            f"{name} is sampled, dt = {system.dt:g} s; design in continuous time, or with "
            "design_sampled_q_filter for a sampled plant"
        )


def _check_plant(problem: QFilterProblem) -> None:
    _refuse_right(problem.plant.poles(), "the plant is not stable", "stabilize it first")
    factors = problem.plant_factors
    if factors.gain == 0.0:
        raise InputError(
            "the plant's gain is zero: its input does not reach its output; check B and C"
        )
    if factors.zeros.size and np.abs(factors.zeros).min() <= _AXIS * _size(factors):
        raise InputError(
            "the plant has a zero at 0, so it hides what is constant and Q(0) = 1 is out of reach; "
            "no Q-filter exists for it"
        )


def _size(factors: ZerosAndPoles) -> float:
    return float(np.abs(np.concatenate([factors.poles, factors.zeros])).max(initial=0.0))


def _refuse_right(poles: ComplexArray, what: str, advice: str) -> None:
    if not poles.size:
        return
    worst = poles[np.argmax(poles.real)]
    if worst.real >= -_AXIS * np.abs(poles).max():
        raise InputError(f"{what}, pole at {complex(worst):.4g} 1/s; {advice}")
