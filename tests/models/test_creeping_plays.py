"""Plays whose outputs creep: against a sum of what they are made of, and their inverse."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.signal

import hyst

DT = 1e-3
P, R, P0 = [0.5, 0.3, 0.2], [0.1, 0.4, 0.7], 1.0
WEIGHTS = np.array([[0.03, 0.02], [-0.01, 0.04], [0.0, 0.05]])
TIMES = [0.013, 1.7]
STAGE = hyst.CreepingPlays(P, R, P0, WEIGHTS, TIMES, DT)


def drive(samples: int = 3000, seed: int = 0) -> np.ndarray:
    return 0.3 + np.random.default_rng(seed).normal(size=samples).cumsum() / 30.0


def test_it_is_the_sum_of_plays_and_their_lags() -> None:
    u = drive()
    expected = P0 * u
    for p, r, row in zip(P, R, WEIGHTS, strict=True):
        z = hyst.Play(r)(u)
        expected = expected + p * z
        for weight, tau in zip(row, TIMES, strict=True):
            keep = np.exp(-DT / tau)
            expected = expected + weight * scipy.signal.lfilter([0.0, 1.0 - keep], [1.0, -keep], z)
    # Roundings of the filters, each of thousands of samples of memory.
    np.testing.assert_allclose(STAGE(u), expected, rtol=0.0, atol=1e-12)


def test_with_the_same_lags_for_all_it_is_creep_of_what_the_plays_give() -> None:
    shares, u = np.array([0.02, 0.05]), drive(seed=1)
    # A play of threshold 0 stands for the linear part, which creeps as well.
    stage = hyst.CreepingPlays([0.4, *P], [0.0, *R], 0.6, np.outer([1.0, *P], shares), TIMES, DT)
    creep = hyst.Creep(shares, TIMES, DT) @ hyst.PrandtlIshlinskii(P, R, 1.0)
    np.testing.assert_allclose(stage(u), creep(u), rtol=0.0, atol=1e-13)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("scale", [1.0, 1e-7, 4e5])
def test_it_is_inverted_from_the_first_sample_on(seed: int, scale: float) -> None:
    stage, wanted = STAGE.in_units(1.0, scale), scale * drive(seed=seed)
    inverse = stage.inverse()
    # Some ten roundings on each of the two ways, steeper by less than 2 in the inverse.
    assert np.abs(stage(inverse(wanted)) - wanted).max() <= 2e-14 * np.ptp(wanted)
    u = drive(seed=seed)
    assert np.abs(inverse(stage(u)) - u).max() <= 2e-14 * np.ptp(u)


def test_it_composes_with_a_lag_and_a_bend() -> None:
    bend = hyst.DeadZone.odd([1.0, 0.2], [0.0, 0.5])
    model = hyst.Affine(-3.0, 1.0) @ bend @ STAGE @ hyst.Lag(0.42 * DT, DT)
    wanted = drive(seed=9)
    assert np.abs(model(model.inverse()(wanted)) - wanted).max() <= 5e-14 * np.ptp(wanted)


def test_at_another_sample_time_it_creeps_the_same_in_seconds() -> None:
    slower, u = STAGE.at_sample_time(4.0 * DT), drive(1000, seed=2)
    # A held input is the same input at both.
    np.testing.assert_allclose(STAGE(np.repeat(u, 4))[::4], slower(u), rtol=1e-12)


@pytest.mark.parametrize(
    ("stage", "why"),
    [
        (hyst.CreepingPlays([0.5], [0.1], 0.0, [[0.1]], [1.0], DT), "p0 is 0"),
        (hyst.CreepingPlays([-2.0], [0.1], 1.0, [[0.1]], [1.0], DT), r"p\[1\] = -2"),
        (
            hyst.CreepingPlays([0.5], [0.1], 1.0, [[1.2]], [1.0], DT),
            r"sum up to 1\.2 in size, .* their product, 1\.6, must be below 1",
        ),
    ],
)
def test_what_is_not_shown_to_settle_is_refused(stage: hyst.Operator, why: str) -> None:
    with pytest.raises(hyst.NotInvertibleError, match=why):
        stage.inverse()


@pytest.mark.parametrize(
    ("weights", "times", "why"),
    [
        ([0.1], [1.0], r"weights has shape \(1,\); give a row for each of 1 plays"),
        ([[0.1, 0.2]], [1.0], r"weights has shape \(1, 2\)"),
        ([[0.1]], [-1.0], r"time_constants\[0\] is -1"),
        ([[float("nan")]], [1.0], "weights"),
        ([["a", 0.1]], [1.0, 10.0], "weights has dtype"),
        ([[0.1], [0.2, 0.3]], [1.0, 10.0], "weights is not a rectangular array"),
        (None, [1.0, 10.0], "weights has dtype object"),
    ],
)
def test_bad_constants_are_named(weights: list, times: list, why: str) -> None:
    with pytest.raises(hyst.InputError, match=why):
        hyst.CreepingPlays([0.5], [0.1], 1.0, weights, times, DT)


@pytest.mark.parametrize("times", [[], [1.0, 10.0]])
def test_no_plays_at_all_are_saved_and_loaded(times: list[float], tmp_path) -> None:
    stage = hyst.models.CreepingPlays([], [], 2.0, np.empty((0, len(times))), times, 1.0)
    stage.save(tmp_path / "stage.json")
    assert hyst.load(tmp_path / "stage.json") == stage
    assert stage([1.0, 2.0]).tolist() == [2.0, 4.0]
    assert stage.inverse()([2.0, 4.0]).tolist() == [1.0, 2.0]
