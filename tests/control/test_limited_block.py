"""A tracking controller whose drive is limited: constants, memory, files, refusals."""

from __future__ import annotations

import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from closed_loop_cases import CONTROLLER, HYSTERESIS, INVERSE, OBSERVER
from hypothesis import given, settings
from hypothesis import strategies as st

import hyst
from hyst.control import TrackingController
from hyst.errors import InputError
from reference.examples import EXAMPLES

DT = 1e-4
RNG = np.random.default_rng(7)
Y_REF, Y = 60.0 * np.sin(np.arange(900) * 0.02), RNG.normal(0.0, 10.0, 900)


def limited(limits: Any = (-20.0, 30.0), rate: Any = None, **more: Any) -> TrackingController:
    arguments: dict[str, Any] = {"observer": OBSERVER, "inverse": INVERSE} | more
    return TrackingController.from_continuous(CONTROLLER, DT, limits=limits, rate=rate, **arguments)


@pytest.mark.parametrize("rate", [None, 2e4])
def test_drive_never_leaves_limits_and_rate(rate: float | None) -> None:
    u = limited(rate=rate).run(Y_REF, Y)[0]
    assert u.min() == -20.0
    assert u.max() == 30.0
    if rate is not None:
        # Differences of two numbers up to 30 are rounded.
        steps = np.abs(np.diff(u, prepend=0.0))
        assert steps.max() <= rate * DT * (1.0 + 1e-12) + 30.0 * 2.0**-52
        assert np.sum(steps > 0.999 * rate * DT) > 100


def test_within_limits_all_bits_are_those_of_a_block_without() -> None:
    free = TrackingController.from_continuous(CONTROLLER, DT, observer=OBSERVER, inverse=INVERSE)
    wide = limited((-1e9, 1e9), 1e15)
    u, state = free.run(Y_REF, Y)
    same, other = wide.run(Y_REF, Y)
    assert np.array_equal(u, same)
    assert np.array_equal(other[: state.size], state)
    step = wide.stepper()
    for a, b in zip(Y_REF, Y, strict=True):
        step(a, b)
    assert step.limited is False
    assert np.array_equal(wide.estimate(Y_REF, Y), free.estimate(Y_REF, Y))
    assert np.array_equal(wide.applied(Y_REF, Y), free.applied(Y_REF, Y))


def test_halves_and_steps_make_the_whole_bit_for_bit() -> None:
    block = limited(rate=2e4)
    whole, end = block.run(Y_REF, Y)
    first, middle = block.run(Y_REF[:411], Y[:411])
    second, same_end = block.run(Y_REF[411:], Y[411:], middle)
    assert np.array_equal(np.concatenate([first, second]), whole)
    assert np.array_equal(same_end, end)
    step = block.stepper()
    assert np.array_equal([step(a, b) for a, b in zip(Y_REF, Y, strict=True)], whole)
    assert np.array_equal(step.state, end)
    assert (step.fault, step.limited) == (False, True)
    step.clear_fault()
    assert step.limited is False


def test_memory_is_that_of_the_actuator_driven_by_what_was_applied() -> None:
    block = limited()
    u, state = block.run(Y_REF, Y)
    n = INVERSE.r.size
    v, memory = HYSTERESIS.run(u)
    # The forward operator is the inverse of the inverse: its constants are rounded twice.
    assert np.abs(state[block.order + n : -1] - memory).max() < 1e-10
    assert np.abs(state[block.order : block.order + n] - INVERSE.run(v)[1]).max() < 1e-10
    assert state[-1] == u[-1]


def test_linear_part_by_hand() -> None:
    # v = 2 e + 0.5 x, x+ = x + e and W = 1/2: on held samples e counts as the one that gives v_a.
    block = TrackingController(
        [[1.0]], [[1.0, -1.0]], [0.5], [2.0, -2.0], 1.0, limits=(-4.0, 4.0), W=[0.5]
    )
    u, state = block.run([1.0, 4.0, 4.0, 0.0], np.zeros(4))
    assert u.tolist() == [2.0, 4.0, 4.0, 2.03125]
    assert state.tolist() == [4.0625, 2.03125]


def test_estimate_is_the_observers_of_what_was_applied() -> None:
    """d_hat = O_v(z) v_a + O_y(z) y, also where the observer has feedthrough from v."""
    block = limited()
    assert block.G != 0.0
    u = block.run(Y_REF, Y)[0]
    applied = HYSTERESIS(u)
    of_v = hyst.control.discretized_dynamics(OBSERVER, DT, of_input=0)(applied)
    of_y = hyst.control.discretized_dynamics(OBSERVER, DT, of_input=1)(Y)
    d_hat = block.estimate(Y_REF, Y)
    # As in the test of the block without limits, in 900 steps.
    assert np.abs(d_hat - of_v - of_y).max() < 1e-9 * max(np.abs(of_v).max(), np.abs(of_y).max())


@pytest.mark.parametrize("bad", [np.nan, np.inf, 1e308])
def test_bad_samples_hold_a_drive_within_the_limits(bad: float) -> None:
    step = limited((5.0, 30.0)).stepper()
    assert step(bad, -bad) == 5.0
    assert (step.fault, step.limited) == (True, False)
    u, before = step(1.0, 0.5), step.state.copy()
    assert step(bad, -bad) == u
    assert np.array_equal(step.state, before)


def test_a_state_with_a_drive_beyond_the_limits_holds_one_within() -> None:
    block = limited((5.0, 30.0))
    state = block.initial_state()
    state[-1] = 100.0
    step = block.stepper(state)
    assert step(np.nan, 0.0) == 30.0
    assert state[-1] == 100.0


def invertible_both_ways() -> list[str]:
    found = []
    for name, model in EXAMPLES.items():
        if model.is_invertible() and model.inverse().is_invertible():
            found.append(name)
    return found


@pytest.mark.parametrize("name", invertible_both_ways())
def test_every_inverse_goes_on_with_the_memory_of_its_actuator(name: str) -> None:
    """After hundreds of held samples v within reach is reached at once, to rounding."""
    model = EXAMPLES[name]
    dt = model.dt or 1e-3
    forth = np.concatenate([np.linspace(0.0, 1.0, 60), np.linspace(1.0, -0.7, 60)])
    v = model(forth)  # within reach by construction
    span = float(np.ptp(v))
    if not 0.0 < span < 1e6:
        pytest.skip("this example does not move within this drive")
    block = TrackingController(
        [], [], [], [1.0, 0.0], dt, inverse=model.inverse(), limits=(-0.7, 1.0)
    )
    rng = np.random.default_rng(3)
    beyond = v.mean() + 0.6 * span * rng.standard_normal(300)  # of which many are out of reach
    step, actuator = block.stepper(), model.stepper()
    missed, reached = [], 0
    for wanted in beyond:
        u = step(wanted, 0.0)
        assert -0.7 <= u <= 1.0
        if step.limited:
            actuator(u)
        else:
            reached += 1
            missed.append(abs(actuator(u) - wanted))
        step.clear_fault()
    assert reached > 20
    # Rounding through inverse and forward operator in hundreds of steps; iterated inverses more.
    assert max(missed) < 1e-7 * span


@settings(max_examples=25, deadline=None)
@given(st.integers(-30, 30), st.integers(0, 2**31))
def test_units_of_the_drive_change_no_digit(power: int, seed: int) -> None:
    factor = 2.0**power
    rng = np.random.default_rng(seed)
    y_ref, y = rng.normal(0.0, 60.0, 80), rng.normal(0.0, 30.0, 80)
    plain = limited(rate=3e5)
    scaled = limited(
        (-20.0 * factor, 30.0 * factor), 3e5 * factor, inverse=hyst.Affine(factor) @ INVERSE
    )
    assert np.array_equal(scaled.run(y_ref, y)[0], factor * plain.run(y_ref, y)[0])
    assert np.array_equal(scaled.estimate(y_ref, y), plain.estimate(y_ref, y))


@settings(max_examples=25, deadline=None)
@given(st.integers(-30, 30), st.integers(0, 2**31))
def test_units_of_the_output_change_no_digit(power: int, seed: int) -> None:
    factor = 2.0**power
    rng = np.random.default_rng(seed)
    y_ref, y = rng.normal(0.0, 60.0, 80), rng.normal(0.0, 30.0, 80)
    plain, scaled = limited(), limited(inverse=INVERSE @ hyst.Affine(1.0 / factor))
    assert np.array_equal(scaled.run(factor * y_ref, factor * y)[0], plain.run(y_ref, y)[0])
    v = scaled.applied(factor * y_ref, factor * y)
    assert np.array_equal(v, factor * plain.applied(y_ref, y))


def test_a_drive_with_a_rate_alone() -> None:
    block = limited(None, 1e3)
    u = block.run(Y_REF, Y)[0]
    assert np.abs(np.diff(u, prepend=0.0)).max() <= 0.1 * (1.0 + 1e-12)
    assert block.initial_state()[-1] == 0.0


@pytest.mark.parametrize(
    "block",
    [
        limited(rate=2e4),
        limited(None, 1e3),
        limited(inverse=hyst.Affine(0.7) @ INVERSE),
        limited(inverse=INVERSE, hysteresis=HYSTERESIS),
        limited((10.0, 30.0), observer=None, inverse=None),
    ],
)
def test_file_keeps_every_double(block: TrackingController, tmp_path: Path) -> None:
    path = tmp_path / "block.json"
    block.save(path)
    read = hyst.load(path)
    assert read == block
    assert pickle.loads(pickle.dumps(block)) == block
    assert np.array_equal(read.run(Y_REF, Y)[0], block.run(Y_REF, Y)[0])
    assert np.array_equal(read.initial_state(), block.initial_state())


def test_files_hold_new_entries_only_where_they_are_used(tmp_path: Path) -> None:
    path = tmp_path / "block.json"
    TrackingController.from_continuous(CONTROLLER, DT).save(path)
    assert set(json.loads(path.read_text())["model"]) == {"kind", "dt", *"ABCDEF"}
    limited(inverse=None, observer=None).save(path)
    assert set(json.loads(path.read_text())["model"]) == {"kind", "dt", *"ABCDEF", "limits", "W"}


SATURATED = hyst.DeadZone([1.0, -1.0, -1.0], [0.0, 35.0, -35.0]) @ INVERSE
COARSE = hyst.PrandtlIshlinskii([0.3, 1.0], [10.0, 30.0], 0.3)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"limits": (1.0, 1.0)}, r"limits is \(1.0, 1.0\); give the lowest drive first"),
        ({"limits": (30.0, -20.0)}, "the highest above it"),
        ({"limits": 35.0}, "limits is 35.0; give the lowest and the highest"),
        ({"limits": (0.0, np.inf)}, "the highest drive is inf"),
        ({"rate": 0.0}, "rate is 0.0"),
        ({"rate": np.nan}, "rate is nan"),
        ({"rate": 1e-323}, "a sample; give one that can be counted"),
        ({"inverse": SATURATED}, "is not known .*; give it as hysteresis"),
        ({"inverse": COARSE.inverse(), "hysteresis": HYSTERESIS}, r"up to \d+.* off"),
        ({"inverse": hyst.Affine(0.7) @ INVERSE, "hysteresis": HYSTERESIS}, r"up to \d+.* off"),
        ({"limits": None, "rate": 1.0, "hysteresis": HYSTERESIS}, "give limits, too"),
        ({"inverse": None, "hysteresis": HYSTERESIS}, "no inverse for the hysteresis to belong to"),
        ({"hysteresis": "stage.json"}, "hysteresis is str"),
        ({"limits": None, "hysteresis": HYSTERESIS}, "belong to limits or a rate"),
    ],
)
def test_refused(arguments: dict[str, Any], says: str) -> None:
    with pytest.raises(InputError, match=says):
        limited(**arguments)


def test_a_gain_is_needed_where_there_are_states() -> None:
    matrices: tuple[Any, ...] = ([[1.0]], [[1.0, -1.0]], [0.5], [2.0, -2.0], 1.0)
    with pytest.raises(InputError, match="a limited drive needs W"):
        TrackingController(*matrices, limits=(0.0, 1.0))
    with pytest.raises(InputError, match="W has 2 entries; give 1"):
        TrackingController(*matrices, limits=(0.0, 1.0), W=[0.0, 0.0])
    with pytest.raises(InputError, match="hysteresis and W belong to limits"):
        TrackingController(*matrices, W=[0.0])


def test_an_inverse_without_a_known_one_of_its_own_takes_the_hysteresis() -> None:
    # Saturated beyond the limits: within them it is the exact inverse.
    block = limited((-34.0, 34.0), inverse=SATURATED, hysteresis=HYSTERESIS)
    other = limited((-34.0, 34.0))
    difference = np.abs(block.run(Y_REF, Y)[0] - other.run(Y_REF, Y)[0])
    assert difference.max() < 1e-9
