"""An output far from 0 is the same actuator: its offset must not disturb what is found of it."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import hyst

DT, W = 1e-4, 2 * np.pi * 200
PLAYS = hyst.PrandtlIshlinskii([0.2, 0.1], [1.0, 4.0], 0.6)
DYNAMICS = hyst.models.LinearDynamics.from_continuous([W**2], [1.0, 0.06 * W, W**2], DT, delay=3)


@pytest.mark.parametrize("offset", [-30.0, 2e4, 1e6])
def test_an_offset_of_the_output_changes_nothing_but_the_offset(offset: float) -> None:
    u = hyst.signals.multisine(DT, 3000, band=(1.0, 1000.0), amplitude=10.0, seed=3).u
    y = (DYNAMICS @ PLAYS)(u)
    noise = 0.01 * y.std() * np.random.default_rng(1).normal(size=y.size)

    found = hyst.identify(
        hyst.Record(u, y + noise + offset, DT),
        family="hammerstein",
        hysteresis="pi",
        plays=2,
        state_order=2,
    )

    # Ten times the standard errors of a fit without an offset, 0.003 Hz and 2e-5.
    assert found.dynamics.delay == 3
    assert found.resonances[0].frequency == pytest.approx(200.0, abs=0.03)
    assert found.resonances[0].damping == pytest.approx(0.03, abs=2e-4)
    # The noise's own power over 3000 samples is known to 2.6 % (two deviations).
    assert found.noise_rms == pytest.approx(noise.std(), rel=0.05)
    settled = found.hysteresis(u) - PLAYS(u) - offset
    # A hundredth of the output's range, 26; what the start had without it lies beyond.
    assert np.abs(settled).max() < 0.26


def test_what_a_wrong_model_leaves_is_told_in_percent_of_the_record_wherever_it_lies() -> None:
    u = hyst.signals.multisine(DT, 3000, band=(1.0, 1000.0), amplitude=10.0, seed=3).u
    y = PLAYS(hyst.models.LinearDynamics(DYNAMICS.A, DYNAMICS.B, DYNAMICS.C, 0.0, DT)(u))
    record = hyst.Record(u, y + 0.01 * y.std() * np.random.default_rng(1).normal(size=y.size), DT)

    def judged(offset: float) -> hyst.identification.Identified:
        at_offset = hyst.Record(record.u, record.y + offset, DT)
        options = {"family": "hammerstein", "hysteresis": "pi", "plays": 2, "state_order": 2}
        return hyst.identify(at_offset, validation=at_offset, **options)

    near, far = judged(0.0), judged(2e4)

    # Dynamics before the hysteresis: no model of this family is good, near 0 or far from it.
    assert near.verdict.level != "good"
    assert far.verdict.level != "good"
    for name in ("training", "validation"):
        # Two fits of a wrong structure that stop at slightly different places.
        assert far.metrics[name].rms_percent == pytest.approx(
            near.metrics[name].rms_percent, rel=0.1
        )
    assert far.description.output_low == pytest.approx(near.description.output_low + 2e4, abs=1.0)


def test_a_result_is_pickled() -> None:
    u = hyst.signals.multisine(DT, 1500, band=(1.0, 1000.0), amplitude=10.0, seed=3).u
    y = (DYNAMICS @ PLAYS)(u)
    found = hyst.identify(
        hyst.Record(u, y, DT), family="hammerstein", hysteresis="pi", plays=2, state_order=2
    )

    again = pickle.loads(pickle.dumps(found))

    assert np.array_equal(again.model(u), found.model(u))
