"""Records of a million samples, and loops so asymmetric that they look delayed."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_records import TRUE_PI, drive, plays_by_definition, record

import hyst
from hyst.identification.record_use.thinning import thinned
from hyst.identification.record_use.used_samples import prepare


def test_thinning_keeps_the_memory_of_a_smooth_input() -> None:
    """Memory after thinning against the definition on every sample."""
    u = drive(60_000)
    data = prepare(record(TRUE_PI, u), "auto", 0)
    thin = thinned(data)
    kept = thin.records[0]
    assert 10_000 < len(kept) < 25_000
    assert len(thin.records) == 1
    places = np.searchsorted(np.arange(u.size) * 1.0, np.flatnonzero(np.isin(u, kept.u)))
    full = plays_by_definition(u, TRUE_PI.r)[places]
    np.testing.assert_array_equal(plays_by_definition(u[places], TRUE_PI.r), full)


def test_thinning_leaves_short_records_alone_and_brings_the_output_forward() -> None:
    data = prepare(record(TRUE_PI, delay=2), "auto", 2)
    assert thinned(data) is data
    long = record(TRUE_PI, drive(60_000), delay=7)
    thin = thinned(prepare(long, "auto", 7))
    assert thin.delay == 0
    np.testing.assert_allclose(TRUE_PI(thin.records[0].u), thin.records[0].y, atol=1e-12)


def test_where_turns_alone_are_too_many_stretches_are_kept_with_what_they_remember() -> None:
    """Ten samples a branch, 200,000 in all: the memory of every stretch is that of the record."""
    t = np.arange(200_000) * 1e-3
    u = (1.0 - 0.6 * np.sin(np.pi * t / t[-1])) * np.sin(2.0 * np.pi * 50.0 * t + 0.3)
    thin = thinned(prepare(record(TRUE_PI, u), "auto", 0))
    assert len(thin.records) > 1
    assert sum(len(each) for each in thin.records) < 25_000
    # Nested loops that differ by less than a thousandth of the range count as one.
    bound = 1e-3 * 2.0 * TRUE_PI.p.sum()
    for piece, first in zip(thin.records, thin.starts, strict=True):
        np.testing.assert_allclose(TRUE_PI(piece.u)[first:], piece.y[first:], rtol=0.0, atol=bound)


def test_branches_keep_samples_on_the_way() -> None:
    """Stretches as long as a period lost the inside of every loop, and with it plays and family."""
    t = np.arange(60_000) * 1e-3
    u = np.sin(2.0 * np.pi * 5.0 * t)
    thin = thinned(prepare(record(TRUE_PI, u), "auto", 0)).records[0]
    turns = hyst.signals.reversals(thin.u, 0.1)
    assert np.diff(turns).min() >= 5


@pytest.mark.parametrize("samples", [60_000, 200_000])
def test_more_data_is_not_worse(samples: int) -> None:
    """One actuator at 50 Hz: in 0.1.0 the longer record ended at 0.68 % with one play."""
    plays = hyst.PrandtlIshlinskii([0.5, 0.4, 0.3, 0.2], [0.08, 0.22, 0.43, 0.71], 1.0)
    bend = hyst.DeadZone([1.0, 0.1, -0.1], [0.0, 0.7, -0.7])
    errors = []
    for count in (20_000, samples):
        t = np.arange(count) * 1e-3
        u = (1.0 - 0.6 * np.sin(np.pi * t / t[-1])) * np.sin(2.0 * np.pi * 50.0 * t + 0.3)
        true = hyst.ModifiedPrandtlIshlinskii(plays, bend)(u)
        noisy = true + 0.01 * np.random.default_rng(1).standard_normal(count)
        found = hyst.identify(hyst.Record(u, noisy, dt=1e-3), family="gpi", plays=4)
        errors.append(float(np.std(found.model(u) - true)))
    assert errors[1] < 1.2 * errors[0]


def test_a_long_record_ends_at_the_minimum_of_all_samples() -> None:
    u = drive(60_000)
    found = hyst.identify(record(TRUE_PI, u, noise=0.01), family="pi", plays=3)
    assert found.delay == 0
    # Without noise in the model the residual is the noise; 60 000 samples know it to 0.3 %.
    assert found.metrics["training"].rms == pytest.approx(0.01, rel=0.01)
    distances = (found.parameter_values[:7] - [1, 0.5, 0.4, 0.3, 0.1, 0.3, 0.6]) / (
        found.standard_errors[:7]
    )
    assert np.abs(distances).max() < 4.5


@pytest.mark.parametrize(("scale", "most"), [(25.0, 1), (60.0, 0)])
def test_strong_asymmetry_is_not_taken_for_delay(scale: float, most: int) -> None:
    """The general estimate alone says 7 and 3; a map with 12 knots still bends a little wrong."""
    u = 50.0 * (1.0 + drive(6000))
    pi = hyst.PrandtlIshlinskii(p=[0.2, 0.15], r=[8.0, 25.0], p0=0.6)
    y = np.exp(pi(u) / scale) * scale
    y = y + 1e-3 * np.ptp(y) * np.random.default_rng(0).standard_normal(u.size)
    found = hyst.identify(hyst.Record(u, y, 1e-3), family="mpi", plays=4, knots=12)
    assert found.delay <= most
