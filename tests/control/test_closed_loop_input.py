"""What a closed loop refuses, and how it says so."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from closed_loop_cases import CONTROLLER, HYSTERESIS, INVERSE, OBSERVER, PLANT

import hyst
from hyst.control import (
    LinearSystem,
    TrackingController,
    closed_loop_poles,
    simulate_closed_loop,
)
from hyst.errors import InputError
from hyst.report import draw_closed_loops

LOOP: dict[str, Any] = {"plant": PLANT, "controller": CONTROLLER}
RAMP = np.arange(100.0)
RATE_DEPENDENT = hyst.RateDependentPrandtlIshlinskii([0.5], [1.0], beta=0.1, dt=2e-3, p0=1.0)
SAMPLED = TrackingController.from_continuous(CONTROLLER, 1e-3)


@pytest.mark.parametrize(
    ("changed", "says"),
    [
        ({"hysteresis": lambda u: u}, "hysteresis is function; give an operator"),
        ({"inverse": 0.7}, "inverse is float; give an operator"),
        ({"hysteresis": RATE_DEPENDENT}, "dt = 0.001 s, the model 0.002"),
        ({"inverse": RATE_DEPENDENT}, "dt = 0.001 s, the model 0.002"),
        ({"noise": np.ones(99)}, "noise has 99 samples, the reference 100"),
        ({"disturbance": np.ones(101)}, "disturbance has 101 samples"),
        ({"noise": np.full(100, np.nan)}, r"noise\[0\] is nan"),
        ({"noise": -1.0}, "noise is -1.0"),
        ({"noise": 1.0, "seed": -3}, "seed is -3"),
        ({"noise": 1.0, "seed": 0.5}, "seed is 0.5"),
        ({"disturbance": np.inf}, "disturbance is inf"),
        ({"disturbance_at": "output"}, "disturbance_at is 'output'; give one of hysteresis, plant"),
        ({"algebraic_loop": "guess"}, "algebraic_loop is 'guess'"),
        ({"settle": 0.1}, "settle is 0.1 s of 0.1 s"),
        ({"settle": -1.0}, "settle is -1.0"),
        ({"limit": 0.0}, "limit is 0.0"),
        ({"plant": ([1.0, 0.0, 0.0], [1.0, 1.0])}, "the plant is improper"),
        ({"plant": ([1.0], [1.0, -1.0])}, "the plant is unstable: it has the pole 1"),
        ({"plant": OBSERVER}, "the plant has 2 inputs and 1 outputs"),
        ({"plant": "P"}, "the plant is str"),
        ({"controller": ([1.0, 0.0], [1.0])}, "the controller is improper"),
        ({"controller": OBSERVER}, "the controller has 2 inputs"),
        ({"observer": CONTROLLER}, "the observer has 1 inputs and 1 outputs"),
        ({"observer": (-OBSERVER[0], *OBSERVER[1:])}, "the observer is not stable"),
        ({"plant": LinearSystem([[0.5]], [[1.0]], [[1.0]], [[0.0]], 1e-3)}, "the plant is sampled"),
        ({"controller": LinearSystem([[0.5]], [[1.0]], [[1.0]], [[0.0]], 1e-3)}, "is sampled"),
        ({"controller": SAMPLED, "inverse": INVERSE}, "has its own inverse and observer"),
        ({"controller": SAMPLED, "observer": OBSERVER}, "has its own inverse and observer"),
        (
            {"controller": TrackingController.from_continuous(CONTROLLER, 2e-3)},
            "the controller has dt = 0.002 s, the loop 0.001 s",
        ),
        (
            {
                "controller": SAMPLED,
                "plant": hyst.LinearDynamics([[0.5]], [1.0], [1.0], 0.0, 2e-3),
            },
            "the plant has dt = 0.002 s, the loop 0.001 s",
        ),
    ],
)
def test_refused(changed: dict[str, Any], says: str) -> None:
    with pytest.raises(InputError, match=says):
        simulate_closed_loop(RAMP, 1e-3, **(LOOP | changed))


@pytest.mark.parametrize(
    ("reference", "dt", "says"),
    [
        ([], 1e-3, "reference is empty"),
        ([0.0, np.nan], 1e-3, r"reference\[1\] is nan"),
        (np.ones((2, 5)), 1e-3, r"reference has shape \(2, 5\)"),
        (RAMP, 0.0, "dt is 0.0"),
        (RAMP, np.nan, "dt is nan"),
    ],
)
def test_reference_and_dt(reference: Any, dt: float, says: str) -> None:
    with pytest.raises(InputError, match=says):
        simulate_closed_loop(reference, dt, **LOOP)


def test_observer_that_leaves_v_open_is_refused() -> None:
    observer = (np.zeros((0, 0)), np.zeros((0, 2)), np.zeros((1, 0)), np.array([[-1.0, 0.0]]))
    with pytest.raises(InputError, match="v is not determined"):
        simulate_closed_loop(RAMP, 1e-3, **LOOP, observer=observer)


def test_loop_of_gain_one_has_no_poles() -> None:
    with pytest.raises(InputError, match="feedthrough round the loop is 1"):
        closed_loop_poles(2.0, -0.5)


def test_a_plant_that_integrates_is_no_unstable_one() -> None:
    loop = simulate_closed_loop(np.ones(2000), 1e-2, plant=([1.0], [1.0, 0.0]), controller=2.0)
    # y' = 2 (1 - y); held over dt, y_k = 1 - 0.98^k.
    assert np.abs(loop.y - (1.0 - 0.98 ** np.arange(2000))).max() < 1e-12


def test_a_given_limit_decides_what_divergence_is() -> None:
    loop = simulate_closed_loop(
        np.ones(1000), 1e-2, plant=([1.0], [1.0, 1.0]), controller=9.0, limit=0.5
    )
    # y' = 9 - 10 y: y = 0.9 (1 - exp(-10 t)) is 0.5 at t = 0.0811 s; held, a sample earlier.
    assert loop.diverged_at == pytest.approx(0.08, abs=0.011)
    assert loop.y.max() <= 0.5


def test_signals_that_overflow_end_the_loop_without_a_warning() -> None:
    loop = simulate_closed_loop(
        np.zeros(500),
        1.0,
        plant=0.5,
        controller=-9.0,
        disturbance=1.0,
        algebraic_loop="delay",
        limit=1e300,
    )
    assert loop.diverged_at is not None
    assert np.isfinite(loop.y).all()
    assert np.isfinite(loop.u).all()


def test_figure() -> None:
    loop = simulate_closed_loop(RAMP, 1e-3, **LOOP, hysteresis=HYSTERESIS, inverse=INVERSE)
    diverged = simulate_closed_loop(RAMP, 1e-3, plant=3.0, controller=1.0, algebraic_loop="delay")
    drawn = draw_closed_loops(
        {"exact": loop, "delayed": diverged}, "Loops", ("d", "um"), ("u", "V")
    )
    assert drawn.startswith(b"\x89PNG")
    assert drawn == draw_closed_loops(
        {"exact": loop, "delayed": diverged}, "Loops", ("d", "um"), ("u", "V")
    )
    assert draw_closed_loops({"exact": loop}) != draw_closed_loops({"delayed": diverged})
    with pytest.raises(InputError, match="there are 0 loops"):
        draw_closed_loops({})
