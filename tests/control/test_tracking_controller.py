"""The tracking controller: its equations, its state, its files, and what it makes of a loop."""

from __future__ import annotations

import itertools
import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.signal
from closed_loop_cases import CONTROLLER, HYSTERESIS, INVERSE, OBSERVER, PLANT, reference

import hyst
from hyst.control import (
    TrackingController,
    closed_loop_poles,
    discretize,
    discretized_dynamics,
    simulate_closed_loop,
)
from hyst.errors import InputError

DT = 1e-4
METHODS = ("tustin", "zoh")
RNG = np.random.default_rng(5)
Y_REF, Y = 30.0 * np.sin(np.arange(800) * 0.02), RNG.normal(0.0, 20.0, 800)


def full(method: Any = "tustin", dt: float = DT) -> TrackingController:
    return TrackingController.from_continuous(
        CONTROLLER, dt, observer=OBSERVER, inverse=INVERSE, method=method
    )


def test_pi_controller_by_hand() -> None:
    # Trapezoidal rule: v_k = 4 e_k + 8 s_k, s_k = s_{k-1} + dt (e_k + e_{k-1}) / 2.
    pi = TrackingController.from_continuous(CONTROLLER, 0.5)
    assert pi.run([1.0, 1.0, 0.0], [0.0, 0.5, 1.0])[0] == pytest.approx(
        [4.0 + 2.0, 2.0 + 5.0, -4.0 + 4.0], abs=1e-14
    )
    # Held: s_k = s_{k-1} + dt e_{k-1}.
    held = TrackingController.from_continuous(CONTROLLER, 0.5, method="zoh")
    assert held.run([1.0, 1.0, 0.0], [0.0, 0.5, 1.0])[0] == pytest.approx(
        [4.0, 2.0 + 4.0, -4.0 + 6.0], abs=1e-14
    )


@pytest.mark.parametrize("method", METHODS)
def test_is_its_parts_in_a_loop_of_their_own(method: Any) -> None:
    """v = C(z)(y_ref - y) - d_hat, d_hat = O_v(z) v + O_y(z) y, u = inverse(v)."""
    whole = full(method)
    u, state = whole.run(Y_REF, Y)
    v = TrackingController(whole.A, whole.B, whole.C, whole.D, DT).run(Y_REF, Y)[0]
    of_e = discretized_dynamics(CONTROLLER, DT, method)(Y_REF - Y)
    of_v = discretized_dynamics(OBSERVER, DT, method, of_input=0)(v)
    of_y = discretized_dynamics(OBSERVER, DT, method, of_input=1)(Y)
    # 800 steps of about 10 operations each, of numbers as large as 4 e, through an observer whose
    # channels of v and of y nearly cancel.
    rounding = 1e-9 * np.abs(v).max()
    assert np.abs(v - (of_e - of_v - of_y)).max() < rounding
    assert np.abs(whole.estimate(Y_REF, Y) - (of_v + of_y)).max() < rounding
    assert np.array_equal(u, INVERSE(v))
    assert np.array_equal(state[whole.order :], INVERSE.run(v)[1])


@pytest.mark.parametrize(("method", "known_as"), [("tustin", "bilinear"), ("zoh", "zoh")])
def test_discretization_agrees_with_scipy(method: Any, known_as: str) -> None:
    for system in (OBSERVER, (np.array([[-3.0]]), np.eye(1), np.eye(1), 2.0 * np.eye(1))):
        for dt in (1e-5, 1e-3, 0.1):
            ours = discretize(system, dt, method)
            A, B, C, D, _ = scipy.signal.cont2discrete(system, dt, method=known_as)
            poles = np.abs(ours.poles())
            assert poles.max() < 1.0
            z = np.exp(1j * np.linspace(0.1, 3.0, 7))
            for point in z:
                expected = C @ np.linalg.solve(point * np.eye(len(A)) - A, B) + D
                got = ours.C @ np.linalg.solve(point * np.eye(ours.order) - ours.A, ours.B) + ours.D
                # SciPy does not balance; its exponential of entries up to 3e5 loses some digits.
                assert got == pytest.approx(expected, rel=1e-6, abs=1e-9)


def test_discretization_that_cannot_be() -> None:
    with pytest.raises(InputError, match="cannot sample a pole at 2/dt = 20"):
        discretize(([1.0], [1.0, -20.0]), 0.1)
    with pytest.raises(InputError, match="method is 'euler'"):
        discretize(CONTROLLER, 0.1, "euler")  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"dt = 0.1 s, not 0.2 s"):
        discretize(discretize(CONTROLLER, 0.1), 0.2)
    with pytest.raises(InputError, match="no channel from input 2"):
        discretized_dynamics(OBSERVER, 0.1, of_input=2)
    sampled = discretize(CONTROLLER, 0.1)
    assert discretize(sampled, 0.1) is sampled


def test_trapezoidal_rule_takes_states_of_very_different_size() -> None:
    # States of an observer may differ by 1e12 in size; the transfer function is that of equal ones.
    A, b, c = np.array([[-3.0, -40.0], [40.0, -3.0]]), np.array([[1.0], [2.0]]), [[3.0, -1.0]]
    scale = np.array([1e-9, 1e9])
    scaled = (A * scale[:, None] / scale, b * scale[:, None], c / scale, [[0.5]])
    plain = scipy.signal.cont2discrete((A, b, np.array(c), np.eye(1) / 2.0), 0.01, "bilinear")
    numerator, denominator = scipy.signal.ss2tf(*plain[:4])
    z = np.exp(1j * np.array([0.01, 0.4, 2.0]))
    expected = np.polyval(numerator[0], z) / np.polyval(denominator, z)
    found = discretize(scaled, 0.01)
    response = [
        (found.C @ np.linalg.solve(at * np.eye(2) - found.A, found.B) + found.D)[0, 0] for at in z
    ]
    # Rounding of polynomials of order 2.
    np.testing.assert_allclose(response, expected, rtol=1e-10)


def test_halves_make_the_whole_bit_for_bit() -> None:
    controller = full()
    whole, end = controller.run(Y_REF, Y)
    first, middle = controller.run(Y_REF[:300], Y[:300])
    second, same_end = controller.run(Y_REF[300:], Y[300:], middle)
    assert np.array_equal(np.concatenate([first, second]), whole)
    assert np.array_equal(same_end, end)
    assert middle.size == controller.order + INVERSE.r.size


def test_steps_make_the_record_bit_for_bit() -> None:
    controller = full()
    step = controller.stepper()
    u = [step(a, b) for a, b in zip(Y_REF.tolist(), Y.tolist(), strict=True)]
    whole, end = controller.run(Y_REF, Y)
    assert np.array_equal(u, whole)
    assert np.array_equal(step.state, end)
    assert step.fault is False


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 1e308])
def test_bad_sample_holds_drive_and_state_and_raises_a_flag_that_stays(bad: float) -> None:
    step = full().stepper()
    assert step(np.nan, 0.0) == 0.0
    step.clear_fault()
    u = step(1.0, 0.5)
    before = step.state.copy()
    for sample in ((bad, 0.0), (0.0, -bad)):
        assert step(*sample) == u
        assert step.fault is True
    assert np.array_equal(step.state, before)
    step(1.0, 0.5)
    assert step.fault is True
    step.clear_fault()
    assert step.fault is False


def test_state_of_a_stepper_is_live_and_can_be_restored() -> None:
    controller = full()
    step = controller.stepper()
    step(1.0, 0.0)
    saved = step.state.copy()
    u = step(2.0, 0.0)
    step.state[:] = saved
    assert step(2.0, 0.0) == u
    assert controller.stepper(saved)(2.0, 0.0) == u
    with pytest.raises(InputError, match="state has shape"):
        controller.stepper(np.zeros(3))
    with pytest.raises(InputError, match="float64"):
        controller.run(Y_REF, Y, np.zeros(14, dtype=np.float32))


def test_stepper_outlives_the_controller() -> None:
    step = full().stepper()  # nothing else holds the controller
    assert np.isfinite(step(1.0, 0.0))


@pytest.mark.parametrize("method", METHODS)
def test_loop_with_the_sampled_controller_tends_to_the_continuous_one(method: Any) -> None:
    differences = []
    for dt in (4e-5, 2e-5, 1e-5):
        around = {"plant": PLANT, "hysteresis": HYSTERESIS}
        r = reference(0.5, dt)
        continuous = simulate_closed_loop(
            r, dt, controller=CONTROLLER, observer=OBSERVER, inverse=INVERSE, **around
        )
        sampled = simulate_closed_loop(r, dt, controller=full(method, dt), **around)
        assert sampled.d_hat.size == r.size
        differences.append(np.abs(sampled.y - continuous.y).max())
    # Both are of first order, so their difference halves with dt.
    for coarse, fine in itertools.pairwise(differences):
        assert 1.7 < coarse / fine < 2.3
    assert differences[-1] < 0.01


def test_loop_runs_the_very_steps_of_the_controller() -> None:
    controller, dt = full(dt=2e-5), 2e-5
    r = reference(0.2, dt)
    loop = simulate_closed_loop(
        r, dt, plant=PLANT, controller=controller, hysteresis=HYSTERESIS, noise=0.1, disturbance=0.5
    )
    assert np.array_equal(controller.run(r, loop.y_measured)[0], loop.u)
    assert np.array_equal(controller.estimate(r, loop.y_measured), loop.d_hat)
    assert np.array_equal(INVERSE(loop.v), loop.u)
    assert np.array_equal(HYSTERESIS(loop.u + 0.5), loop.eta)


def test_loop_around_an_identified_plant_with_delay() -> None:
    plant = hyst.LinearDynamics([[0.5]], [0.25], [1.0], 0.5, dt=0.1, delay=2)
    controller = TrackingController([], [], [], [0.4, -0.4], dt=0.1)
    r = np.ones(200)
    loop = simulate_closed_loop(r, 0.1, plant=plant, controller=controller)
    assert np.abs(plant(loop.u) - loop.y).max() < 1e-14
    assert np.abs(loop.u - 0.4 * (r - loop.y)).max() < 1e-14
    poles = closed_loop_poles(plant, controller)
    # (z - 0.5) z^2 + 0.4 (0.5 (z - 0.5) + 0.25) = z^3 - 0.5 z^2 + 0.2 z
    assert np.abs(np.poly(poles) - [1.0, -0.5, 0.2, 0.0]).max() < 1e-12


def test_feedthrough_of_the_plant_shows_the_drive_of_the_sample_before() -> None:
    controller = TrackingController([], [], [], [1.0, -1.0], dt=1.0)
    loop = simulate_closed_loop(np.ones(4), 1.0, plant=0.5, controller=controller)
    # y_k = u_{k-1} / 2, u_k = 1 - y_k
    assert loop.y.tolist() == [0.0, 0.5, 0.25, 0.375]
    assert closed_loop_poles(0.5, controller) == pytest.approx([-0.5])


def test_file_keeps_every_double(tmp_path: Path) -> None:
    given = full()
    start = TrackingController(
        given.A, given.B, given.C, given.D, DT, hyst.Affine(0.7) @ INVERSE, x0=np.full(4, 1 / 3)
    )
    for controller in (given, start, TrackingController([], [], [], [1.0, -1.0], 1.0)):
        path = tmp_path / "controller.json"
        controller.save(path, hyst.ModelDescription(input_unit="um"))
        read = hyst.load(path)
        assert read == controller
        assert hash(read) == hash(controller)
        assert np.array_equal(read.run(Y_REF, Y)[0], controller.run(Y_REF, Y)[0])
        assert pickle.loads(pickle.dumps(controller)) == controller
    assert start != given
    assert start.initial_state()[:4].tolist() == [1 / 3] * 4


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"gain": 1.0}, "unknown entry 'gain'"),
        ({"A": None}, "holds None"),
        ({"dt": True}, "holds True"),
        ({"dt": 0.0}, "dt is 0.0"),
        ({"B": [[1.0], [1.0, 2.0]]}, "not a rectangular array"),
        ({"inverse": {"kind": "magic"}}, "unknown kind of operator 'magic'"),
        (
            {"inverse": {"kind": "tracking-controller"}},
            "unknown kind of operator 'tracking-controller'",
        ),
        ({"E": None}, "holds None"),
        ({"D": [1.0]}, "D has 1 entries; give 2"),
    ],
)
def test_damaged_file_is_refused(tmp_path: Path, change: dict[str, Any], says: str) -> None:
    path = tmp_path / "controller.json"
    full().save(path)
    content = json.loads(path.read_text())
    content["model"] |= change
    path.write_text(json.dumps(content))
    with pytest.raises(InputError, match=says) as refused:
        hyst.load(path)
    assert str(path) in str(refused.value)


def test_missing_entry_is_refused() -> None:
    data = full().to_dict()
    del data["C"]
    with pytest.raises(InputError, match="'C' is missing"):
        TrackingController.from_dict(data)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"A": np.eye(2)}, r"A has shape \(2, 2\); C has 1 entries"),
        ({"B": [1.0, -1.0]}, r"B has shape \(2,\)"),
        ({"B": [[1.0, np.nan]]}, "is nan"),
        ({"D": [1.0, 2.0, 3.0]}, "D has 3 entries"),
        ({"dt": -1.0}, "dt is -1.0"),
        ({"inverse": 0.7}, "inverse is float"),
        ({"inverse": hyst.LinearDynamics([], [], [], 1.0, 2.0)}, "the controller has dt = 1 s"),
        ({"E": [1.0]}, "E and F belong together"),
        ({"E": [1.0, 2.0], "F": [0.0, 0.0]}, "E has 2 entries"),
        ({"x0": [1.0, 2.0]}, "x0 has 2 entries"),
    ],
)
def test_refused(arguments: dict[str, Any], says: str) -> None:
    good: dict[str, Any] = {"A": [[1.0]], "B": [[1.0, -1.0]], "C": [0.5], "D": [2.0, -2.0], "dt": 1}
    TrackingController(**good)
    with pytest.raises(InputError, match=says):
        TrackingController(**(good | arguments))


def test_more_states_than_a_target_has_room_for() -> None:
    with pytest.raises(InputError, match="65 states; at most 64"):
        TrackingController(np.eye(65), np.zeros((65, 2)), np.zeros(65), [1.0, 1.0], 1.0)


def test_records_that_do_not_fit() -> None:
    controller = full()
    with pytest.raises(InputError, match=r"y_ref has shape \(3,\) and y \(2,\)"):
        controller.run([1.0, 2.0, 3.0], [1.0, 2.0])
    with pytest.raises(InputError, match=r"y\[1\] is nan"):
        controller.run([1.0, 2.0], [1.0, np.nan])
    with pytest.raises(InputError, match="overflows at sample 0"):
        controller.run([1e308], [-1e308])
    without = TrackingController([[1.0]], [[1.0, -1.0]], [0.5], [2.0, -2.0], dt=1.0)
    with pytest.raises(InputError, match="E and F were not given"):
        without.estimate([1.0], [0.0])
