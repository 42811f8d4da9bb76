"""A sensor at its end is told from plays, stops, switches and saturating materials."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from faulty_records import NOISE, case_record, diagnosed, good, only, record
from healthy_records import drives, plants, preisach, triangle_wave

import hyst

NAME = "saturated sensor"


def test_case(measured_data: Path) -> None:
    given = case_record(measured_data, "clipped-sensor")
    finding = only(diagnosed(given), NAME)
    assert finding.severity == "left out"
    assert finding.samples.tolist() == np.flatnonzero(given.y == 48.0).tolist()
    assert finding.amounts["level"] == 48.0
    # The output stands from 72.8 V on, and the input goes on to 100 V.
    assert finding.amounts["moved"] == pytest.approx(27.2, abs=1e-9)
    assert "stands at 48 um for 652 samples while the input moves by up to 27.2 V" in (
        finding.sentence
    )
    assert "extrapolation" in finding.advice


@pytest.mark.parametrize("drive", ["triangle", "sine", "multisine", "shrinking"])
@pytest.mark.parametrize("plant", ["plays", "line", "stiffening"])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_end_of_other_plants(drive: str, plant: str, sign: float) -> None:
    u = drives()[drive]
    true = sign * plants()[plant](u)
    # Between two samples, for periods repeat up to rounding only.
    level = float(np.quantile(true, 0.88) - 1e-6 * np.ptp(true))
    y = np.minimum(true, level)
    finding = only(diagnosed(record(u, y)), NAME)
    assert finding.samples.tolist() == np.flatnonzero(true >= level).tolist()
    assert finding.amounts["level"] == level
    assert "upper end" in finding.sentence


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_noise_of_the_converter_on_the_level(seed: int) -> None:
    u, _ = good(period=1333.3)
    true = plants()["plays"](u)
    y = np.minimum(true, 48.0) + np.random.default_rng(seed).normal(0.0, NOISE, u.size)
    finding = only(diagnosed(record(u, y)), NAME)
    # Within one standard error of 1000 samples, thrice, and the rounding of the corner.
    assert finding.amounts["level"] == pytest.approx(48.0, abs=0.2 * NOISE)
    beyond = np.flatnonzero(true > 48.0)
    assert np.isin(beyond, finding.samples).mean() > 0.99
    # What is taken besides lies within the band of 4.5 deviations below the level.
    assert true[finding.samples].min() > 48.0 - 9.5 * NOISE


def test_both_ends() -> None:
    u, y = good(kind="sine")
    found = diagnosed(record(u, np.clip(y, 15.0, 50.0)))
    assert [each.amounts["level"] for each in found.named(NAME)] == [50.0, 15.0]
    assert found.left_out(1).tolist() == np.flatnonzero((y <= 15.0) | (y >= 50.0)).tolist()


def test_at_zero_it_may_be_a_dead_zone() -> None:
    u, y = good()
    found = diagnosed(record(u, np.maximum(y - 20.0, 0.0)))
    finding = only(found, NAME)
    assert finding.severity == "warning"
    assert "dead zone" in finding.sentence
    assert found.left_out(1).size == 0


def stop(u: np.ndarray) -> np.ndarray:
    return hyst.Stop(8.0)(u)


def play(u: np.ndarray) -> np.ndarray:
    return hyst.Play(30.0)(u)


def delayed_play(u: np.ndarray) -> np.ndarray:
    return np.concatenate((np.zeros(7), hyst.Play(12.0)(u)[:-7]))


def saturating(u: np.ndarray) -> np.ndarray:
    return 30.0 * np.tanh(hyst.Play(10.0)(u) / 12.0)


@pytest.mark.parametrize("plant", [stop, play, delayed_play, saturating, preisach, np.sign])
@pytest.mark.parametrize("noise", [0.0, 1e-3, 4e-3])
@pytest.mark.parametrize("period", [1333.3, 120.7])
def test_plants_that_stand_by_themselves(plant: object, noise: float, period: float) -> None:
    u = triangle_wave(4000, period, 50.0)
    true = plant(u)  # type: ignore[operator]
    y = true + np.random.default_rng(1).normal(0.0, noise * np.ptp(true) + 1e-300, u.size)
    found = diagnosed(record(u, y))
    assert not found.named(NAME), found.summary()
