"""The block for references that repeat, against its equations written out in NumPy."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path

import numpy as np
import pytest
from repetitive_cases import DT, STAGE, N, by_period, difference_equation, loop, wanted

import hyst
from hyst import InputError, PrandtlIshlinskii
from hyst.control import RepetitiveController, simulate_closed_loop
from hyst.models import LinearDynamics
from hyst.operators import Affine, ModelDescription
from hyst.operators.verdict import Verdict

ACTUATOR = PrandtlIshlinskii([0.3, 0.2, 0.1], [0.1, 0.3, 0.6], p0=0.7)
INVERSE = ACTUATOR.inverse()
RNG = np.random.default_rng(5)
Q, L = [0.5, 0.2, 0.05], [0.1, -0.2, 0.5, 0.3]


def block(**changed: object) -> RepetitiveController:
    given = {"period": 12, "smooth": Q, "learn": L, "lead": 2, "dt": DT} | changed
    return RepetitiveController(**given)


def test_is_its_equations_around_a_plant() -> None:
    designed = RepetitiveController.design(STAGE, N, dt=DT, bandwidth=900.0, delay=DT)
    b, a = difference_equation(STAGE, 1)
    r = wanted(6)
    simulated = simulate_closed_loop(r, DT, plant=STAGE, controller=designed, delay=DT)
    # The plant is stepped as a state space there and as a difference equation here.
    np.testing.assert_allclose(simulated.e, loop(designed, b, a, r), atol=1e-9)


def test_the_inverse_comes_after_the_memory() -> None:
    y_ref, y = RNG.normal(size=300), RNG.normal(size=300)
    whole = block(inverse=INVERSE)
    v = block().run(y_ref, y)[0]
    u, _ = whole.run(y_ref, y)
    assert u.tobytes() == INVERSE(v).tobytes()
    assert whole.applied(y_ref, y).tobytes() == v.tobytes()


LIMITED = {"inverse": INVERSE, "limits": (-1.5, 1.2), "rate": 900.0, "u0": 0.25}


@pytest.mark.parametrize("more", [{}, {"inverse": INVERSE, "tolerance": 10.0}, LIMITED])
def test_halves_and_steps_are_the_whole(more: dict) -> None:
    made = block(**more)
    y_ref, y = RNG.normal(size=200), RNG.normal(size=200)
    u, state = made.run(y_ref, y)
    first, between = made.run(y_ref[:77], y[:77])
    second, after = made.run(y_ref[77:], y[77:], between)
    step = made.stepper()
    stepped = [step(*each) for each in zip(y_ref.tolist(), y.tolist(), strict=True)]
    assert np.concatenate([first, second]).tobytes() == u.tobytes() == np.array(stepped).tobytes()
    assert after.tobytes() == state.tobytes() == np.asarray(step.state).tobytes()
    assert not step.fault


def test_units_change_no_digit() -> None:
    y_ref, y = RNG.normal(size=200), RNG.normal(size=200)
    inner = PrandtlIshlinskii(INVERSE.p, 8.0 * INVERSE.r, p0=INVERSE.p0)
    more = {"limits": (-12.0, 9.6), "rate": 7200.0, "u0": 2.0, "tolerance": 8.0 * 2.5}
    u, _ = block(**LIMITED, tolerance=2.5).run(y_ref, y)
    scaled, _ = block(inverse=inner, **more).run(8.0 * y_ref, 8.0 * y)
    assert scaled.tobytes() == (8.0 * u).tobytes()


def test_a_lost_sample_holds_the_drive_and_time_goes_on() -> None:
    made = RepetitiveController.design(STAGE, N, dt=DT, bandwidth=900.0, delay=DT)
    learned = simulate_closed_loop(wanted(10), DT, plant=STAGE, controller=made, delay=DT)
    y_ref = wanted(1)
    step, whole = made.stepper(), made.stepper()
    for r, y in zip(learned.r, learned.y, strict=True):
        step(r, y), whole(r, y)
    lost = dict.fromkeys((20, 21, 60))
    u, told = np.empty(2 * N), []
    for k in range(2 * N):
        here = k % N if k < N else k - N
        r, y = y_ref[here], learned.y[-N + here]
        expected = whole(r, y)
        u[k] = step(np.nan if k == 60 else r, np.nan if k in lost and k != 60 else y)
        if k in lost:
            assert u[k] == u[k - 1]
        else:
            # The error it has learned is gone, so that what it did not learn now is nothing.
            assert u[k] == pytest.approx(expected, abs=1e-6)
        told.append(step.fault)
    assert told == [False] * 20 + [True] * (2 * N - 20)
    step.clear_fault()
    assert not step.fault
    assert np.isfinite(np.asarray(step.state)).all()


def test_reset_forgets_the_reference_and_not_the_actuator() -> None:
    made = block(inverse=INVERSE)
    y_ref, y = RNG.normal(size=50), RNG.normal(size=50)
    _, state = made.run(y_ref, y)
    step = made.stepper(state)
    step.reset()
    v = block().run(y_ref, y)[0]
    expected = INVERSE(np.concatenate([v, y_ref[:5]]))[-5:]
    # Nothing is learned in less than a period less what Q sees ahead.
    assert [step(r, 0.0) for r in y_ref[:5].tolist()] == expected.tolist()
    again, _ = made.run(y_ref[:5], np.zeros(5), made.reset(state))
    assert again.tolist() == expected.tolist()


@pytest.mark.parametrize("shift", [1, N // 2, -7])
def test_another_phase_is_told_and_forgotten(shift: int) -> None:
    made = RepetitiveController.design(STAGE, N, dt=DT, bandwidth=900.0, delay=DT, tolerance=1e-9)
    r = np.concatenate([wanted(5), np.roll(wanted(5), shift)])
    y = RNG.normal(size=r.size)
    step = made.stepper()
    pairs = np.column_stack([r, y]).tolist()
    u = np.array([step(*each) for each in pairs[: 5 * N]])
    assert not step.changed
    assert np.abs(u[N:] - r[N : 5 * N]).max() > 0.1
    u = np.array([step(*each) for each in pairs[5 * N :]])
    fresh, _ = made.run(r[5 * N :], y[5 * N :])
    assert step.changed
    assert u.tobytes() == fresh.tobytes()
    step.clear_fault()
    assert not step.changed
    assert not step.fault


def test_what_cannot_be_reached_is_not_learned_and_the_rest_is() -> None:
    r = wanted(30) * np.where(np.arange(30 * N) < 20 * N, 1.0, 0.5)
    made = RepetitiveController.design(
        STAGE, N, dt=DT, bandwidth=900.0, delay=DT, inverse=INVERSE, limits=(-0.7, 0.8)
    )
    found = simulate_closed_loop(r, DT, plant=STAGE, controller=made, delay=DT, hysteresis=ACTUATOR)
    assert found.held
    assert (found.u.min(), found.u.max()) == (-0.7, 0.8)
    e = found.e.reshape(-1, N)
    # Out of reach; what is learned has settled but for samples next to the held ones, which change
    # by some thousandths. No period is worse than the first.
    assert np.abs(e[19]).max() > 0.1
    np.testing.assert_allclose(e[19], e[17], atol=5e-3 * np.abs(e[19]).max())
    assert by_period(found.e)[1:20].max() < by_period(found.e)[0]
    # Half of it is within reach: nothing is left of the limit after as few periods as without.
    assert by_period(found.e)[25] < 1e-4


@pytest.mark.parametrize("amplitude", [0.9, 1.0, 1.2])
def test_a_drive_too_slow_for_the_reference_does_not_lag_more_and_more(amplitude: float) -> None:
    """A sine rises faster than the drive may, by up to a third, for 60 periods."""
    fast, rate = ([1e8], [1.0, 1.2e4, 1e8]), 0.9 * 2.0 * np.pi / (200 * DT)
    made = RepetitiveController.design(fast, 200, dt=DT, bandwidth=1500.0, rate=rate)
    r = np.tile(amplitude * np.sin(2.0 * np.pi * np.arange(200) / 200), 60)
    found = simulate_closed_loop(r, DT, plant=fast, controller=made)
    e = np.sqrt((found.e.reshape(-1, 200) ** 2).mean(axis=1))
    # The second period is the first whole one, and nothing is learned in it yet. Learning cannot
    # undo the lag; it must not add to it, but for what it gains and loses around a held part.
    assert e[2:].max() < max(1.1 * e[1], 1e-3)


def test_holds_within_reach_what_is_next_to_a_limit() -> None:
    """Samples far from the held ones, of filters and plant, are tracked as without limits."""
    angle = 2.0 * np.pi * np.arange(400) / 400
    r = np.tile(np.sin(angle), 25)
    fast = ([1e8], [1.0, 1.2e4, 1e8])
    made = RepetitiveController.design(
        fast, 400, dt=DT, bandwidth=1500.0, delay=0.0, limits=(-2.0, 0.9)
    )
    found = simulate_closed_loop(r, DT, plant=fast, controller=made)
    e = np.abs(found.e.reshape(-1, 400)[-1])
    far = np.abs(np.arange(400) - 100) > 110  # sin is above 0.9 from 71 to 129 of 400
    assert found.u.max() == 0.9
    assert e[~far].max() > 0.09
    assert e[far].max() < 1e-3


def test_files_copies_and_descriptions(tmp_path: Path) -> None:
    made = block(**LIMITED, tolerance=0.125)
    about = ModelDescription(input_unit="V", output_unit="um")
    made.save(tmp_path / "block.json", about)
    found = hyst.load(tmp_path / "block.json")
    assert isinstance(found, RepetitiveController)
    assert found == made
    assert hash(found) == hash(made)
    assert found.description == about
    y_ref, y = RNG.normal(size=50), RNG.normal(size=50)
    for each in (found, pickle.loads(pickle.dumps(found)), copy.deepcopy(found)):
        assert each == made
        assert each.run(y_ref, y)[0].tobytes() == made.run(y_ref, y)[0].tobytes()
    assert block() != made
    assert "period=12" in repr(made)


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"period": 12.5}, "2 periods as one, 25 samples"),
        ({"period": 12.123}, "a dt of which the period is a multiple"),
        ({"period": 1}, "give 2 to 8388608"),
        ({"period": 4}, "need at least 5"),
        ({"period": np.nan}, "period"),
        ({"lead": 4}, "begin learn with zeros"),
        ({"lead": -1}, "lead"),
        ({"lead": 1.5}, "lead"),
        ({"smooth": []}, "an entry each"),
        ({"learn": [np.inf]}, "learn"),
        ({"dt": 0.0}, "dt"),
        ({"tolerance": -1.0}, "tolerance"),
        ({"wait": -1}, "wait"),
        ({"wait": 0.5}, "wait"),
        ({"inverse": 3.0}, "give an operator or None"),
        ({"inverse": LinearDynamics([[0.5]], [1.0], [1.0], 0.0, 2 * DT)}, "dt"),
        ({"limits": (1.0, -1.0)}, "give the lowest drive first"),
        ({"hysteresis": ACTUATOR}, "belong to limits"),
        ({"inverse": INVERSE.with_description(
            ModelDescription(verdict=Verdict("unfit", ("it is another curve",))))}, "unfit"),
    ],
)  # fmt: skip
def test_what_is_refused(changed: dict, said: str) -> None:
    with pytest.raises(InputError, match=said):
        block(**changed)


def test_records_and_states_that_are_refused() -> None:
    made = block(inverse=INVERSE)
    for y_ref, y in (([1.0], [1.0, 2.0]), ([np.nan], [0.0]), ([[1.0]], [[1.0]])):
        with pytest.raises(InputError):
            made.run(y_ref, y)
    with pytest.raises(InputError):
        made.run([1.0], [1.0], np.zeros(3))
    with pytest.raises(InputError):
        made.stepper(np.full(made.initial_state().size, np.nan))
    with pytest.raises(InputError, match="overflows at sample"):
        block(inverse=Affine(1e200)).run(np.full(60, 1e150), np.zeros(60))
    with pytest.raises(InputError, match="kind"):
        RepetitiveController.from_dict({"kind": "tracking-controller"})
    with pytest.raises(InputError, match="its own"):
        simulate_closed_loop(wanted(2), DT, plant=STAGE, controller=made, inverse=INVERSE)
    with pytest.raises(InputError, match="TrackingController"):
        simulate_closed_loop(wanted(2), DT, plant=STAGE, controller=made, start="settled")
