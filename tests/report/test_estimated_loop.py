"""The band drawn around the estimated loop."""

from __future__ import annotations

import numpy as np

from hyst.report.dynamics_figures import branch_band


def test_the_band_holds_mean_and_scatter_of_each_bin() -> None:
    rng = np.random.default_rng(0)
    u = rng.uniform(-1.0, 1.0, 40_000)
    centres, mean, deviation = branch_band(u, 3.0 * u + 0.5 * rng.normal(size=u.size))
    # A thousand samples a bin: a mean is known to 0.016, a deviation to 0.011; four times that.
    assert np.abs(mean - 3.0 * centres).max() < 0.064
    # The slope within a bin of width 0.05 adds a thousandth to 0.5.
    assert np.abs(deviation - 0.5).max() < 0.045


def test_bins_with_few_samples_are_left_out() -> None:
    u = np.concatenate([np.full(20, 0.0), np.full(20, 1.0), [0.5]])
    centres, mean, _ = branch_band(u, np.where(u == 0.5, 1e9, u))
    assert mean.tolist() == [0.0, 1.0]
    assert branch_band(np.empty(0), np.empty(0))[0].size == 0
    assert centres.size == 2
