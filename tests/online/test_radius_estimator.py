"""The paper's law, and recursive least squares on the same regression."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import hyst
from hyst import _engine
from hyst.online import RadiusEstimator
from online.plants import (
    DT,
    FIVE_PLAYS,
    P,
    R,
    random_signals,
    record,
    regimes_of,
    sine,
    usable,
)


def test_paper_law_reaches_four_percent_then_three_per_mille() -> None:
    u = sine(200.0)
    estimator = RadiusEstimator(P, np.zeros(5), gain=10.0, dt=DT)
    radii = estimator.run(record(u, FIVE_PLAYS(u)), every=20_000).values
    # A prototype written from the paper's equations alone had these after 20, 60 and 200 s.
    for row, expected in (
        (0, [0.416, 0.964, 1.492, 2.233, 3.315]),
        (2, [0.401, 0.999, 1.488, 2.051, 3.571]),
        (9, [0.400, 0.999, 1.501, 1.999, 3.601]),
    ):
        # It started from other radii, which the first 20 s have not forgotten altogether.
        assert radii[row] == pytest.approx(expected, abs=0.02 if row == 0 else 2e-3)
    assert np.abs(radii[2] / R - 1.0).max() < 0.04
    assert np.abs(radii[9] / R - 1.0).max() < 0.003


@pytest.mark.parametrize("start", [0.0, 0.5, 1.5])
def test_least_squares_reaches_one_per_mille_in_three_periods(start: float) -> None:
    u = sine(3.0)
    estimator = RadiusEstimator(P, start * R, gain=100.0, dt=DT, method="least-squares")
    estimator.run(record(u, FIVE_PLAYS(u)))
    # What is left of the start: a hundred of the noise's variances against 3000 samples.
    assert np.abs(estimator.radii / R - 1.0).max() < 3e-4


def test_least_squares_default_does_no_harm_in_noise() -> None:
    u = sine(20.0)
    y = FIVE_PLAYS(u)
    sigma = float(np.std(y)) / 100.0

    def error(tolerance: float | None) -> float:
        found = []
        for seed in range(3):
            noisy = y + sigma * np.random.default_rng(seed).standard_normal(u.size)
            estimator = RadiusEstimator(
                P, 0.5 * R, gain=100.0 / sigma**2, dt=DT, method="least-squares",
                filter_time=0.05, dead_time=0.05, tolerance=tolerance,
            )  # fmt: skip
            estimator.run(record(u, noisy), every=1000)
            found.append(estimator.radii / R - 1.0)
        return float(np.sqrt(np.mean(np.square(found))))

    # 40 dB. Taking every sample is no better; 2 % for what 3 runs scatter.
    assert error(None) < 1.02 * error(1.0)


def test_minor_loops_do_not_mislead() -> None:
    # Plays that stayed inside keep where they left their envelope, reversals ago.
    t = np.arange(20_000) * DT
    u = 12.0 * np.sin(2 * np.pi * 0.5 * t) + 3.0 * np.sin(2 * np.pi * 3.1 * t)
    estimator = RadiusEstimator(
        P, 1.5 * R, gain=100.0, dt=DT, method="least-squares", tolerance=0.1
    )
    estimator.run(record(u, FIVE_PLAYS(u)))
    assert np.abs(estimator.radii / R - 1.0).max() < 1e-2


def test_regime_follows_the_slope() -> None:
    estimator = RadiusEstimator([1.0, 2.0], [0.5, 1.0], gain=0.0, dt=1.0)
    model = hyst.PrandtlIshlinskii([1.0, 2.0], [0.5, 1.0])
    # From 0: both inside, then the first alone, then both; the steps between are mixed.
    u = [0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0]
    seen = []
    for u_k, y_k in zip(u, model(u), strict=True):
        estimator.update(u_k, y_k)
        seen.append(estimator.regime)
    assert seen == [None, 0, 0, 1, 1, 2, 2]


def test_filter_and_dead_time_keep_noise_from_choosing_the_regime() -> None:
    u = sine(20.0)
    y = FIVE_PLAYS(u) + 0.02 * np.random.default_rng(0).standard_normal(u.size)

    def worst(**options: float) -> float:
        estimator = RadiusEstimator(P, 1.5 * R, gain=10.0, dt=DT, **options)  # type: ignore[arg-type]
        estimator.run(record(u, y))
        return float(np.abs(estimator.radii / R - 1.0).max())

    # 52 dB. Without a filter the slope near a reversal is mostly noise.
    assert worst(filter_time=0.005, dead_time=0.01) < 0.6 * worst()


def test_projection_is_the_nearest_ordered_point() -> None:
    from scipy.optimize import isotonic_regression

    rng = np.random.default_rng(1)
    for count in (1, 2, 5, 20):
        for _ in range(50):
            x = rng.normal(0.5, 1.0, count)
            projected = x.copy()
            _engine.project_radii(projected, 1.0)
            # Bounds common to all: clipping the isotonic regression is the projection onto both.
            expected = np.clip(isotonic_regression(x).x, 0.0, 1.0)
            assert projected == pytest.approx(expected, abs=1e-14 * count)


def test_gains_that_differ_lead_to_the_truth_where_radii_are_pooled() -> None:
    # Both radii start at 5 and are pooled at once. A projection in another metric than that of the
    # gains lets the fast one push the slow one up, stroke by stroke, without end.
    truth = hyst.PrandtlIshlinskii([1.0, 2.0], [1.0, 2.0], 0.1)
    u = sine(200.0)
    estimator = RadiusEstimator([1.0, 2.0], [5.0, 5.0], [100.0, 0.1], DT, p0=0.1)
    trajectory = estimator.run(record(u, truth(u)), every=1000)
    distance = ((trajectory.values - truth.r) ** 2 / [100.0, 0.1]).sum(axis=1)
    # Without noise this distance, the law's own, never grows; samples that straddle two regimes
    # leave 1 % of a radius (the slow one, 2, weighs 1 / 0.1).
    assert (np.diff(distance) <= 0.02**2 / 0.1).all()
    assert estimator.radii == pytest.approx(truth.r, rel=0.01)


def test_a_gain_of_zero_keeps_a_radius() -> None:
    u = sine(5.0)
    estimator = RadiusEstimator(P, 1.5 * R, [10.0, 10.0, 0.0, 10.0, 10.0], DT)
    estimator.run(record(u, FIVE_PLAYS(u)))
    assert estimator.radii[2] == 1.5 * R[2]
    assert (np.diff(estimator.radii) >= 0.0).all()


def test_bad_samples_are_skipped_and_counted() -> None:
    estimator = RadiusEstimator(P, R, gain=10.0, dt=DT)
    u = sine(0.5)
    for k, (u_k, y_k) in enumerate(zip(u, FIVE_PLAYS(u), strict=True)):
        estimator.update(u_k, y_k)
        if k % 50 == 0:
            assert not estimator.update(np.nan, y_k)
            assert not estimator.update(u_k, np.inf)
    assert estimator.counts["skipped"] == 22
    assert np.abs(estimator.radii / R - 1.0).max() < 0.01


def test_absurd_samples_are_skipped_counted_and_forgotten() -> None:
    estimator = RadiusEstimator(P, R, gain=10.0, dt=DT)
    u = sine(0.5)
    y = FIVE_PLAYS(u)
    for first in ((1e300, 0.0), (0.0, -1e300)):
        assert not estimator.update(*first)
    for k, (u_k, y_k) in enumerate(zip(u, y, strict=True)):
        estimator.update(u_k, y_k)
        if k % 50 == 0:
            assert not estimator.update(1e300, y_k)
            assert not estimator.update(u_k, -1e308)
    assert estimator.counts["skipped"] == 24
    assert np.isfinite(estimator.state).all()
    assert np.abs(estimator.radii / R - 1.0).max() < 0.01


def test_a_million_random_steps_leave_ordered_finite_radii() -> None:
    rng = np.random.default_rng(9)
    u, y = random_signals(rng, 1_000_000)
    for method in ("gradient", "least-squares"):
        estimator = RadiusEstimator(P, R, 10.0, DT, method=method, memory=2.0, most_radius=50.0)  # type: ignore[arg-type]
        core, at = estimator._core, estimator._at
        r, error = np.empty((u.size, 5)), np.empty(u.size)
        core.run(estimator.state, u, y, 1, r, error, False, np.empty(0))
        assert (np.diff(r, axis=1, prepend=0.0, append=50.0) >= 0.0).all()
        assert np.isfinite(error).all()
        assert np.isfinite(estimator.state[: at["length"] - 30]).all()
        assert estimator.counts["skipped"] == int((~usable(u, y)).sum())


def test_a_weight_of_zero_leaves_its_radius_alone() -> None:
    weights = np.array([0.3, 0.0, 0.8])
    model = hyst.PrandtlIshlinskii(weights, [0.4, 1.0, 1.5], 0.1)
    u = sine(2.0)
    estimator = RadiusEstimator(weights, [0.5, 1.0, 1.4], 20.0, DT, p0=0.1, method="least-squares")
    estimator.run(record(u, model(u)))
    assert estimator.radii[1] == 1.0
    assert estimator.radii[[0, 2]] == pytest.approx([0.4, 1.5], rel=0.02)
    assert "weight is 0" in estimator.excitation(1.0, 60.0).plays[1].reason


def test_input_that_never_turns_and_no_plays() -> None:
    estimator = RadiusEstimator(P, R, gain=10.0, dt=DT)
    u = np.linspace(0.0, 30.0, 1000)
    estimator.run(record(u, FIVE_PLAYS(u)))
    assert np.isfinite(estimator.radii).all()
    empty = RadiusEstimator([], [], gain=1.0, dt=DT, p0=1.0)
    assert not empty.update(0.0, 0.0)
    assert not empty.update(1.0, 1.0)
    assert empty.radii.size == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"p": [0.5, -0.1]}, r"p\[2\] is -0.1"),
        ({"gain": 1e6}, "diverges"),
        ({"gain": [1.0, 2.0, 3.0]}, "gain has shape"),
        ({"gain": -1.0}, "gain has the entry -1"),
        ({"dt": 0.0}, "dt is 0.0"),
        ({"dt": np.nan}, "dt is nan"),
        ({"tolerance": 1.5}, "tolerance is 1.5"),
        ({"method": "newton"}, "method is 'newton'"),
        ({"most_radius": 0.5}, "most_radius is 0.5"),
        ({"memory": -1.0}, "memory is -1.0"),
        ({"most_radius": "wide"}, "most_radius is 'wide'"),
        ({"dead_time": None}, "dead_time is None"),
    ],
)
def test_arguments_that_make_no_sense(arguments: dict[str, object], message: str) -> None:
    given = {"p": [0.5, 0.2], "r": [0.5, 1.0], "gain": 1.0, "dt": DT} | arguments
    with pytest.raises(hyst.InputError, match=message):
        RadiusEstimator(**given)  # type: ignore[arg-type]


def test_what_is_no_number_is_refused() -> None:
    estimator = RadiusEstimator(P, R, 10.0, DT)
    with pytest.raises(hyst.InputError, match=r"u = 'a', y = 1; give two numbers"):
        estimator.update("a", 1)  # type: ignore[arg-type]
    for every in (0, 1.5, True):
        with pytest.raises(hyst.InputError, match="every is"):
            estimator.run(record(np.zeros(3), np.zeros(3)), every=every)  # type: ignore[arg-type]
    with pytest.raises(hyst.InputError, match=r"record is a list; give a hyst\.Record"):
        estimator.run([1, 2])  # type: ignore[arg-type]
    with pytest.raises(hyst.InputError, match="swing is 'a'; give a finite number"):
        estimator.excitation(1.0, "a")  # type: ignore[arg-type]
    with pytest.raises(hyst.InputError, match="patience is 'a'; give seconds"):
        estimator.excitation("a", 1.0)  # type: ignore[arg-type]


def test_another_sample_time_is_refused() -> None:
    u = sine(0.1)
    with pytest.raises(hyst.InputError, match=r"dt = 0.002 s"):
        RadiusEstimator(P, R, 10.0, DT).run(record(u, u, dt=2e-3))


def test_saved_and_restored_it_continues_with_the_same_bits(tmp_path: Path) -> None:
    u = sine(1.0)
    y = FIVE_PLAYS(u)
    options = {"method": "least-squares", "filter_time": 0.005, "dead_time": 0.01, "memory": 3.0}
    regimes = regimes_of(u, R)
    whole, part = (RadiusEstimator(P, 1.5 * R, 50.0, DT, **options) for _ in range(2))  # type: ignore[arg-type]
    whole.run(record(u, y), regimes=regimes)
    part.run(record(u[:444], y[:444]), regimes=regimes[:444])
    part.save(tmp_path / "estimator.json")
    restored = hyst.load(tmp_path / "estimator.json")
    assert isinstance(restored, RadiusEstimator)
    for u_k, y_k, regime in zip(u[444:], y[444:], regimes[444:], strict=True):
        restored.update(u_k, y_k, regime=regime)
    assert restored.radii.tobytes() == whole.radii.tobytes()
    assert np.isfinite(whole.standard_errors).all()
    assert restored.standard_errors.tobytes() == whole.standard_errors.tobytes()


def test_saved_radii_out_of_order_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "estimator.json"
    RadiusEstimator(P, R, gain=10.0, dt=DT).save(path)
    content = json.loads(path.read_text())
    first = content["state"].index(R[0])
    for place, value, message in (
        (0, -0.4, r"r\[1\] = -0.4 below 0"),
        (4, 0.1, r"r\[5\] = 0.1 below r\[4\] = 2"),
        (4, 1e9, "above most_radius = 3600"),
    ):
        state = list(content["state"])
        state[first + place] = value
        path.write_text(json.dumps({**content, "state": state}))
        with pytest.raises(hyst.InputError, match=message):
            hyst.load(path)
