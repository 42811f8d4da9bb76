"""What of the records counts: samples left out, lags of any kind, ranges and times of their own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from simulated_records import TRUE_PI, drive, record

import hyst
from hyst.identification.fit.play_bank import bank_gram, bank_matrix
from hyst.identification.fit.problem import model_output
from hyst.identification.record_use.part_of_a_sample import later
from hyst.identification.record_use.thinning import thinned
from hyst.identification.record_use.used_samples import prepare

R = np.array([0.1, 0.3, 0.6])


def with_gaps() -> tuple[hyst.Record, np.ndarray]:
    given = record(TRUE_PI, noise=0.01, delay=3)
    kept = np.ones(len(given), dtype=bool)
    kept[700:760] = kept[1500] = kept[-20:] = False
    return given, kept


def test_sums_leave_out_what_does_not_count() -> None:
    given, kept = with_gaps()
    data = replace(prepare(given, 5, 3), kept=(kept,))
    y = data.measured()
    columns = np.column_stack([bank_matrix(data, R), np.ones(y.size), y])
    np.testing.assert_allclose(bank_gram(data, R), columns.T @ columns, rtol=1e-12)
    # 3000 samples, 5 before the start and 3 of the delay; 81 do not count, all after the start.
    assert y.size == sum(data.lengths()) == 3000 - 8 - 81
    assert data.used()[0].left_out == 81


@pytest.mark.parametrize("delay", [3, -2, 0])
def test_a_sample_left_out_is_the_same_one_for_every_lag(delay: int) -> None:
    given, kept = with_gaps()
    data = replace(prepare(given, 5, delay), kept=(kept,))
    marked = replace(given, y=np.where(kept, given.y, 1e3))
    assert replace(data, records=(marked,)).measured().max() < 1e3


def test_thinned_records_leave_out_the_same() -> None:
    long = record(TRUE_PI, drive(60_000), delay=7)
    kept = np.ones(len(long), dtype=bool)
    kept[20_000:30_000] = False
    spoilt = replace(long, y=np.where(kept, long.y, 50.0))
    thin = thinned(replace(prepare(spoilt, "auto", 7), kept=(kept,)))
    np.testing.assert_allclose(model_output(thin, TRUE_PI), thin.measured(), atol=1e-12)


@pytest.mark.parametrize("part", [0.1, 0.42, 0.5, 0.9])
def test_a_smooth_input_later_by_part_of_a_sample(part: float) -> None:
    k = np.arange(400.0)
    moved = later(np.sin(0.1 * k), part)
    error = np.abs(moved - np.sin(0.1 * (k - part)))[2:-2]
    # Two samples a turn are those of the corner, off by what the sine bends within a sample of its
    # peak, 0.1^2 / 2; the others have the error of cubic interpolation, 0.1^4 * 3 / 128.
    assert error.max() < 0.1**2 / 2.0
    assert np.quantile(error, 0.9) < 3e-6


def test_corners_stay_and_powers_of_two_scale_exactly() -> None:
    u = np.concatenate([np.arange(0.0, 10.0), np.arange(10.0, -5.0, -1.0)])
    moved = later(u, 0.3)
    assert moved.max() == 10.0
    np.testing.assert_array_equal(later(u * 2.0**-40, 0.3), moved * 2.0**-40)


@pytest.mark.parametrize("lag", [1.4, -2.0, -0.6])
def test_lags_of_any_kind_give_the_constants(lag: float) -> None:
    """The truth is smooth in time, so its output at any instant is that of a finer record."""
    fine = drive(30_000)
    truth = np.interp(
        np.arange(3000) * 10.0 - 10.0 * lag, np.arange(30_000), TRUE_PI(fine), left=0.0
    )
    given = hyst.Record(fine[::10], truth, 1e-3)
    found = hyst.identify(given, family="pi", plays=3, delay=lag)
    assert found.delay == lag
    assert found.model.parameters().values[:7] == pytest.approx(
        [1.0, 0.5, 0.4, 0.3, 0.1, 0.3, 0.6], rel=0.02
    )
    np.testing.assert_allclose(found.predict(given.u)[100:-100], truth[100:-100], atol=0.01)


def test_a_record_of_smaller_amplitude_takes_part() -> None:
    t = np.arange(2000) / 100.0
    large = 10.0 * np.sin(2.0 * np.pi * t)
    small = 5.0 * np.sin(2.0 * np.pi * t[:1000])
    model = hyst.PrandtlIshlinskii([0.5, 0.3], [1.0, 2.0], 1.0)
    pair = [hyst.Record(u, model(u), 0.01) for u in (large, small)]
    found = hyst.identify(pair, family="pi", plays=2, delay=0)
    assert all(each.stop - each.start > 900 for each in found.used)
    spoilt = [pair[0], replace(pair[1], y=3.0 * pair[1].y)]
    worse = hyst.identify(spoilt, family="pi", plays=2, delay=0)
    assert worse.metrics["training"].rms_percent > 1.0 > 1e6 * found.metrics["training"].rms_percent


def test_rate_independent_records_of_different_sample_times_share_one_lag_in_time() -> None:
    fast = record(TRUE_PI, delay=4, noise=0.002)
    slow = hyst.Record(fast.u[::2], fast.y[::2], 2e-3)
    found = hyst.identify([fast, slow], family="pi", plays=3, delay=4)
    assert found.model.parameters().values[0] == pytest.approx(1.0, abs=0.01)
    assert found.used[1].start == found.used[0].start // 2 or found.used[1].start > 0


@pytest.mark.parametrize("part", [-0.25, -0.01, 0.25])
def test_an_input_a_little_earlier_goes_on_beyond_its_last_sample(part: float) -> None:
    """The last sample of a straight ramp moves as all others do, and is not held."""
    ramp = np.concatenate([np.linspace(0.0, 1.0, 50), np.linspace(1.0, -1.0, 101)[1:]])
    data = prepare(hyst.Record(ramp, ramp, 1e-3), "auto")
    moved = data.a_little_later(part).records[0].u
    step = -2.0 / 100.0
    np.testing.assert_allclose(moved[-20:] - ramp[-20:], -part * step, atol=1e-12)
