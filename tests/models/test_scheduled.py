"""Models whose constants follow a second signal, against plain Python and hand calculations."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path

import numpy as np
import pytest

import hyst
from hyst import _engine
from hyst.errors import InputError, NotInvertibleError
from hyst.operators.stage import Stage
from reference import moving_plays

KNOTS = (20.0, 35.0, 50.0)
ROUNDING = 1e-14
"""A dozen operations on numbers of the order of 1, and as many solved for on the way back."""


def at(t: float, **kinds: float) -> hyst.Operator:
    of = moving_plays.actuator(t, **kinds)
    plays = hyst.PrandtlIshlinskii(of.p, of.r, p0=of.p0)
    output_map = hyst.DeadZone([1.0, of.w], [0.0, of.rho])
    return hyst.Affine(of.gain, of.offset) @ output_map @ plays


def scheduled(**kinds: float) -> hyst.Scheduled:
    return hyst.Scheduled([at(t, **kinds) for t in KNOTS], KNOTS, "temperature", "degC")


def drive(samples: int = 4000, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """An input with loops in loops, and a temperature that drifts over all of the schedule."""
    rng = np.random.default_rng(seed)
    k = np.arange(samples)
    u = np.sin(0.013 * k) * (0.6 + 0.4 * np.sin(0.0017 * k + seed)) + 0.01 * rng.normal(
        size=samples
    )
    return u, 35.0 + 14.0 * np.sin(0.0011 * k + seed)


@pytest.mark.parametrize(
    "kinds", [{}, {"moving_radii": 0.4}, {"moving_radii": -0.3, "map_weight": -0.4}]
)
def test_a_drifting_signal_gives_what_the_equations_give(kinds: dict[str, float]):
    u, t = drive()
    run = scheduled(**kinds).run(u, t)
    np.testing.assert_allclose(run.y, moving_plays.output(u, t, **kinds), rtol=0, atol=ROUNDING)
    assert run.held == 0


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(
    "kinds", [{}, {"moving_radii": 0.4}, {"moving_radii": -0.3, "map_weight": -0.4}]
)
def test_the_inverse_follows_a_drifting_signal_from_the_first_sample(
    kinds: dict[str, float], seed: int
):
    model = scheduled(**kinds)
    u, t = drive(seed=seed)
    inverse = model.inverse()
    forward, back = model.run(u, t), inverse.run(model.run(u, t).y, t)
    np.testing.assert_allclose(back.y, u, rtol=0, atol=ROUNDING)
    # Its memory is that of the model: plays, the only stage that has one.
    np.testing.assert_allclose(back.state, forward.state, rtol=0, atol=ROUNDING)
    # A command made by it lets plain equations follow a reference of another shape.
    wanted = 0.8 * np.cumsum(np.sin(0.02 * np.arange(u.size))) / 50.0
    command = inverse.run(wanted, t).y
    reached = moving_plays.output(command, t, **kinds)
    np.testing.assert_allclose(reached, wanted, rtol=0, atol=ROUNDING * np.abs(command).max())


def test_at_a_value_the_model_is_an_ordinary_one_with_the_same_bits():
    model, (u, _) = scheduled(moving_radii=0.4, map_weight=-0.4), drive()
    for value in (20.0, 27.3, 35.0, 41.0, 50.0):
        frozen = model.at(value)
        assert isinstance(frozen, hyst.Operator)
        assert model.run(u, value).y.tolist() == frozen(u).tolist()
        np.testing.assert_allclose(frozen.inverse()(frozen(u)), u, rtol=0, atol=ROUNDING)
    assert model.at(35.0) == at(35.0, moving_radii=0.4, map_weight=-0.4)
    # Half way from 20 to 35, by hand: p0 from 1 to 1.05.
    assert scheduled().at(27.5).parameters().values[0] == pytest.approx(1.025, abs=1e-15)


def test_outside_the_schedule_constants_are_held_and_it_is_told():
    model, (u, t) = scheduled(moving_radii=0.4), drive()
    beyond = 35.0 + 40.0 * (t - 35.0) / 14.0
    count = int(((beyond < 20.0) | (beyond > 50.0)).sum())
    run = model.run(u, beyond)
    assert run.held == count > 100
    assert run.y.tolist() == model.run(u, np.clip(beyond, 20.0, 50.0)).y.tolist()
    assert model.outside(beyond).sum() == count
    with pytest.warns(UserWarning, match=f"{count} of {u.size} samples temperature is outside"):
        model(u, beyond)
    step = model.stepper()
    assert not step.outside
    step(0.1, 20.0)
    assert not step.outside
    step(0.2, 19.0)
    step(0.3, 25.0)
    assert step.outside
    assert not step.fault
    step.clear_fault()
    assert not step.outside
    assert model.at(90.0) == model.at(50.0)


def test_samples_and_halves_give_the_bits_of_the_whole():
    for model in (
        scheduled(moving_radii=0.4, map_weight=-0.4),
        scheduled(moving_radii=0.4).inverse(),
    ):
        u, t = drive()
        whole = model.run(u, t)
        first = model.run(u[:1500], t[:1500])
        second = model.run(u[1500:], t[1500:], first.state)
        assert whole.y.tolist() == first.y.tolist() + second.y.tolist()
        assert whole.state.tolist() == second.state.tolist()
        step = model.stepper()
        assert [step(*pair) for pair in zip(u, t, strict=True)] == whole.y.tolist()
        assert step.state.tolist() == whole.state.tolist()


def test_steppers_and_records_do_not_share_constants():
    model, (u, t) = scheduled(moving_radii=0.4), drive(samples=300)
    expected = model.run(u, t).y.tolist()
    step, other, got = model.stepper(), model.stepper(), []
    for k in range(u.size):
        got.append(step(u[k], t[k]))
        other(u[k], 50.0)
        model.run(u[:2], 20.0)
    assert got == expected


def test_plays_keep_their_output_while_their_band_moves():
    """By hand: while the input rests, the output follows the constants."""
    cold = hyst.PrandtlIshlinskii([0.5], [0.1], p0=1.0)
    warm = hyst.PrandtlIshlinskii([1.0], [0.3], p0=1.0)
    model = hyst.Scheduled([cold, warm], [0.0, 1.0])
    run = model.run([1.0, 1.0, 0.5], [0.0, 0.5, 0.5])
    # r = 0.2 lets z stay at 0.9, within 0.8 to 1.2; p = 0.75. Then z <= 0.5 + 0.2.
    np.testing.assert_allclose(run.y, [1.45, 1.675, 0.5 + 0.75 * 0.7], rtol=0, atol=1e-15)


def test_what_is_not_finite_is_refused_or_answered_and_never_kept():
    model, (u, t) = scheduled(), drive(samples=100)
    bad = t.copy()
    bad[7] = np.nan
    with pytest.raises(InputError, match=r"temperature.*7"):
        model.run(u, bad)
    with pytest.raises(InputError, match="u is inf at index 3"):
        model.run([0.0, 1.0, 2.0, np.inf], 20.0)
    step = model.stepper()
    before = step(0.5, 25.0), step.state.copy()
    assert (step(np.nan, 25.0), step.fault) == (before[0], True)
    assert step(0.7, np.nan) == step(0.7, np.inf) == before[0]
    assert step.state.tolist() == before[1].tolist()
    assert not step.outside
    with pytest.raises(InputError, match="one value for each sample"):
        model.run(u, t[:-1])
    with pytest.raises(InputError, match="overflows"):
        hyst.Scheduled([hyst.Affine(2.0), hyst.Affine(4.0)], [0.0, 1.0]).run([1e308], 0.9)


def test_a_schedule_that_is_none_is_refused():
    one, other = at(20.0), at(35.0)
    with pytest.raises(InputError, match="at least two values"):
        hyst.Scheduled([one], [20.0])
    with pytest.raises(InputError, match="ascend"):
        hyst.Scheduled([one, other], [35.0, 20.0])
    with pytest.raises(InputError, match="ascend"):
        hyst.Scheduled([one, other], [20.0, 20.0])
    with pytest.raises(InputError, match="values"):
        hyst.Scheduled([one, other], [20.0, np.nan])
    with pytest.raises(InputError, match="2 models but 3 values"):
        hyst.Scheduled([one, other], [20.0, 30.0, 40.0])
    with pytest.raises(InputError, match="give an operator"):
        hyst.Scheduled([one, 3.0], [20.0, 30.0])
    with pytest.raises(InputError, match="its stages"):
        hyst.Scheduled([hyst.Play(0.1), hyst.Stop(0.1)], [20.0, 30.0])
    plays = hyst.PrandtlIshlinskii([0.5], [0.1], p0=1.0)
    more = hyst.PrandtlIshlinskii([0.5, 0.1], [0.1, 0.2], p0=1.0)
    with pytest.raises(InputError, match="its size"):
        hyst.Scheduled([plays, more], [20.0, 30.0])
    with pytest.raises(InputError, match="initial memory"):
        hyst.Scheduled([plays, hyst.PrandtlIshlinskii([0.5], [0.1], 1.0, [0.05])], [20.0, 30.0])
    with pytest.raises(InputError, match="sample time"):
        hyst.Scheduled([hyst.Creep([0.1], [1.0], dt=t) for t in (1e-3, 2e-3)], [20.0, 30.0])
    volts = plays.with_description(hyst.ModelDescription(input_unit="V"))
    millivolts = plays.with_description(hyst.ModelDescription(input_unit="mV"))
    with pytest.raises(InputError, match="unit of its input"):
        hyst.Scheduled([volts, millivolts], [20.0, 30.0])


def test_memories_that_mean_nothing_with_other_constants_do_not_run():
    soft, stiff = hyst.Dahl(5.0, 1.0, 1.0), hyst.Dahl(6.0, 1.2, 1.0)
    model = hyst.Scheduled([soft, stiff], [0.0, 1.0])
    assert model.at(0.5) == hyst.Dahl(5.5, 1.1, 1.0)
    with pytest.raises(InputError, match=r"'dahl'.*its memory does not tell"):
        model.run([0.0, 1.0], 0.5)
    # The same stage with constants that stay is no obstacle, nor is a gain behind it that moves.
    steady = hyst.Scheduled([hyst.Affine(g) @ soft for g in (1.0, 2.0)], [0.0, 1.0])
    u = np.sin(np.arange(50.0))
    np.testing.assert_allclose(steady.run(u, 0.5).y, 1.5 * soft(u), rtol=0, atol=1e-15)
    np.testing.assert_allclose(
        steady.inverse().run(steady.run(u, 0.5).y, 0.5).y, u, rtol=0, atol=1e-12
    )  # Dahl's own inverse is solved for to 1e-13
    times = hyst.Scheduled([hyst.Creep([0.1], [t], dt=1e-2) for t in (1.0, 2.0)], [0.0, 1.0])
    with pytest.raises(InputError, match="no straight lines"):
        times.run(u, 0.5)


def test_creep_whose_weights_move_is_inverted_with_its_memory():
    kept = hyst.PrandtlIshlinskii([0.5], [0.2], p0=1.0)
    models = [hyst.Creep([w, 2.0 * w], [0.05, 1.0], dt=1e-2) @ kept for w in (0.02, 0.05)]
    model = hyst.Scheduled(models, [20.0, 40.0])
    u, t = drive()
    y = model.run(u, t).y
    np.testing.assert_allclose(model.inverse().run(y, t).y, u, rtol=0, atol=ROUNDING)
    # Each lag moves by 1 - exp(-dt / tau) of its way, after it was heard.
    x, z, gain = np.zeros(2), 0.0, 1.0 - np.exp(-1e-2 / np.array([0.05, 1.0]))
    for k in range(500):
        z = min(max(z, u[k] - 0.2), u[k] + 0.2)
        w = 0.02 + 0.03 * (np.clip(t[k], 20.0, 40.0) - 20.0) / 20.0
        v = u[k] + 0.5 * z
        assert y[k] == pytest.approx(v + np.array([w, 2.0 * w]) @ x, abs=1e-13)
        x += gain * (v - x)


def test_a_lag_before_and_creep_behind_do_not_hinder_what_moves_between():
    def stage(x: float) -> hyst.Operator:
        plays = hyst.PrandtlIshlinskii([0.4 + 0.1 * x, 0.3], [0.1 + 0.1 * x, 0.4], p0=1.0)
        creep = hyst.Creep([0.02, 0.01], [0.05, 1.0], dt=1e-2)
        return hyst.Affine(1.0 + 0.2 * x, 0.1) @ creep @ plays @ hyst.Lag(4e-3, 1e-2)

    model = hyst.Scheduled([stage(x) for x in (0.0, 0.5, 1.0)], KNOTS)
    u, t = drive()
    y = model.run(u, t).y
    # The lag's inverse is an ordinary one: its feed-through of 0.64 enlarges rounding by half.
    np.testing.assert_allclose(model.inverse().run(y, t).y, u, rtol=0, atol=2 * ROUNDING)
    assert model.run(u, 27.0).y.tolist() == model.at(27.0)(u).tolist()
    lags = hyst.Scheduled([hyst.Lag(time, 1e-2) for time in (4e-3, 5e-3)], [0.0, 1.0])
    with pytest.raises(InputError, match="'lag' differ"):
        lags.run(u, 0.5)


def test_inverses_that_would_not_exist_somewhere_are_refused_by_name():
    def pair(*models: hyst.Operator) -> hyst.Scheduled:
        return hyst.Scheduled(models, [20.0, 40.0], "temperature")

    plays = hyst.PrandtlIshlinskii
    with pytest.raises(NotInvertibleError, match="at temperature = 40: p0 is 0"):
        pair(plays([0.5], [0.2], 1.0), plays([0.5], [0.2], 0.0)).inverse()
    with pytest.raises(NotInvertibleError, match="passes 0 in between"):
        pair(hyst.Affine(1.0), hyst.Affine(-1.0)).inverse()
    falling = plays([-0.8, 0.5, -0.5], [0.1, 0.2, 0.3], 1.0)
    still = pair(falling, plays([-0.7, 0.5, -0.5], [0.1, 0.2, 0.3], 1.0))
    u, t = drive()
    back = still.inverse().run(still.run(u, t).y, t).y
    # Slopes go down to 0.2, so rounding grows by five.
    np.testing.assert_allclose(back, u, rtol=0, atol=10 * ROUNDING)
    with pytest.raises(NotInvertibleError, match=r"radii move with temperature.*-0\.3"):
        pair(falling, plays([-0.8, 0.5, -0.5], [0.1, 0.2, 0.4], 1.0)).inverse()
    with pytest.raises(NotInvertibleError, match="change their order"):
        pair(
            hyst.DeadZone([1.0, -0.6, 0.5], [0.0, 0.5, 0.4]),
            hyst.DeadZone([1.0, -0.6, 0.5], [0.0, 0.4, 0.5]),
        ).inverse()
    with pytest.raises(NotInvertibleError, match="play"):
        pair(hyst.Play(0.1), hyst.Play(0.2)).inverse()
    rated = [
        hyst.RateDependentPrandtlIshlinskii([0.5], [0.1], beta=b, dt=1e-3, p0=1.0)
        for b in (1e-3, 2e-3)
    ]
    with pytest.raises(NotInvertibleError):
        pair(*rated).inverse()
    assert np.isfinite(pair(*rated).run(u, t).y).all()


def test_units_of_powers_of_two_scale_every_bit():
    model, (u, t) = scheduled(moving_radii=0.4, map_weight=-0.4), drive()
    scaled = model.in_units(2.0**9, 2.0**-7)
    assert (scaled.run(u * 2.0**9, t).y * 2.0**7).tolist() == model.run(u, t).y.tolist()
    y = model.run(u, t).y
    back = scaled.inverse().run(y * 2.0**-7, t).y * 2.0**-9
    assert back.tolist() == model.inverse().run(y, t).y.tolist()
    # The second signal has a scale of its own.
    slower = hyst.Scheduled(model.models, model.values * 4.0)
    assert slower.run(u, 4.0 * t).y.tolist() == model.run(u, t).y.tolist()


def test_samples_in_between_change_no_bit_of_what_both_have():
    """Rate-independent in both signals together, where these are kept: a path is a path."""
    model, (u, t) = scheduled(moving_radii=0.4), drive(samples=500)
    twice = model.run(np.repeat(u, 2), np.repeat(t, 2)).y[1::2]
    assert twice.tolist() == model.run(u, t).y.tolist()


def test_files_and_pickles_give_the_model_back(tmp_path: Path):
    model = scheduled(moving_radii=0.4).with_description(
        hyst.ModelDescription(input_unit="V", output_unit="um")
    )
    model.save(tmp_path / "model.json")
    for found in (hyst.load(tmp_path / "model.json"), pickle.loads(pickle.dumps(model))):
        assert found == model
        assert hash(found) == hash(model)
        assert (found.name, found.unit) == ("temperature", "degC")
        assert found.description.input_unit == "V"
        assert found.at(30.0).description.output_unit == "um"
        assert found.inverse().description.input_unit == "um"
    with pytest.raises(InputError, match="unknown entry"):
        hyst.Scheduled.from_dict(model.to_dict() | {"knots": 3})


def test_an_inverse_that_has_run_can_be_copied_and_pickled():
    inverse = scheduled(moving_radii=0.4).inverse()
    inverse = inverse.with_description(hyst.ModelDescription(input_unit="um"))
    y = inverse.run([0.0, 1.0, 0.5], 30.0).y
    for found in (copy.deepcopy(inverse), pickle.loads(pickle.dumps(inverse))):
        assert found == inverse
        assert hash(found) == hash(inverse)
        assert found.description.input_unit == "um"
        assert found.run([0.0, 1.0, 0.5], 30.0).y.tolist() == y.tolist()


def test_a_model_that_is_unfit_anywhere_is_unfit():
    def judged(level: str, gain: float) -> hyst.Operator:
        verdict = hyst.operators.Verdict(level, ("Said.",))
        return hyst.Affine(gain).with_description(hyst.ModelDescription(verdict=verdict))

    model = hyst.Scheduled([judged("good", 1.0), judged("unfit", 2.0)], [0.0, 1.0])
    assert model.description.is_unfit
    assert model.at(0.5).description.is_unfit


@pytest.mark.parametrize("kind", ["pi_solved", "dead_zone_solved", "affine_solved"])
def test_the_kernel_differentiates_what_it_solves(kind: str):
    """Against central differences of steps of 1e-6, which are right to 1e-9 between kinks."""
    constants = {
        "pi_solved": (1.0, 0.5, 0.3, 0.2, 0.6),
        "dead_zone_solved": (1.0, -0.4, 0.3, 0.0, 0.5, -0.25),
        "affine_solved": (2.0, 0.5),
    }[kind]
    y = 2.0 * np.sin(0.1 * np.arange(100.0)) * np.linspace(1.0, 0.4, 100)
    memory = np.zeros(_engine.Chain([Stage(kind, constants)]).state_length)

    def run(theta: np.ndarray) -> np.ndarray:
        u = np.empty((1, y.size))
        chain = _engine.Chain([Stage(kind, tuple(theta))])
        assert chain.run(memory[None, :].copy(), y[None, :], u, "loop") == -1
        return u[0]

    rows = np.empty((y.size, len(constants)))
    _engine.Chain([Stage(kind, constants)]).jacobian(memory.copy(), y, rows)
    # The threshold of the linear part stays 0: a map jumps there.
    moved = [i for i in range(len(constants)) if kind != "dead_zone_solved" or i != 3]
    steps = 1e-6 * np.eye(len(constants))[moved]
    differences = [(run(constants + step) - run(constants - step)) / 2e-6 for step in steps]
    np.testing.assert_allclose(rows[:, moved], np.array(differences).T, rtol=0, atol=1e-7)
