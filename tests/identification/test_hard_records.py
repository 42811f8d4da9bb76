"""Records at the edge: very short ones, one without noise, one around a large mean."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_records import TRUE_PI, drive, record

import hyst


@pytest.mark.parametrize("samples", [16, 20, 26, 32])
@pytest.mark.parametrize("seed", [1, 2])
def test_auto_never_takes_more_parameters_than_a_short_record_can_judge(
    samples: int, seed: int
) -> None:
    random = np.random.default_rng(seed)
    u = np.sin(2.0 * np.pi * np.arange(samples) / 7.3)
    y = u + 0.3 * np.cos(np.arange(samples)) + 0.05 * random.standard_normal(samples)
    found = hyst.identify(hyst.Record(u, y, dt=1.0), delay=0)
    used = found.used[0].stop - found.used[0].start
    assert max(each.parameters for each in found.candidates) < used
    assert found.model.traits().invertible


def test_every_combination_that_is_not_determined_is_named() -> None:
    """Five points visited again and again determine far fewer than the 16 parameters."""
    u = 5.0 * np.sin(2.0 * np.pi * np.arange(60) / 5.0)
    y = 2.0 * u + np.cos(2.0 * np.pi * np.arange(60) / 5.0)
    found = hyst.identify(hyst.Record(u, y, dt=1.0), family="mpi", plays=4, delay=0)
    assert found.undetermined
    assert not (found.standard_errors < 0.0).any()


def test_auto_takes_the_simplest_of_models_that_are_exact_to_rounding() -> None:
    """Without noise all rich families fit to rounding, which is no reason for the richest."""
    found = hyst.identify(record(TRUE_PI))
    assert found.family == "pi"
    assert len([name for name in found.parameter_names if ".p[" in name]) == 3


def test_an_input_that_varies_little_around_a_large_mean() -> None:
    """Raw counts of a converter; the bias is 1e5 times the amplitude."""
    u = drive()
    given = hyst.Record(
        u + 1e5, TRUE_PI(u) + 0.01 * np.random.default_rng(0).normal(size=u.size), 1.0
    )
    found = hyst.identify(given, family="pi", plays=3, delay=0)
    # The noise is all that is left: its root mean square, within the scatter of 3000 samples.
    assert found.metrics["training"].rms == pytest.approx(0.01, rel=0.05)
