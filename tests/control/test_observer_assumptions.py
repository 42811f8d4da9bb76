"""Every problem without a solution is refused in one sentence of its own."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from observer_cases import PLANT, REPAIRED_C, WP, WU

import control
from hyst.control import InternalModel, design_disturbance_observer, observer_problem
from hyst.errors import InputError

GOOD: dict[str, Any] = {
    "plant": PLANT, "controller": REPAIRED_C, "Wu": WU, "Wp": WP, "internal_model": "integrator"
}  # fmt: skip

BAD: list[tuple[dict[str, Any], str]] = [
    ({"plant": ([1.0], [1.0, -1.0])}, r"assumption 2: the plant is not stable, pole at 1 1/s"),
    ({"plant": ([1.0], [1.0, 0.0])}, r"assumption 2: the plant is not stable, pole at 0"),
    ({"plant": ([-1.0, 50.0], [1.0, 20.0, 200.0])}, r"assumption 1: .* zero at 50 1/s"),
    (
        {"plant": (np.diag([-1.0, -2.0]), [[1.0], [1.0]], [[1.0, 0.0]], [[0.0]])},
        r"assumption 3: the plant is not observable, its mode -2 1/s",
    ),
    (
        {"internal_model": (np.diag([0.0, 3.0]), [[1.0, 0.0]])},
        r"assumption 4: .* its mode 3 1/s is no part of d",
    ),
    ({"plant": ([1.0, 0.0], [1.0, 20.0, 200.0])}, r"assumption 5: the eigenvalue 0 1/s of A_d"),
    (
        {
            "plant": ([1.0, 0.0, 900.0], [1.0, 60.0, 1200.0, 8000.0]),
            "internal_model": InternalModel.integrator() + InternalModel.sinusoid(30.0),
        },
        r"assumption 5: the eigenvalue .*30j",
    ),
    ({"internal_model": InternalModel.sinusoid(30.0)}, r"assumption 6: A_d has no eigenvalue at 0"),
    ({"internal_model": (-5.0, 1.0)}, r"assumption 6"),
    ({"controller": ([4e4], [1.0, 0.0])}, r"controller does not stabilize the plant"),
    ({"controller": ([-4.0, -8.0], [1.0, 0.0])}, r"controller does not stabilize the plant"),
    ({"controller": ([1.0, 0.0, 0.0], [1.0, 1.0])}, r"the controller is improper"),
    ({"plant": ([1.0, 0.0, 0.0], [1.0, 1.0])}, r"the plant is improper"),
    ({"plant": ([1.0, 3.0], [1.0, 1.0])}, r"the plant has a direct feedthrough of 1"),
    ({"plant": 3.0}, r"the plant has no states"),
    ({"plant": ([0.0], [1.0, 1.0])}, r"^the plant's gain is zero"),
    (
        {"plant": (np.diag([-1.0, -2.0]), [[1.0], [0.0]], [[0.0, 1.0]], [[0.0]])},
        r"^the plant's gain is zero",
    ),
    ({"Wu": ([1.0, 0.0, 1.0], [1.0, 1.0])}, r"Wu is improper: its numerator has degree 2"),
    ({"Wp": ([1.0, 0.0], [2.0])}, r"Wp is improper"),
    ({"Wu": ([1.0], [1.0, -3.0])}, r"Wu is not stable, pole at 3 1/s"),
    ({"Wp": ([1.0, 5.0], [1.0, 0.0])}, r"Wp is not stable, pole at 0 1/s; move the pole"),
    ({"Wp": 0.0}, r"Wp is zero"),
    ({"plant": control.ss(-np.eye(2), np.eye(2), np.ones((1, 2)), 0)}, r"the plant has 2 inputs"),
    ({"Wu": control.ss(-np.eye(1), [[1.0]], np.ones((2, 1)), 0)}, r"Wu has 1 inputs and 2 outputs"),
    ({"controller": control.tf([1.0], [1.0, -0.5], 0.1)}, r"the controller is sampled, dt = 0.1"),
    ({"delay": 1e-4}, r"delay is 0.0001 s with a plant in continuous time; give dt"),
    ({"plant": "G"}, r"the plant is str; give a transfer function"),
    ({"internal_model": "step"}, r"internal_model is 'step'"),
    ({"internal_model": (np.zeros((2, 2)), [[1.0]])}, r"C_d has shape \(1, 1\)"),
    ({"internal_model": (np.zeros((2, 3)), [[1.0]])}, r"A_d has shape \(2, 3\)"),
]


@pytest.mark.parametrize(("changed", "message"), BAD, ids=range(len(BAD)))
def test_refused(changed: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        observer_problem(**(GOOD | changed))
    assert "\n" not in str(caught.value)


def test_design_refuses_as_well() -> None:
    with pytest.raises(InputError, match="assumption 2"):
        design_disturbance_observer(**(GOOD | {"plant": ([1.0], [1.0, -1.0])}))


def test_good_is_accepted() -> None:
    assert observer_problem(**GOOD).order == 3


def test_unknown_method() -> None:
    with pytest.raises(InputError, match="method is 'lqr'"):
        design_disturbance_observer(**GOOD, method="lqr")


@pytest.mark.parametrize("degree", [-1])
def test_polynomial_of_negative_degree(degree: int) -> None:
    with pytest.raises(InputError, match="at least 0"):
        InternalModel.polynomial(degree)


def test_sinusoid_needs_a_frequency() -> None:
    with pytest.raises(InputError, match=r"frequency is .*above 0"):
        InternalModel.sinusoid(0.0)
