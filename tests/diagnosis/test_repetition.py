"""The noise of an output by what it does not repeat."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_actuators import (
    DT,
    NESTED,
    Array,
    bent,
    plays,
    record,
    sine,
    switching,
    through,
    triangle,
)

import hyst
from hyst.diagnosis.drive_period import drive_period
from hyst.diagnosis.memory_branches import remembering_branches
from hyst.diagnosis.repetition import noise_by_repetition, repetition_of


@pytest.mark.parametrize("period", [500.0, 1000.0 / 3.0, 777.7, 62.5])
@pytest.mark.parametrize("drive", [triangle, sine])
def test_period_need_not_be_whole(drive: object, period: float) -> None:
    found = drive_period(drive(period, 4000))  # type: ignore[operator]
    # A corner or a crest between samples shifts the vertex by some thousandths of a sample.
    assert found == pytest.approx(period, abs=0.02)


def test_period_of_a_noisy_drive_and_of_a_late_start() -> None:
    u = np.concatenate([np.zeros(300), triangle(400.5, 4000)])
    u = u + 0.5 * np.random.default_rng(3).standard_normal(u.size)
    assert drive_period(u) == pytest.approx(400.5, abs=0.1)


@pytest.mark.parametrize(
    "u",
    [
        hyst.signals.decaying_triangle(DT, 50.0, 200.0, cycles=10).u,
        hyst.signals.decaying_triangle(DT, 50.0, 200.0, cycles=10, decay=0.95).u,
        hyst.signals.multisine(DT, 3000, amplitude=1.0, band=(1.0, 100.0)).u,
        np.cumsum(np.random.default_rng(2).standard_normal(4000)),
        np.random.default_rng(2).standard_normal(4000),
        np.linspace(0.0, 1.0, 4000),
        np.sin(6e-7 * np.arange(8000) ** 2),
    ],
    ids=["decay", "slow decay", "one multisine", "walk", "noise", "ramp", "chirp"],
)
def test_drives_that_do_not_repeat_have_no_noise_by_repetition(u: Array) -> None:
    found = repetition_of(u)
    # A walk may come back to a level by chance; it does so for a few samples only.
    assert found is None or found.samples < 0.05 * u.size
    assert found is None or found.period == 0.0


@pytest.mark.parametrize("sigma", [0.02, 0.5, 3.0])
@pytest.mark.parametrize(
    "u",
    [triangle(), triangle(1000.0 / 3.0), sine(400.7), triangle(1000.0, 2001), through(NESTED)],
    ids=["triangle", "333.33", "sine", "two cycles", "nested"],
)
def test_noise_is_what_was_added(u: Array, sigma: float) -> None:
    found = noise_by_repetition(record(u, bent(u), sigma, seed=7))
    # 500 changes at least tell a standard deviation to 3 %; three times that, and the 0.005 that
    # interpolated corners add.
    assert found == pytest.approx(sigma, rel=0.1, abs=0.005)


def test_drift_is_no_noise() -> None:
    u = triangle()
    t = np.arange(u.size) * DT
    drifting = plays(u) + 1.5 * t + np.log10(1.0 + t / 0.1)
    assert noise_by_repetition(record(u, drifting, 0.05)) == pytest.approx(0.05, rel=0.1)


def test_spikes_and_a_quantised_output() -> None:
    u = sine(400.0)
    y = switching(u) + 0.02 * np.random.default_rng(1).standard_normal(u.size)
    y[[700, 1900, 2500]] += 9.0
    # Six changes of 3500 hold a spike; those left out are 1 % of all.
    assert noise_by_repetition(record(u, y)) == pytest.approx(0.02, rel=0.1)
    assert noise_by_repetition(record(u, np.round(plays(u)))) == pytest.approx(0.0, abs=1e-9)


def test_nothing_to_compare_is_none() -> None:
    u = through([0.0, 100.0, 0.0])
    assert noise_by_repetition(record(u, plays(u))) is None
    assert noise_by_repetition(hyst.Record(np.zeros(50), np.zeros(50), DT)) is None


def test_levels_are_remembered_until_they_are_reached_again() -> None:
    u = through([0.0, 100, 0, 60, 20, 40, 0, 100, 0], 50)
    remembered = [levels for _, _, levels in remembering_branches(u)]
    # By hand, after Madelung: 40 -> 0 wipes 20 and 40 (and 60 is inside 100 to 0), and 100 all.
    assert remembered == [
        (100.0,),
        (100.0, 0.0),
        (100.0, 0.0, 60.0),
        (100.0, 0.0, 60.0, 20.0),
        (100.0, 0.0, 60.0, 20.0, 40.0),
        (100.0, 0.0),
        (100.0,),
    ]
