"""A drive that is one sine shows no resonance at its own frequency."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst.identification.families.hammerstein.told.drive_band import drive_band
from hyst.models import LinearDynamics

DT = 5e-3
T = DT * np.arange(4000)
UNITY = LinearDynamics.from_continuous([1.0], [1e-3, 1.0], DT)


def triangle(frequency: float) -> np.ndarray:
    return 2.0 / np.pi * np.arcsin(np.sin(2.0 * np.pi * frequency * T))


@pytest.mark.parametrize(
    ("drives", "only"),
    [
        ([1e-9 * np.sin(2.0 * np.pi * 1.0 * T + 0.4)], 1.0),
        ([3.0 + np.sin(2.0 * np.pi * 2.7 * T), 0.1 * np.cos(2.0 * np.pi * 2.7 * T)], 2.7),
        ([np.sin(2.0 * np.pi * 1.0 * T), np.sin(2.0 * np.pi * 4.0 * T)], np.nan),
        ([np.sin(2.0 * np.pi * T) + 0.1 * np.sin(2.0 * np.pi * 7.0 * T)], np.nan),
        ([np.sin(2.0 * np.pi * 1.0 * T), triangle(1.0)], np.nan),
        ([triangle(1.0)], np.nan),
        ([np.sin(2.0 * np.pi * T * T)], np.nan),
        ([np.sin(2.0 * np.pi * 1.0 * T) * (1.0 + 0.3 * np.sin(2.0 * np.pi * 0.3 * T))], np.nan),
    ],
)
def test_a_drive_of_one_sine_is_told_from_others(drives: list[np.ndarray], only: float) -> None:
    records = [hyst.Record(u, u, DT) for u in drives]

    found = drive_band(records, UNITY, 1.0, 1e-3).only_line

    # To a bin of the spectrum, 0.05 Hz.
    assert found == pytest.approx(only, abs=0.05, nan_ok=True)


@pytest.mark.parametrize("plays", [1, 2])
def test_what_one_sine_cannot_show_is_told_of_every_resonance(plays: int) -> None:
    # A static actuator with bent branches: harmonics of one sine let resonances make up for them.
    u = 2.0 - 1.8 * np.cos(2.0 * np.pi * T)
    y = hyst.PrandtlIshlinskii([0.2, 0.2, 0.2], [0.3, 0.8, 1.4], 1.0)(u - 2.0)
    y = np.tanh(0.4 * y) + 0.004 * np.random.default_rng(0).normal(size=y.size)

    found = hyst.identify(
        hyst.Record(u, y, DT), family="hammerstein", hysteresis="pi", plays=plays, state_order=2
    )

    assert found.resonances
    assert not any(each.is_determined for each in found.resonances), found.resonances
    assert found.verdict.level != "good"
