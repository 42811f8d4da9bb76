"""A delay that is given is the delay of the dynamics, also where another would do better."""

from __future__ import annotations

import numpy as np

import hyst
from hyst.identification.families.hammerstein.start.settled_dynamics import settled_dynamics
from hyst.identification.record_use.used_samples import prepare

DT, W = 1e-4, 2 * np.pi * 200


def test_a_given_delay_is_kept_where_dynamics_have_no_feedthrough() -> None:
    plays = hyst.PrandtlIshlinskii([0.2], [2.0], 0.6)
    G = hyst.models.LinearDynamics.from_continuous([W**2], [1.0, 0.06 * W, W**2], DT, delay=3)
    u = hyst.signals.multisine(DT, 2400, band=(1.0, 1000.0), amplitude=10.0, seed=3).u
    y = (G @ plays)(u)
    record = hyst.Record(u, y + 0.01 * y.std() * np.random.default_rng(1).normal(size=y.size), DT)

    # Without feedthrough, one sample less than the delay that is given, there is one number fewer.
    settled = settled_dynamics(prepare(record, "auto"), plays, G, delay=4)

    assert settled.best.dynamics.delay == 4
    assert {each.delay for each in settled.near} <= {4}
