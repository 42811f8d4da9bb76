"""The law of radii with slope or regime from outside, and as an estimator like any other."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst.online import RadiusEstimator
from online.plants import DT, FIVE_PLAYS, P, R, record, regimes_of, sine


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
