"""`hyst.fit` finds the constants of materials beside dynamics, creep and maps."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst import Operator

DT = 1e-3
U = np.sin(np.arange(4000) / 90.0) * np.linspace(1.0, 0.3, 4000)
NOISE = 1e-4
"""Of the output's range."""

RESONANCE = hyst.LinearDynamics.from_transfer_function([0.2, 0.1], [1.0, -1.4, 0.7], DT)
PIEZO = hyst.BoucWen(0.6, 0.35, 1.2, 0.6, h=-1.0)
COMPOSITIONS = {
    "before a resonance": RESONANCE @ PIEZO,
    "before creep": hyst.Creep([0.03, 0.02], [0.05, 0.8], DT) @ PIEZO,
    "before a map": hyst.DeadZone([1.0, 0.2], [0.0, 0.2]) @ hyst.ColemanHodgdon(2.0, 1.5, 1.1),
    "springs before a resonance": RESONANCE @ hyst.MaxwellSlip([3.0, 1.0], [0.36, 0.41], 0.5),
}


@pytest.mark.parametrize("true", COMPOSITIONS.values(), ids=COMPOSITIONS)
def test_a_composition_comes_back_from_constants_five_percent_off(true: Operator) -> None:
    """The dynamics are known, all else is free."""
    constants = true.parameters()
    free = [name for name in constants.names if "linear" not in name]
    off = 1.0 + 0.05 * np.cos(np.arange(len(constants)))
    known = np.array(["linear" in name for name in constants.names])
    start = true.with_parameters(constants.values * np.where(known, 1.0, off))
    y = true(U)
    sigma = NOISE * np.ptp(y)
    record = hyst.Record(U, y + sigma * np.random.default_rng(0).normal(size=U.size), DT)
    found = hyst.fit(start, record, free=free)
    assert found.verdict.level == "good"
    # A dozen constants from 4000 samples leave some 5 % of the noise; it is never as large.
    assert np.abs(found.model(U) - y).max() < sigma
    assert np.abs(start(U) - y).max() > 30.0 * sigma
