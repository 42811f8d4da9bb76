"""Creep found beside hysteresis: its constants, what is none of it, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import hyst
from hyst.errors import InputError, NotIdentifiableError
from identification.creeping_records import DT, PLAYS, crept, drive, record

Array = NDArray[np.float64]

WEIGHTS, TAU = (0.05, 0.04), (0.9, 14.0)
U = drive()
Y = crept(U, WEIGHTS, TAU)
T = np.arange(U.size) * DT
STROKE = float(np.ptp(Y))


def _identify(given: hyst.Record | list[hyst.Record], **options: object) -> hyst.Identified:
    return hyst.identify(given, **({"family": "pi", "plays": 2} | options))  # type: ignore[arg-type]


def _creep_of(found: hyst.Identified) -> tuple[Array, Array]:
    """Give weights and time constants with their errors, shape (2, n) each."""
    rows = np.array([found.parameter_values, found.standard_errors])
    at = [name.startswith("creep.weights") for name in found.parameter_names]
    times = [name.startswith("creep.time") for name in found.parameter_names]
    return rows[:, at], rows[:, times]


def _kinds(found: hyst.Identified) -> list[str]:
    model = found.model
    parts = model.parts if isinstance(model, hyst.operators.Composition) else (model,)
    return [each.kind for each in parts]


def test_weights_and_time_constants_come_back_within_their_errors() -> None:
    values, errors = [], []
    for seed in range(8):
        found = _identify(record(Y, U, seed), creep=2)
        weights, times = _creep_of(found)
        values.append(np.concatenate([weights[0], times[0]]))
        errors.append(np.concatenate([weights[1], times[1]]))
    told = np.median(errors, axis=0)
    # The lags of hyst answer a sample later, those of the plant at once: half a sample of tau.
    bias = np.array([0.0, 0.0, 0.5 * DT, 0.5 * DT])
    off = np.abs(np.mean(values, axis=0) - np.array([*WEIGHTS, *TAU]))
    assert np.all(off < 3.0 * told / np.sqrt(8.0) + bias)
    # The standard deviation of 8 values is known to a quarter: twice that on either side.
    ratio = np.std(values, axis=0, ddof=1) / told
    assert np.all((ratio > 0.5) & (ratio < 1.7))


def test_as_many_lags_as_there_are_are_found_unasked() -> None:
    found = _identify(record(Y, U, 1))
    assert _kinds(found) == ["prandtl-ishlinskii", "creep", "affine"]
    (weights, errors), (times, _) = _creep_of(found)
    assert times == pytest.approx(TAU, rel=0.2)
    assert np.all(np.abs(weights - WEIGHTS) < 4.0 * errors)
    assert found.verdict.level == "good"
    parts = {each.name: each for each in found.motion}
    assert parts["creep"].in_model
    # What lags add, taken by hand from the plant, over the samples used.
    used = slice(found.used[0].start, found.used[0].stop)
    by_hand = np.std((Y - crept(U))[used])
    assert parts["creep"].rms == pytest.approx(by_hand, rel=0.1)
    assert parts["noise"].percent == pytest.approx(0.2, rel=0.1)
    again = found.model.inverse()
    assert found.model(again(Y)) == pytest.approx(Y, abs=1e-12 * STROKE)


NO_CREEP = {
    "nothing": np.zeros(U.size),
    "drift": 0.03 * STROKE * T / T[-1],
    "warming up": 0.04 * STROKE * (1.0 - np.exp(-T / 30.0)),
    "warming up, fast": 0.04 * STROKE * (1.0 - np.exp(-T / 4.0)),
    "wandering": 0.01 * STROKE * np.sin(2.0 * np.pi * T / 50.0),
}


@pytest.mark.parametrize("what", NO_CREEP)
def test_what_does_not_follow_the_drive_is_no_creep(what: str) -> None:
    given = record(crept(U) + NO_CREEP[what], U, 2)
    found, without = _identify(given), _identify(given, creep=None)
    assert "creep" not in _kinds(found)
    # To the bit: a search for creep that finds none changes no constant.
    assert found.parameter_values.tolist() == without.parameter_values.tolist()
    assert found.standard_errors.tolist() == without.standard_errors.tolist()
    assert found.verdict == without.verdict


def _ramps(seed: int, n: int = 6000, ramps: int = 60) -> Array:
    """Give ramps of many rates between random levels."""
    levels = np.random.default_rng(seed).uniform(-1.0, 1.0, ramps)
    return np.interp(np.arange(n), np.linspace(0.0, n - 1.0, ramps), levels)


def _widening(u: Array, dt: float) -> Array:
    """Give plays whose radii grow with the rate of the drive."""
    rate, y = np.abs(np.gradient(u, dt)), u.copy()
    for weight, radius in ((0.5, 0.1), (0.4, 0.3)):
        z = 0.0
        for k in range(1, u.size):
            r = radius + 0.05 * rate[k]
            z = min(u[k] + r, max(u[k] - r, z))
            y[k] += weight * z
    return y


@pytest.mark.parametrize("seed", [5, 8])
def test_loops_that_widen_with_the_rate_are_no_creep(seed: int) -> None:
    u = _ramps(seed)
    found = hyst.identify(record(_widening(u, 5e-3), u, seed, dt=5e-3), family="pi")
    assert "creep" not in _kinds(found)


def test_a_lag_of_many_samples_is_no_creep() -> None:
    levels = np.repeat(np.random.default_rng(0).uniform(-1.0, 1.0, 20), 300)
    u = np.convolve(np.pad(levels, 25, mode="edge"), np.ones(51) / 51.0, mode="valid")
    plant = hyst.PrandtlIshlinskii([0.4, 0.3, 0.2], [0.05, 0.2, 0.4], 1.0)
    y = plant(hyst.Lag(0.1, 5e-3)(u))
    found = hyst.identify(record(y, u, 100, dt=5e-3), family="pi")
    assert "creep" not in _kinds(found)


@pytest.mark.parametrize("tau", [0.11, 0.3])
def test_creep_as_fast_as_a_fifth_of_a_stroke_is_still_found(tau: float) -> None:
    u = _ramps(5)
    y = crept(u, (0.06,), (tau,), dt=5e-3)
    (weights, errors), (times, _) = _creep_of(_identify(record(y, u, 5, dt=5e-3)))
    assert np.all(np.abs(weights - 0.06) < 4.0 * errors)
    assert times == pytest.approx([tau], rel=0.15)


@pytest.mark.parametrize("amplitude", [1.0, 30.0])
def test_no_creep_is_told_as_none_where_it_is_asked_for(amplitude: float) -> None:
    u = amplitude * U
    plant = hyst.PrandtlIshlinskii(PLAYS.p, amplitude * PLAYS.r, PLAYS.p0)
    found = _identify(record(crept(u, plant=plant), u, 3), creep=1)
    weights = _creep_of(found)[0]
    # Either no lag at all, with the limit told, or one within its standard errors of none.
    if weights.size:
        assert weights[0, 0] < 3.0 * weights[1, 0]
    else:
        assert any("would have been seen" in each for each in found.undetermined)


def test_drift_beside_creep_stays_outside_and_is_told() -> None:
    drift = -0.03 * STROKE
    found = _identify(record(Y + drift * T / T[-1], U, 4))
    (weights, errors), _ = _creep_of(found)
    assert np.all(np.abs(weights - WEIGHTS) < 4.0 * errors)
    (finding,) = found.diagnosis.named("drift")
    told, error = finding.amounts["total"], finding.amounts["total error"]
    assert abs(told - drift) < 4.0 * error
    assert error < 0.2 * abs(drift)
    assert "beside its creep" in finding.sentence
    assert found.verdict.level == "fair"
    # Without drift that is looked for, what drifts bends the creep.
    assert "drift" not in [each.name for each in _identify(record(Y, U, 4), drift=False).motion]


def test_one_sine_does_not_tell_creep_and_says_by_how_much() -> None:
    u = np.sin(2.0 * np.pi * np.arange(2000) * DT / 2.0)
    y = crept(u, WEIGHTS, TAU)
    with pytest.raises(NotIdentifiableError, match=r"could add up to .* % of the output"):
        _identify(record(y, u, 5), creep=1)


def test_creep_slower_than_the_record_is_told_as_such() -> None:
    short = slice(0, 900)  # 45 s
    y = crept(U, (0.08,), (60.0,))[short]
    found = _identify(record(y, U[short], 6, noise=5e-4), creep=1)
    notes = " ".join(found.undetermined)
    assert "not told from slower creep by records of 45 s" in notes


def test_records_of_other_lengths_and_sample_times_are_fitted_together() -> None:
    fine, coarse = drive(0.04, seed=3)[:1900], drive(0.08, seed=4)
    given = [
        record(crept(fine, WEIGHTS, TAU, 0.04), fine, 7, dt=0.04),
        record(crept(coarse, WEIGHTS, TAU, 0.08), coarse, 8, dt=0.08),
    ]
    (weights, errors), (times, _) = _creep_of(_identify(given, creep=2))
    assert np.all(np.abs(weights - WEIGHTS) < 4.0 * errors)
    assert times == pytest.approx(TAU, rel=0.25)


def test_a_record_that_begins_in_the_middle_is_fitted_all_the_same() -> None:
    """What lags still do of before the record is none of what drives them in it."""
    later = slice(600, None)
    found = _identify(record(Y[later], U[later], 9), creep=2)
    (weights, errors), _ = _creep_of(found)
    assert np.all(np.abs(weights - WEIGHTS) < 4.0 * errors)


PLANTS = {
    "gpi": hyst.GeneralizedPrandtlIshlinskii(hyst.DeadZone([1.0, 0.3], [0.0, 0.4]), PLAYS),
    "mpi": hyst.ModifiedPrandtlIshlinskii(PLAYS, hyst.DeadZone([1.0, -0.2], [0.0, 0.6])),
    "bouc-wen": hyst.BoucWen(k=0.8, A=1.0, beta=1.5, gamma=1.0),
    "preisach": PLAYS,
    "dahl": hyst.Dahl(sigma=4.0, Fc=1.0),
}
OPTIONS = {"gpi": {"plays": 2}, "mpi": {"plays": 2}, "preisach": {"levels": 6}}


@pytest.mark.parametrize("family", PLANTS)
def test_every_family_whose_offset_comes_last_may_creep(family: str) -> None:
    y = crept(U, (0.08,), (6.0,), plant=PLANTS[family])
    given = record(y, U, 10)
    options = OPTIONS.get(family, {})
    found = hyst.identify(given, family=family, creep=1, **options)  # type: ignore[arg-type]
    without = hyst.identify(given, family=family, creep=None, **options)  # type: ignore[arg-type]
    assert _kinds(found)[-2:] == ["creep", "affine"]
    weights, times = _creep_of(found)
    # What a family lacks of the plant's loops may pass for a little creep.
    assert weights[0, 0] == pytest.approx(0.08, abs=0.02)
    assert times[0, 0] == pytest.approx(6.0, rel=0.35)
    assert found.metrics["training"].rms < 0.7 * without.metrics["training"].rms
    command = found.model.inverse()(y)
    assert found.model(command) == pytest.approx(y, abs=1e-10 * np.ptp(y))


@pytest.mark.parametrize("scales", [(8.0, 0.25), (0.5, 1024.0)])
def test_scaled_by_powers_of_two_everything_is_the_same_to_the_bit(
    scales: tuple[float, float],
) -> None:
    given = record(Y, U, 11)
    scaled = hyst.Record(scales[0] * given.u, scales[1] * given.y, DT)
    plain, other = _identify(given), _identify(scaled)
    for a, b in zip(_creep_of(plain), _creep_of(other), strict=True):
        assert np.array_equal(a, b)
    assert np.array_equal(scales[1] * plain.model(U), other.model(scales[0] * U))


def test_time_in_another_unit_scales_time_constants_alone() -> None:
    given = record(Y, U, 12)
    slow = hyst.Record(given.u, given.y, 1000.0 * DT)
    (weights, _), (times, _) = _creep_of(_identify(given, creep=2))
    (others, _), (longer, _) = _creep_of(_identify(slow, creep=2))
    # Rounding of exp(-dt / tau), and where the iteration ends.
    assert others == pytest.approx(weights, rel=1e-5)
    assert longer == pytest.approx(1000.0 * times, rel=1e-5)


def test_prediction_band_and_validation_hold_with_creep() -> None:
    fresh = drive(seed=21)
    other = record(crept(fresh, WEIGHTS, TAU), fresh, 13)
    found = _identify(record(Y, U, 13), validation=other)
    assert found.metrics["validation"].rms_percent < 0.3
    low, high = found.band(fresh)
    inside = np.mean((other.y >= low) & (other.y <= high))
    assert inside > 0.9
    assert found.predict(fresh) == pytest.approx(crept(fresh, WEIGHTS, TAU), abs=0.01 * STROKE)


def test_a_plant_that_creeps_is_followed_by_the_inverse() -> None:
    given = record(Y, U, 14)
    goal = 0.4 * STROKE * np.repeat([0.0, 0.5, -0.5, 0.8, 0.1], 300)
    goal = np.convolve(goal, np.ones(60) / 60.0, mode="same")
    missed = {}
    for creep in ("auto", None):
        command = _identify(given, creep=creep).model.inverse()(goal)
        missed[creep] = float(np.std(crept(command, WEIGHTS, TAU) - goal)) / STROKE
    # Noise of 0.2 % in the record; uncompensated creep is several percent.
    assert missed["auto"] < 0.002
    assert missed[None] > 4.0 * missed["auto"]


def test_a_fit_with_creep_that_does_not_converge_leaves_what_was_found_without() -> None:
    given = record(Y, U, 1)
    found = _identify(given, max_iterations=15)
    without = _identify(given, max_iterations=15, creep=None)
    assert found.parameter_values.tolist() == without.parameter_values.tolist()
    assert "creep" not in _kinds(found)


@pytest.mark.parametrize("creep", ["two", 0, 6, 1.5, True])
def test_what_is_no_number_of_lags_is_refused(creep: object) -> None:
    with pytest.raises(InputError, match="creep is"):
        _identify(record(Y, U, 15), creep=creep)
