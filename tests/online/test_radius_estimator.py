"""The paper's law, and recursive least squares on the same regression."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import hyst
from hyst import _engine
from hyst.online import RadiusEstimator
from online.plants import DT, FIVE_PLAYS, P, R, random_signals, record, sine, usable


def regimes_of(u: np.ndarray, r: np.ndarray) -> np.ndarray:
    """Count plays of radii r on the envelope the input moves along, eqs. 1 and 2; NaN at rest."""
    z, before, found = np.zeros(r.size), u[0], np.full(u.size, np.nan)
    for k, v in enumerate(u):
        z = np.maximum(v - r, np.minimum(v + r, z))
        if v != before:
            found[k] = np.sum(np.sign(v - before) * (v - z) >= r - 1e-9)
        before = v
    return found


def own_gradient(u: np.ndarray, y: np.ndarray, regimes: np.ndarray, gain: float) -> np.ndarray:
    """The law as one regression with each play's own reversal, from radii of 0; radii over time."""
    r, home, side, s = np.zeros(5), np.zeros(5), np.zeros(5), 0.0
    seen, kept = np.zeros(5, dtype=bool), []
    for k in range(1, u.size):
        way = np.sign(u[k] - u[k - 1])
        if way != s:
            home[seen], side[seen] = u[k - 1], way
            s, seen = way, np.zeros(5, dtype=bool)
        on = np.arange(5) < regimes[k]
        seen |= on
        phi = P * np.where(on, -s, side)
        error = y[k] - P @ np.where(on, u[k], home) - phi @ r
        r = r + gain * DT * phi * error
        # Pool adjacent violators: means of all runs, the largest of the smallest (Robertson).
        means = [[r[a : b + 1].mean() if b >= a else np.inf for b in range(5)] for a in range(5)]
        r = np.array([max(min(means[a][i:]) for a in range(i + 1)) for i in range(5)]).clip(0.0)
        kept.append(r)
    return np.array(kept)


def test_told_regimes_give_the_law_written_down_again() -> None:
    u = 12.0 * np.sin(2 * np.pi * np.arange(3000) * DT) + 4.0 * np.sin(
        14 * np.pi * np.arange(3000) * DT
    )
    y = FIVE_PLAYS(u) + 0.1 * np.random.default_rng(0).standard_normal(u.size)
    regimes = regimes_of(u, R)
    expected = own_gradient(u, y, regimes, 10.0)
    estimator = RadiusEstimator(P, np.zeros(5), 10.0, DT)
    values = estimator.run(record(u, y), regimes=regimes).values[1:]
    # Rounding of a few thousand sums.
    assert values == pytest.approx(expected, abs=1e-10)
    assert expected[-1][:4] == pytest.approx(R[:4], rel=0.2)  # it has gone somewhere
    one_by_one = RadiusEstimator(P, np.zeros(5), 10.0, DT)
    for u_k, y_k, regime in zip(u, y, regimes, strict=True):
        one_by_one.update(u_k, y_k, regime=regime)
    assert one_by_one.radii.tobytes() == estimator.radii.tobytes()


def test_a_told_slope_is_as_good_as_the_regime_it_tells() -> None:
    u = sine(2.0)
    y = FIVE_PLAYS(u) + 3.0 * np.random.default_rng(0).standard_normal(u.size)
    regimes = regimes_of(u, R)
    slopes = np.array([np.nan if np.isnan(k) else P[: int(k)].sum() for k in regimes])
    by_slope, by_regime, measured = (RadiusEstimator(P, R, 10.0, DT) for _ in range(3))
    by_slope.run(record(u, y), slopes=slopes)
    by_regime.run(record(u, y), regimes=regimes)
    measured.run(record(u, y))
    assert by_slope.radii.tobytes() == by_regime.radii.tobytes()
    assert by_slope.knows_regimes
    assert not measured.knows_regimes
    # 22 dB: the measured slope is noise alone, and its error many times that of 2000 samples.
    assert np.abs(measured.radii - R).max() > 5.0 * np.abs(by_regime.radii - R).max()


def test_bands_hold_where_regimes_are_told_and_are_not_given_elsewhere() -> None:
    shares = []
    for make in (
        sine,
        lambda seconds: -15.0 + 0.45 * np.abs(np.arange(seconds / DT) // 10 % 200 - 100),
    ):
        u = make(8.0)
        y, regimes = FIVE_PLAYS(u), regimes_of(u, R)
        for decibels in (20.0, 40.0):
            sigma = float(np.std(y)) * 10.0 ** (-decibels / 20.0)
            inside = []
            for seed in range(15):
                noisy = y + sigma * np.random.default_rng(seed).standard_normal(u.size)
                estimator = RadiusEstimator(
                    P, 0.5 * R, 100.0 / sigma**2, DT, method="least-squares"
                )
                estimator.run(record(u, noisy), u.size, regimes=regimes)
                known = estimator.knowledge
                assert known.known
                inside += ((known.low <= R) & (known.high >= R)).tolist()
                # 150 errors tell the noise to 6 %; 4 of that.
                assert estimator.noise == pytest.approx(sigma, rel=0.25)
            shares.append(np.mean(inside))
    # 0.95 is what two standard errors promise; 75 radii scatter by 0.025, and those of a run go
    # together.
    assert min(shares) > 0.86
    assert np.mean(shares) > 0.92
    u = sine(2.0)
    for method in ("gradient", "least-squares"):
        estimator = RadiusEstimator(P, R, 10.0, DT, method=method)  # type: ignore[arg-type]
        estimator.run(record(u, FIVE_PLAYS(u)))
        assert not estimator.knowledge.known
        assert np.isnan(estimator.standard_errors).all()
    assert "measured slope" in str(estimator.knowledge)


def test_unknown_regimes_teach_nothing_while_the_input_moves() -> None:
    u = sine(1.0)
    y = FIVE_PLAYS(u)
    estimator = RadiusEstimator(P, 1.5 * R, 10.0, DT)
    estimator.run(record(u, y), regimes=np.full(u.size, np.nan))
    assert (estimator.radii == 1.5 * R).all()
    assert estimator.counts["used"] == 0


@pytest.mark.parametrize(
    ("told", "message"),
    [
        ({"slopes": [1.0], "regimes": [1.0]}, "slope and regime are both given"),
        ({"slopes": [1.0, 2.0]}, r"slope has the shape \(2,\), the record has 3 samples"),
        ({"regimes": [0.0, 6.0, 0.0]}, "regime is 6 at sample 1"),
        ({"regimes": [0.5, 0.0, 0.0]}, "regime is 0.5 at sample 0"),
        ({"slopes": "steep"}, "slope is 'steep'"),
    ],
)
def test_told_numbers_that_make_no_sense(told: dict[str, object], message: str) -> None:
    estimator = RadiusEstimator(P, R, 10.0, DT)
    with pytest.raises(hyst.InputError, match=message):
        estimator.run(record(np.zeros(3), np.zeros(3)), **told)  # type: ignore[arg-type]
    with pytest.raises(hyst.InputError, match="regime is 7 at sample 0"):
        estimator.update(0.0, 0.0, regime=7)


def test_samples_in_the_dead_band_behind_a_turn_are_left_out() -> None:
    # With the true regimes and without noise nothing may move a right estimate.
    u = sine(3.0)
    estimator = RadiusEstimator(P, R, 10.0, DT, dead_band=0.5)
    estimator.run(record(u, FIVE_PLAYS(u)), regimes=regimes_of(u, R))
    assert estimator.radii == pytest.approx(R, abs=1e-9)
    assert estimator.counts["used"] > 2000


def test_a_first_input_far_from_rest_takes_the_plays_along() -> None:
    u = sine(3.0) - 15.0
    u = u[: np.argmax(u > 0.0)]  # from -15 upwards, no reversal
    estimator = RadiusEstimator(P, 0.9 * R, 100.0, DT, method="least-squares")
    estimator.run(record(u, FIVE_PLAYS(u)), regimes=regimes_of(u, R))
    # Rounding, and what a hundred times the noise's variance leaves of the start.
    assert estimator.radii == pytest.approx(R, rel=2e-2)


def test_it_is_an_estimator_that_follows_commands_and_starts_again() -> None:
    truth = hyst.PrandtlIshlinskii(P, R, 0.5)
    u = sine(2.3) + 4.0
    y = hyst.Affine(1.0, 7.0)(truth(u))
    estimator = RadiusEstimator(P, R, 10.0, DT, p0=0.5, offset=7.0)
    assert isinstance(estimator, hyst.online.Estimator)
    assert estimator.names == ("r[1]", "r[2]", "r[3]", "r[4]", "r[5]")
    regimes = regimes_of(u, R)
    estimator.run(record(u[:1500], y[:1500]), regimes=regimes[:1500])
    # Radii are right and stay so; the memory is that of the plant, so the inverse is, too.
    for k in range(1500, 1600):
        assert estimator.command(y[k]) == pytest.approx(u[k], abs=1e-9)
        estimator.update(u[k], y[k], regime=regimes[k])
    assert estimator.model(u[1600:]) == pytest.approx(y[1600:], abs=1e-9)
    # Followed without outputs it ends in the same memory.
    estimator.follow(u[1600:])
    assert estimator.model(u[::-1]) == pytest.approx(
        hyst.Affine(1.0, 7.0)(hyst.PrandtlIshlinskii(P, R, 0.5)(np.concatenate([u, u[::-1]])))[
            u.size :
        ],
        abs=1e-9,
    )
    frozen = estimator.frozen()
    frozen.run(record(u, y + 1.0))
    assert (frozen.radii == estimator.radii).all()
    estimator.restart(hyst.Affine(1.0, 7.0) @ hyst.PrandtlIshlinskii(P, 1.1 * R, 0.5))
    assert estimator.radii == pytest.approx(1.1 * R)
    estimator.restart()
    assert (estimator.radii == R).all()
    with pytest.raises(hyst.InputError, match="other weights or another offset"):
        estimator.restart(hyst.PrandtlIshlinskii(P, R, 0.5))
    with pytest.raises(hyst.NotInvertibleError):
        RadiusEstimator(P, R, 10.0, DT).command(1.0)


def test_estimates_do_not_depend_on_units() -> None:
    u = sine(3.0)
    y = FIVE_PLAYS(u) + 0.3 * np.random.default_rng(0).standard_normal(u.size)
    for method, gain in (("gradient", 10.0), ("least-squares", 25.0)):
        plain = RadiusEstimator(P, 1.5 * R, gain, DT, method=method, dead_band=0.25)  # type: ignore[arg-type]
        plain.run(record(u, y))
        # Input in units of 1/4, output in units of 1/16: weights by 4, its gains by the square.
        other = RadiusEstimator(
            P * 4.0,
            1.5 * R * 4.0,
            gain / 16.0,
            DT,
            method=method,
            dead_band=1.0,  # type: ignore[arg-type]
        )
        other.run(record(u * 4.0, y * 16.0))
        assert (other.radii / 4.0).tobytes() == plain.radii.tobytes()


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
