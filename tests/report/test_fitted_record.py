"""Figures show the errors that the tables count, whatever the delay."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst.report.fitted_record import fit_records

STAGE = hyst.PrandtlIshlinskii([0.5, 0.3], [0.4, 1.1], p0=1.0)


@pytest.mark.parametrize("delay", [-10, -2.5, 0, 1.4, 3])
def test_errors_drawn_are_those_counted(delay: float) -> None:
    k = np.arange(1500.0)

    def drive(at: np.ndarray) -> np.ndarray:
        return 3.0 * np.sin(2.0 * np.pi * at / 250.0) * np.exp(-at / 2000.0)

    noise = np.random.default_rng(2).normal(0.0, 0.01, k.size)
    record = hyst.Record(drive(k), STAGE(drive(k - delay)) + noise, 0.01)
    found = hyst.identify(record, family="pi", plays=2, delay=delay, drift=False)
    (shown,), (kept,) = fit_records(found, (record,), (record,))
    counted = found.metrics["training"]
    # The same sums in another order.
    assert np.sqrt(np.mean(shown.error**2)) == pytest.approx(counted.rms, rel=1e-12)
    assert shown.error.size == shown.model_input.size == counted.samples
    # At either end of the record there is no input, or no output, for as many samples.
    assert (kept.start, kept.stop) == (
        max(int(np.ceil(delay)), 0),
        1500 + min(int(np.floor(delay)), 0),
    )
    # Noise of 0.01 within 10 %, of 1300 samples or more: the model is aligned with the record.
    assert counted.rms == pytest.approx(0.01, rel=0.1)
