"""What can be relied on of an estimate of any family: inverse, memory, files, units, bad input."""

from __future__ import annotations

import math
import pickle
from pathlib import Path

import numpy as np
import pytest

import hyst
from hyst.online import ModelEstimator
from hyst.operators import Operator
from online.families import DT, FAMILIES, learn, start_off, two_sines
from online.plants import random_signals


def invert(model: Operator) -> Operator:
    """Give an inverse by what the families themselves offer, or raise."""
    if isinstance(model, hyst.RateDependentPrandtlIshlinskii):
        return model.explicit_inverse()
    return model.inverse()


def estimator_of(family: str, seed: int = 0, **options: float) -> tuple[ModelEstimator, Operator]:
    rng = np.random.default_rng([10, seed])
    truth = FAMILIES[family](rng)
    return ModelEstimator(start_off(truth, rng), dt=DT, **options), truth


def noisy(truth: Operator, u: np.ndarray, seed: int = 0) -> np.ndarray:
    y = truth(u)
    return y + 0.01 * float(np.std(y)) * np.random.default_rng(seed).standard_normal(u.size)


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("seed", [0, 1])
def test_random_steps_never_leave_what_can_be_inverted(family: str, seed: int) -> None:
    u, y = random_signals(np.random.default_rng([11, seed]), 9000)
    estimator, _ = estimator_of(family, seed, memory=0.3, window=0.32, block=80)
    changes = 0
    for k, (u_k, y_k) in enumerate(zip(u.tolist(), y.tolist(), strict=True)):
        before = estimator.parameters
        estimator.update(u_k, y_k)
        if (estimator.parameters != before).any():
            changes += 1
            model = estimator.model
            assert np.isfinite(estimator.parameters).all()
            back = invert(model)
            if not isinstance(model, hyst.RateDependentPrandtlIshlinskii) and changes % 10 == 0:
                reference = np.sin(np.arange(50.0))
                # To rounding times what slopes of a millionth to a thousand times their sum, of
                # maps and plays one after the other, amplify.
                assert np.abs(back(model(reference)) - reference).max() < 1e-3, k
    assert changes >= 10
    counts = estimator.counts
    # Blocks 5 and 6 of nine hold numbers beyond all measure, and NaN and infinities.
    assert counts["refused"] > 0
    assert counts["skipped"] > 0
    assert np.isfinite(estimator.saved()[1]).all()


@pytest.mark.parametrize("family", ["pi", "rdpi", "mpi", "gpi", "creep"])
def test_other_units_give_the_same_bits(family: str) -> None:
    estimator, truth = estimator_of(family)
    u = two_sines(2600)
    y = noisy(truth, u)
    scaled = ModelEstimator(estimator.model.in_units(2.0**7, 2.0**-5), dt=DT)
    learn(estimator, u, y)
    learn(scaled, u * 2.0**7, y * 2.0**-5)
    expected = estimator.model.in_units(2.0**7, 2.0**-5).parameters().values
    assert scaled.parameters.tolist() == expected.tolist()
    assert scaled.noise == estimator.noise * 2.0**-5


@pytest.mark.parametrize("family", FAMILIES)
def test_a_saved_estimate_goes_on_with_the_same_bits(family: str, tmp_path: Path) -> None:
    live, truth = estimator_of(family)
    u = two_sines(3600)
    y = noisy(truth, u)
    learn(live, u[:2333], y[:2333])
    live.save(tmp_path / "estimator.json")
    loaded = hyst.load(tmp_path / "estimator.json")
    copied = pickle.loads(pickle.dumps(live))
    for each in (live, loaded, copied):
        learn(each, u[2333:], y[2333:])
    assert loaded.saved()[1].tolist() == live.saved()[1].tolist()
    assert copied.saved()[1].tolist() == live.saved()[1].tolist()
    assert loaded.knowledge.low.tolist() == live.knowledge.low.tolist()


def test_halves_of_a_record_are_the_whole() -> None:
    whole, truth = estimator_of("mpi")
    halves, _ = estimator_of("mpi")
    u = two_sines(3000)
    record = hyst.Record(u, noisy(truth, u), DT)
    trajectory = whole.run(record, every=100)
    for part in (slice(0, 1111), slice(1111, None)):
        halves.run(hyst.Record(record.u[part], record.y[part], DT))
    assert halves.saved()[1].tolist() == whole.saved()[1].tolist()
    assert trajectory.values.shape == (30, len(whole.names))
    assert trajectory.values[-1].tolist() == whole.parameters.tolist()
    assert trajectory.error.size == 3000


@pytest.mark.parametrize("family", ["pi", "ramberg-osgood", "mpi", "gpi", "creep"])
def test_a_command_is_the_exact_inverse_from_the_memory_there_is(family: str) -> None:
    estimator, truth = estimator_of(family)
    u = two_sines(2700)
    learn(estimator, u, noisy(truth, u))
    begun = estimator.memory
    for wanted in (0.0, 1.0, -2.0, 3.7):
        command = estimator.command(wanted)
        y, _ = estimator.model.run(np.array([command]), begun)
        # To rounding: the output's slope times that of the input.
        assert y[0] == pytest.approx(wanted, abs=1e-12)
    assert estimator.memory.tolist() == begun.tolist()
    assert estimator.inverse_error == 0.0
    assert math.isnan(estimator.command(math.nan))


def test_a_rate_dependent_command_steps_the_explicit_inverse_and_says_how_inexact() -> None:
    _, truth = estimator_of("rdpi")
    assert isinstance(truth, hyst.RateDependentPrandtlIshlinskii)
    u = two_sines(4500)
    y_ref = truth(u)
    estimator = ModelEstimator(truth, held=list(truth.parameters().names))
    for k in range(4000):
        estimator.update(u[k], y_ref[k])
    told, commands, missed = estimator.inverse_error, [], []
    step = truth.stepper(truth.run(u[:4000])[1])
    for wanted in y_ref[4000:].tolist():
        commands.append(estimator.command(wanted))
        y = step(commands[-1])
        missed.append(y - wanted)
        estimator.update(commands[-1], y)
    # The explicit inverse alone, which exports have, along the whole reference.
    alone = truth(truth.explicit_inverse()(y_ref)) - y_ref
    usual = math.sqrt(np.mean(np.square(alone[2000:])))
    # Another stretch of the same motion, another beginning of the memory: the same to half.
    assert told == pytest.approx(usual, rel=0.5)
    assert math.sqrt(np.mean(np.square(missed))) == pytest.approx(usual, rel=0.5)
    # It does not chatter: once the stretch has begun, steps change as those of the reference do.
    rough = np.abs(np.diff(commands[50:], 2)).max()
    assert rough < 3.0 * np.abs(np.diff(truth.explicit_inverse()(y_ref)[2000:], 2)).max()


def test_commands_are_smooth_at_rest_where_the_explicit_inverse_is_exact() -> None:
    estimator, truth = estimator_of("rdpi")
    u = two_sines(4000)
    learn(estimator, u, noisy(truth, u))
    estimator.follow(np.full(20, u[-1]))
    here = float(estimator.model.run(u[-1:], estimator.memory)[0][0])
    assert estimator.command(here) == pytest.approx(u[-1], abs=1e-9)


def test_following_keeps_the_memory_of_the_input() -> None:
    estimator, truth = estimator_of("creep")
    u = two_sines(3000)
    learn(estimator, u[:2500], noisy(truth, u)[:2500])
    theta = estimator.parameters
    estimator.follow(u[2500:2600])
    state = estimator.memory
    model = estimator.model
    # The whole past by the present constants, from the memory the start had.
    assert estimator.parameters.tolist() == theta.tolist()
    # Derivatives carry it to second order: the constants have moved since samples left the window.
    assert state == pytest.approx(model.run(u[:2600])[1], abs=1e-2)
    estimator, truth = estimator_of("mpi")
    learn(estimator, u[:2500], noisy(truth, u)[:2500])
    estimator.follow(u[2500:2600])
    # Turning points tell it to rounding.
    assert estimator.memory == pytest.approx(estimator.model.run(u[:2600])[1], abs=1e-12)


def test_a_frozen_copy_predicts_and_learns_nothing() -> None:
    estimator, truth = estimator_of("gpi")
    u = two_sines(3000)
    y = noisy(truth, u)
    learn(estimator, u[:2200], y[:2200])
    frozen = estimator.frozen()
    assert frozen.parameters.tolist() == estimator.parameters.tolist()
    assert frozen.memory == pytest.approx(estimator.memory, abs=1e-12)
    assert frozen.command(1.0) == pytest.approx(estimator.command(1.0), abs=1e-9)
    learn(frozen, u[2200:], y[2200:])
    assert frozen.parameters.tolist() == estimator.parameters.tolist()
    frozen.restart(truth)
    assert frozen.parameters.tolist() == truth.parameters().values.tolist()


def test_a_restart_forgets_all_but_the_memory() -> None:
    estimator, truth = estimator_of("ramberg-osgood")
    first = estimator.parameters
    u = two_sines(3000)
    learn(estimator, u, noisy(truth, u))
    estimator.restart()
    assert estimator.parameters.tolist() == first.tolist()
    assert not estimator.knowledge.known
    # The input turned within the last loops: what it left, by the constants of the start.
    expected = estimator.model.run(u)[0][-1]
    here = estimator.model.run(u[-1:], estimator.memory)[0][0]
    assert here == pytest.approx(expected, rel=0.1)
    with pytest.raises(hyst.errors.InputError, match="other constants"):
        estimator.restart(hyst.PrandtlIshlinskii([0.5], [1.0], 1.0))


def test_where_outputs_are_lost_the_memory_follows_the_input() -> None:
    estimator, truth = estimator_of("creep")
    u = two_sines(4000)
    y = noisy(truth, u)
    y[np.random.default_rng(1).random(y.size) < 0.2] = math.nan
    for u_k, y_k in zip(u.tolist(), y.tolist(), strict=True):
        if not estimator.update(u_k, y_k):
            estimator.follow([u_k])
    counts = estimator.counts
    assert counts["skipped"] == int(np.isnan(y).sum())
    assert counts["used"] == y.size - counts["skipped"]
    assert estimator.parameters[:5] == pytest.approx(truth.parameters().values[:5], rel=0.05)


def test_what_cannot_be_estimated_is_refused() -> None:
    plays = hyst.PrandtlIshlinskii([0.5], [1.0], 1.0)
    with pytest.raises(hyst.errors.NotInvertibleError, match="p0 is 0"):
        ModelEstimator(hyst.PrandtlIshlinskii([0.5], [1.0], 0.0))
    with pytest.raises(hyst.errors.InputError, match="give an operator"):
        ModelEstimator("plays")  # type: ignore[arg-type]
    with pytest.raises(hyst.errors.InputError, match="held names 'q'"):
        ModelEstimator(plays, held=["q"])
    with pytest.raises(hyst.errors.InputError, match="spread"):
        ModelEstimator(plays, spread=-1.0)
    with pytest.raises(hyst.errors.InputError, match="dt"):
        ModelEstimator(hyst.Creep([0.1], [1.0], 0.1) @ plays, dt=0.2)
    settings, state = ModelEstimator(plays).saved()
    with pytest.raises(hyst.errors.InputError, match="entries"):
        ModelEstimator.restore(settings, state[:-1])
    broken = state.copy()
    broken[16] = -1.0  # p0, behind 16 scalars
    with pytest.raises(hyst.errors.InputError, match="cannot be inverted"):
        ModelEstimator.restore(settings, broken)
