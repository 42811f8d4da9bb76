"""The circle criterion on rates, inverses compared in a loop, and responses of the loop."""

from __future__ import annotations

import math

import numpy as np
import pytest

import hyst
from hyst.compensation import slope_range
from hyst.control import (
    closed_loop_poles,
    compare_inverses,
    first_unstable_slope,
    loop_responses,
    simulate_closed_loop,
    slope_margin,
)
from hyst.control.disturbance_observer import DisturbanceObserver, evaluate_gain, observer_problem
from hyst.control.disturbance_observer.certificate import loop as closed_from_disturbance
from hyst.errors import InputError
from hyst.studies.s1_robust_tracking import CONTROLLER, PLANT, PLAYS, PRINTED_GAIN, TRUE_PLANT

PLAIN = {"plant": ([50.0], [1.0, 50.0]), "controller": ([5.0], [1.0, 0.0])}


@pytest.fixture(scope="module")
def printed() -> DisturbanceObserver:
    second = [1.0, 960.0, 2400.0**2]
    Wu, Wp = ([-1.0, -960.0, 0.0], second), ([0.5, 64.0 * np.pi], [1.0, 0.2])
    return evaluate_gain(observer_problem(PLANT, CONTROLLER, Wu, Wp), PRINTED_GAIN, TRUE_PLANT)


def test_margin_by_hand() -> None:
    # 1/s around 1/(s+1) closed with c = 1: T = 1/(s^2 + s + 1), peak 2/sqrt(3) at w^2 = 1/2.
    margin = slope_margin(([1.0], [1.0, 1.0]), ([1.0], [1.0, 0.0]), None, (0.6, 1.4))
    assert margin == pytest.approx(math.sqrt(3.0) / 2.0 / 0.4, rel=1e-7)


def test_no_range_no_limit_and_an_unstable_middle() -> None:
    blocks = (([1.0], [1.0, 1.0]), ([1.0], [1.0, 0.0]), None)
    assert slope_margin(*blocks, (1.0, 1.0)) == math.inf
    # With the gain -1 the loop has a pole in the right half plane.
    assert slope_margin(*blocks, (-2.0, 0.0)) == 0.0


def test_it_is_never_above_what_constant_gains_allow(printed: DisturbanceObserver) -> None:
    """Each constant gain within the range is one of the varying ones: none may be unstable."""
    A, B, C, D = TRUE_PLANT.A, TRUE_PLANT.B, TRUE_PLANT.C, TRUE_PLANT.D
    for observer in (None, printed):
        for middle in (0.5, 1.0, 1.3):
            slopes = (middle - 0.1, middle + 0.1)
            half = 0.1 * slope_margin(TRUE_PLANT, CONTROLLER, observer, slopes)
            for gain in np.linspace(middle - 0.999 * half, middle + 0.999 * half, 9):
                poles = closed_loop_poles((A, gain * B, C, gain * D), CONTROLLER, observer)
                # A margin of 0 says that the middle itself is unstable.
                assert (poles.real.max() < 0.0) == (half > 0.0)


def test_scaled_inverses_of_the_paper_are_proven_stable(printed: DisturbanceObserver) -> None:
    for factor in (0.95, 0.7, 0.5):
        slopes = slope_range(PLAYS, hyst.Affine(factor) @ PLAYS.inverse(), 220.0)
        assert slope_margin(TRUE_PLANT, CONTROLLER, None, slopes) > 1.0
        assert slope_margin(TRUE_PLANT, CONTROLLER, printed, slopes) > 1.0


def test_the_first_unstable_slope(printed: DisturbanceObserver) -> None:
    # 1/s around 1/(s + 1)^2: s^3 + 2 s^2 + s + k is stable below k = 2, by Routh.
    blocks = (([1.0], [1.0, 2.0, 1.0]), ([1.0], [1.0, 0.0]), None)
    assert first_unstable_slope(*blocks, (0.5, 1.99)) is None
    # 200 slopes from 1 to 3.
    assert first_unstable_slope(*blocks, (1.0, 3.0)) == pytest.approx(2.0, abs=0.011)
    # Without any inverse the plays of S1 are too steep; with the exact one they are not.
    steep = slope_range(PLAYS, hyst.Affine(1.0), 37.0)
    assert first_unstable_slope(TRUE_PLANT, CONTROLLER, printed, steep) is not None
    assert first_unstable_slope(TRUE_PLANT, CONTROLLER, printed, (1.0, 1.0)) is None


def test_slopes_in_the_wrong_order() -> None:
    with pytest.raises(InputError, match="smaller one first"):
        slope_margin(1.0, ([1.0], [1.0, 0.0]), None, (2.0, 1.0))
    with pytest.raises(InputError, match="smaller one first"):
        first_unstable_slope(1.0, ([1.0], [1.0, 0.0]), None, (2.0, 1.0))


def test_comparison_of_inverses() -> None:
    model = hyst.PrandtlIshlinskii([0.5], [1.0], 1.0)
    r = 3.0 * np.sin(2.0 * np.pi * np.arange(4000) * 1e-3)
    shares: list[float] = []
    found = compare_inverses(
        r,
        1e-3,
        {"exact": model.inverse(), "none": None},
        observer=None,
        progress=shares.append,
        hysteresis=model,
        **PLAIN,
    )
    assert shares == [0.5, 1.0]
    alone = simulate_closed_loop(r, 1e-3, hysteresis=model, inverse=None, **PLAIN)
    assert np.array_equal(found.without["none"].y, alone.y)
    # Without an observer nothing is recovered, and the exact inverse adds nothing.
    assert math.isnan(found.recovered("exact"))
    assert found.recovered("none") == 0.0 or math.isnan(found.recovered("none"))


def test_a_loop_that_diverges_has_no_share() -> None:
    found = compare_inverses(
        np.ones(20_000),
        1e-3,
        {"exact": None, "wild": hyst.Affine(100.0)},
        observer=None,
        plant=([1.0], [1e-4, 2e-2, 1.0]),
        controller=([5.0], [1.0, 0.0]),
        limit=1e3,
    )
    assert found.added_error("wild") == math.inf
    assert math.isnan(found.recovered("wild"))
    with pytest.raises(InputError, match="no inverse"):
        compare_inverses([1.0, 1.0], 1e-3, {}, observer=None, **PLAIN)


@pytest.mark.parametrize("nominal", [True, False])
def test_responses_against_the_loop_in_state_space(
    printed: DisturbanceObserver, nominal: bool
) -> None:
    w = np.logspace(0, 4, 30)
    plant = PLANT if nominal else TRUE_PLANT
    found = loop_responses(printed, plant, w)
    inner = closed_from_disturbance(printed.problem, printed.gain, plant).response(1j * w)
    # Two realizations, of order 6 to 8, with coefficients up to 1e12.
    to_y, to_estimate = found.S, found.Q
    assert to_y == pytest.approx(np.abs(inner[:, 2, 0]), rel=1e-6)
    if nominal:
        assert to_estimate == pytest.approx(np.abs(inner[:, 1, 0]), rel=1e-6)
        assert found.left == pytest.approx(np.abs(1.0 - inner[:, 1, 0]), rel=1e-6)


def test_without_the_observer(printed: DisturbanceObserver) -> None:
    # Far below the integrator's corner P/(1 + P C) is s/8, by hand.
    found = loop_responses(printed, None, np.array([1e-3]))
    assert found.S_without[0] == pytest.approx(1e-3 / 8.0, rel=1e-3)
    assert found.S[0] < 1e-2 * found.S_without[0]
