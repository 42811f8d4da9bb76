"""Standard errors against the textbook formula, a direct sum and simulation."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from scipy.signal import lfilter

from hyst.identification.fit.block import Block, blocks_of
from hyst.identification.result.covariance import BartlettSum, ScoreSums, robust_covariance


def test_white_residuals_give_the_textbook_covariance() -> None:
    rng = np.random.default_rng(0)
    jacobian = rng.normal(size=(200_000, 3)) * [1.0, 10.0, 1e-3]
    residual = 0.3 * rng.normal(size=200_000)
    expected = 0.09 * np.linalg.inv(jacobian.T @ jacobian)
    found = robust_covariance(jacobian, residual, [200_000])
    # 2e5 samples know a variance to sqrt(2 / 2e5) = 0.3 %, kurtosis and lags add to it.
    np.testing.assert_allclose(np.sqrt(np.diag(found)), np.sqrt(np.diag(expected)), rtol=0.02)


def test_window_sums_equal_the_sum_over_lags() -> None:
    scores = np.random.default_rng(1).normal(size=(50, 2))
    bandwidth = 7
    direct = scores.T @ scores
    for lag in range(1, bandwidth):
        gamma = scores[lag:].T @ scores[:-lag]
        direct += (1.0 - lag / bandwidth) * (gamma + gamma.T)
    summed = BartlettSum(bandwidth, 2)
    for first, last in ((0, 20), (20, 23), (23, 50)):  # blocks, one shorter than the window
        summed.add(0, scores[first:last])
    np.testing.assert_allclose(summed.total(), direct, rtol=1e-12)


def test_blocks_give_the_sums_of_the_whole() -> None:
    rng = np.random.default_rng(3)
    jacobian = rng.normal(size=(500, 3)) * [1.0, 1e200, 1e-200]
    residual = 1e-180 * lfilter([1.0], [1.0, -0.9], rng.normal(size=500))
    ends = [0, 90, 200, 203, 500]
    pieces = [
        Block(int(first >= 200), slice(first, last), jacobian[first:last])
        for first, last in itertools.pairwise(ends)
    ]
    whole = ScoreSums.of(lambda: blocks_of(jacobian, [200, 300]), residual, [200, 300])
    parts = ScoreSums.of(lambda: pieces, residual, [200, 300])
    np.testing.assert_allclose(parts.gram, whole.gram, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(parts.middle, whole.middle, rtol=1e-12, atol=1e-12)
    assert np.isfinite(whole.covariance()).all()


@pytest.mark.parametrize("rho", [0.0, 0.8])
def test_claimed_errors_match_the_scatter_of_estimates(rho: float) -> None:
    """Least squares estimates of a slow regressor with autocorrelated noise scatter as claimed."""
    rng = np.random.default_rng(2)
    samples, runs = 2000, 300
    jacobian = np.column_stack([np.ones(samples), np.sin(np.arange(samples) / 50.0)])
    solve = np.linalg.pinv(jacobian)
    estimates, claimed = [], []
    for _ in range(runs):
        noise = lfilter([1.0], [1.0, -rho], rng.normal(size=samples))
        theta = solve @ noise
        estimates.append(theta)
        covariance = robust_covariance(jacobian, noise - jacobian @ theta, [samples])
        claimed.append(np.sqrt(np.diag(covariance)))
    ratio = np.mean(claimed, axis=0) / np.std(estimates, axis=0)
    # 300 runs know a standard deviation to 4 %; a Bartlett window is biased low by several percent.
    assert (ratio > 0.8).all()
    assert (ratio < 1.15).all()


def test_the_order_of_records_does_not_matter() -> None:
    """It would, if correlation reached from the end of one record to the start of the next."""
    rng = np.random.default_rng(4)
    jacobian, residual = rng.normal(size=(90, 2)), lfilter([1.0], [1.0, -0.9], rng.normal(size=90))
    ours = robust_covariance(jacobian, residual, [30, 60])
    swapped = np.r_[30:90, 0:30]
    other = robust_covariance(jacobian[swapped], residual[swapped], [60, 30])
    np.testing.assert_allclose(ours, other, rtol=1e-9)
