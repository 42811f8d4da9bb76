"""Dynamics that broadband drives show, and hysteresis that is none."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import cont2discrete, lfilter
from simulated_actuators import (
    DT,
    Actuator,
    bent,
    friction,
    plays,
    record,
    switching,
    warned,
)

import hyst

MULTISINE = hyst.signals.multisine(DT, 2000, amplitude=50.0, band=(1.0, 200.0), periods=3, seed=2).u
CHIRP = 50.0 * np.sin(2.0 * np.pi * np.cumsum(np.geomspace(0.5, 40.0, 8000)) * DT)


@pytest.mark.parametrize("frequency", [50.0, 80.0, 120.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_resonance_has_its_frequency(frequency: float, sign: float) -> None:
    w = 2.0 * np.pi * frequency
    b, a, _ = cont2discrete(([w * w], [1.0, 0.1 * w, w * w]), DT)
    y = sign * lfilter(b.ravel(), a, plays(MULTISINE))
    (found,) = hyst.diagnose(record(MULTISINE, y, 0.05)).named("dynamics")
    # Bands are 6 % wide.
    assert found.amounts["resonance"] == pytest.approx(frequency, rel=0.06)
    assert found.amounts["phase"] > 90.0
    assert "hammerstein" in found.advice


def test_low_pass_under_a_sweep() -> None:
    keep = np.exp(-2.0 * np.pi * 10.0 * DT)
    y = lfilter([1.0 - keep], [1.0, -keep], plays(CHIRP))
    (found,) = hyst.diagnose(record(CHIRP, y, 0.05)).named("dynamics")
    # A pole at 10 Hz turns 30 Hz and more by 72 degrees and 0.5 Hz by 3.
    assert found.amounts["phase"] == pytest.approx(65.0, abs=15.0)
    assert "resonance" not in found.amounts


@pytest.mark.parametrize("actuator", [plays, bent, switching, friction])
@pytest.mark.parametrize("u", [MULTISINE, CHIRP], ids=["multisine", "sweep"])
def test_hysteresis_alone_is_no_dynamics(actuator: Actuator, u: np.ndarray) -> None:
    assert "dynamics" not in warned(record(u, actuator(u), 0.02))
