"""What a controller takes back of what its drive could not do: gains, and that they settle."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from closed_loop_cases import CONTROLLER, OBSERVER

from hyst.control import LinearSystem, TrackingController, discretize
from hyst.control.anti_windup import anti_windup, conditioning_gain
from hyst.control.controller_parts import disturbance_observer_of, joined
from hyst.errors import InputError

DT = 1e-3
METHODS = ("tustin", "zoh")
# gain, zeros, poles of continuous controllers; 0 is an integrator.
CONTROLLERS: dict[str, Any] = {
    "integral": ([50.0], [1.0, 0.0]),
    "pi": ([4.0, 8.0], [1.0, 0.0]),
    "slow pi": ([4.0, 1e-4], [1.0, 0.0]),
    "pid, filtered": ([0.05 + 2e-3, 2.0 + 8e-3 + 20.0 * 1e-3, 20.0], [1e-3, 1.0, 0.0]),
    "double integrator with lead": ([1.0, 30.0], [1e-4, 1.0, 0.0, 0.0]),
    "integral with notch": ([1.0, 2.0, 1e6], [1.0, 1000.0, 1e6, 0.0]),
    "pi with lag": ([4.0, 8.0], [0.002, 1.0, 0.0]),
    "zero on the right": ([-1.0, 300.0], [1.0, 10.0, 0.0]),
    "resonant": ([1.0, 0.0], [1.0, 0.0, 1e4]),
    "unstable": ([1.0, 10.0], [1.0, -5.0, 0.0]),
    "lag": ([1.0], [0.1, 1.0]),
    "gain": 3.0,
}


def poles_held(controller: LinearSystem, L: np.ndarray) -> np.ndarray:
    return np.linalg.eigvals(controller.A - np.outer(L, controller.C[0]))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", CONTROLLERS)
def test_what_is_held_settles(name: str, method: Any) -> None:
    sampled = discretize(CONTROLLERS[name], DT, method)
    L = conditioning_gain(sampled)
    assert L.shape == (sampled.order,)
    sizes = np.abs(poles_held(sampled, L))
    assert sizes.max(initial=0.0) < 1.0
    if name == "slow pi":
        return  # its zero decays within 4e4 s
    # Nothing slower than ten times the slowest part of the controllers above, 0.5 s.
    assert sizes.max(initial=0.0) < 1.0 - DT / 5.0


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", ["pi", "slow pi", "pid, filtered"])
def test_zeros_inside_give_the_conditioned_controller(name: str, method: Any) -> None:
    sampled = discretize(CONTROLLERS[name], DT, method)
    expected = sampled.B[:, 0] / sampled.D[0, 0]
    assert conditioning_gain(sampled) == pytest.approx(expected, rel=1e-12)


def test_held_integrator_by_hand() -> None:
    # x+ = x + b e, output x: the predictor of unit noise with as much at its output as one answer,
    # b^2, has P = b^2 (1 + sqrt(5)) / 2 and the gain P / (P + b^2) = 0.618...
    sampled = discretize(CONTROLLERS["integral"], DT, "zoh")
    scale = sampled.C[0, 0]  # of the state
    golden = 0.5 * (1.0 + np.sqrt(5.0))
    assert conditioning_gain(sampled)[0] * scale == pytest.approx(golden / (golden + 1.0), rel=1e-9)


@pytest.mark.parametrize("name", CONTROLLERS)
def test_units_change_no_digit(name: str) -> None:
    sampled = discretize(CONTROLLERS[name], DT)
    factor = 2.0**-17
    scaled = LinearSystem(sampled.A, sampled.B, factor * sampled.C, factor * sampled.D, DT)
    assert np.array_equal(conditioning_gain(scaled) * factor, conditioning_gain(sampled))


@pytest.mark.parametrize("seed", range(40))
def test_controllers_at_random_settle(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 7))
    A = rng.normal(size=(n, n))
    A *= rng.uniform(0.2, 1.3) / np.abs(np.linalg.eigvals(A)).max()  # inside or outside
    d = rng.normal() * float(rng.integers(0, 2))
    scales = 10.0 ** rng.uniform(-4.0, 4.0, n)
    B, C = rng.normal(size=(n, 1)) * scales[:, None], rng.normal(size=(1, n)) / scales
    sampled = LinearSystem(A * scales[:, None] / scales, B, C, [[d]], DT)
    assert np.abs(poles_held(sampled, conditioning_gain(sampled))).max() < 1.0


def test_hidden_integrator_is_refused() -> None:
    hidden = LinearSystem([[1.0, 0.0], [0.0, 0.5]], [[0.0], [1.0]], [[1.0, 1.0]], [[0.0]], DT)
    with pytest.raises(InputError, match=r"pole 1\+0j is not reached by its input"):
        conditioning_gain(hidden)


@pytest.mark.parametrize("method", METHODS)
def test_block_as_a_whole_settles_and_its_observer_sees_what_was_applied(method: Any) -> None:
    dt = 1e-4
    C, observer = discretize(CONTROLLER, dt, method), discretize(OBSERVER, dt, method)
    W, G = anti_windup(C, observer)
    whole = joined(C, observer)
    rng = np.random.default_rng(0)
    x = rng.normal(size=whole.order) * np.array([1.0, 1e-3, 1e-6, 1.0])
    y_ref, y, applied = rng.normal(size=3)
    v, d_hat = whole.C @ x + whole.D @ [y_ref, y]
    x_next = whole.A @ x + whole.B @ [y_ref, y] + W * (applied - v)
    # The observer by itself, fed with the v that was applied.
    told = observer.C[0] @ x[1:] + observer.D[0] @ [applied, y]
    of_observer = observer.A @ x[1:] + observer.B @ [applied, y]
    assert d_hat + G * (applied - v) == pytest.approx(told, rel=1e-9)
    assert x_next[1:] == pytest.approx(of_observer, rel=1e-9)
    # C by itself, with the error of which applied + d_hat is its output.
    error = (applied + told - C.C[0] @ x[:1]) / C.D[0, 0]
    assert x_next[:1] == pytest.approx(C.A @ x[:1] + C.B[:, 0] * error, rel=1e-9)
    assert np.abs(np.linalg.eigvals(whole.A - np.outer(W, whole.C[0]))).max() < 1.0


def test_sampled_observer_is_taken_as_it_is() -> None:
    dt = 1e-4
    sampled = discretize(disturbance_observer_of(OBSERVER), dt)
    blocks = [
        TrackingController.from_continuous(CONTROLLER, dt, observer=each, limits=(-1.0, 1.0))
        for each in (OBSERVER, sampled)
    ]
    assert blocks[0] == blocks[1]
