"""What a sampled observer cannot be designed for is refused, with what would do."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from observer_cases import OMEGA, PLANT, REPAIRED_C, WP, WU

import control
import hyst
from hyst.control import InternalModel, design_disturbance_observer, observer_problem
from hyst.errors import InputError

GOOD: dict[str, Any] = {
    "plant": PLANT, "controller": REPAIRED_C, "Wu": WU, "Wp": WP, "internal_model": "integrator",
    "dt": 1e-4,
}  # fmt: skip

FAST = 2.0 * np.pi * 6000.0
RESONANCE = ([FAST**2], [1.0, 0.02 * FAST, FAST**2])

BAD: list[tuple[dict[str, Any], str]] = [
    ({"delay": -1e-5}, r"delay is -1e-05"),
    ({"delay": 1.0}, r"the delay of 1 s is 1e\+04 samples"),
    ({"delay": 7e-3}, r"72 states with its delay of 70 samples; at most 60 can be run"),
    ({"dt": 0.0}, r"dt is 0"),
    ({"dt": None, "delay": 1e-5}, r"delay is 1e-05 s with a plant in continuous time; give dt"),
    ({"plant": ([1.0], [1.0, -1.0])}, r"plant is unstable|not stable"),
    ({"plant": ([1.0], [1.0, 0.0])}, r"assumption 2: the plant is not stable, pole at z = 1"),
    ({"plant": control.tf([0.1], [1.0, -1.0], 1e-4)}, r"assumption 2: .* pole at z = 1"),
    ({"plant": control.tf([0.1], [1.0, 1.0], 1e-4)}, r"assumption 2: .* pole at z = -1"),
    ({"plant": control.tf([0.1], [1.0, -0.5], 1e-3)}, r"the plant has dt = 0.001 s"),
    ({"plant": ([0.0], [1.0, 1.0])}, r"^the plant's gain is zero"),
    (
        {"plant": (np.diag([-1.0, -2.0]), [[1.0], [1.0]], [[1.0, 0.0]], [[0.0]])},
        r"assumption 3: the sampled plant is not observable, its mode z = 0.9998",
    ),
    (
        {"plant": RESONANCE},
        r"dt = 0.0001 s is too slow for the plant: its resonance at 3.77e\+04 rad/s is above half "
        r"the sample rate, 3.142e\+04 rad/s; sample every 4.2e-05 s or faster",
    ),
    ({"plant": ([1.0, 0.0], [1.0, 20.0, 200.0])}, r"assumption 5: the eigenvalue 0 1/s of A_d"),
    (
        {"internal_model": InternalModel.integrator() + InternalModel.sinusoid(4e4)},
        r"a sine of 4e\+04 rad/s, above half the sample rate",
    ),
    ({"internal_model": InternalModel.sinusoid(30.0)}, r"assumption 6: A_d has no eigenvalue at 0"),
    (
        {"dt": 4e-3},
        r"pole at z = -2.6.*; dt = 0.004 s is too slow for this controller, 0.002 s would do",
    ),
    (
        {"delay": 1e-3},
        r"does not stabilize the sampled plant: .* with a delay of 0.001 s at any sample time",
    ),
    ({"controller": ([-4.0, -8.0], [1.0, 0.0])}, r"does not stabilize .* check its sign"),
    (
        {"controller": control.tf([1.0], [1.0, -1.0], 1e-3)},
        r"the controller has dt = 0.001 s, the observer 0.0001 s",
    ),
    ({"controller": control.ss(-np.eye(2), np.eye(2), np.ones((1, 2)), 0)}, r"has 2 inputs"),
    ({"Wu": ([1.0], [1.0, -3.0])}, r"Wu is not stable"),
    ({"Wp": control.tf([1.0], [1.0, -0.5], 1e-3)}, r"Wp has dt = 0.001 s, the observer 0.0001 s"),
    ({"Wp": 0.0}, r"Wp is zero"),
    ({"discretization": "euler"}, r"method is 'euler'; give one of tustin, zoh"),
]


@pytest.mark.parametrize(("changed", "message"), BAD)
def test_what_cannot_be_is_refused(changed: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        observer_problem(**(GOOD | changed))


def test_the_rate_that_would_do_does() -> None:
    slow = GOOD | {"dt": 4e-3}
    with pytest.raises(InputError, match=r"0\.002 s would do"):
        observer_problem(**slow)
    assert observer_problem(**(slow | {"dt": 2e-3})).order == 3
    fast = GOOD | {"plant": RESONANCE, "controller": ([1.0], [1.0, 0.0])}
    assert observer_problem(**(fast | {"dt": 4.2e-5})).order == 3


def test_a_quiet_mode_above_half_the_rate_is_no_hindrance() -> None:
    # A hundredth of the gain at its peak: samples show it folded, and exactly so.
    main, small = control.tf(*PLANT), control.tf([1e-4 * FAST**2], [1.0, 0.02 * FAST, FAST**2])
    assert observer_problem(**(GOOD | {"plant": main + small})).order == 5


def test_slpmm_has_no_discrete_time() -> None:
    with pytest.raises(InputError, match="method 'slpmm' is of the design in continuous time"):
        design_disturbance_observer(**GOOD, method="slpmm")


def test_between_the_samples_of_a_sampled_plant_is_no_delay() -> None:
    w = OMEGA
    plant = hyst.control.discretize(([w * w], [1.0, 1.6 * w, w * w]), 1e-4, "zoh")
    with pytest.raises(
        InputError, match=r"is 0\.5 samples of a plant that is known at its samples"
    ):
        observer_problem(plant, REPAIRED_C, WU, WP, delay=5e-5)


def test_weights_that_cannot_be_met_are_told_with_row_and_frequency() -> None:
    # Wu is 1.5 at frequency 0, where the integrator makes T = 1.
    found = design_disturbance_observer(**(GOOD | {"Wu": 1.5}), starts=1)
    assert not found.feasible
    assert found.lower_bound >= 1.499
    assert "the internal model makes T = 1 at 0 rad/s, where Wu is 1.5" in found.message
    assert "Wu T is 1." in found.shortfall


def test_rejection_above_half_the_rate_has_to_be_paid() -> None:
    # Wp asks for a tenth of the disturbance up to half the rate; |E| has a mean of 1 there.
    found = design_disturbance_observer(**(GOOD | {"Wp": 10.0, "dt": 1e-3}), starts=1)
    assert found.lower_bound >= 9.9
    assert "with every observer" in found.message
    assert "Wp (1 - Q) is" in found.message
