"""Outliers are named one by one, and nothing beside them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from faulty_records import NOISE, case_record, diagnosed, good, only, record
from healthy_records import dynamic, preisach, triangle_wave, with_noise


def test_case(measured_data: Path) -> None:
    finding = only(diagnosed(case_record(measured_data, "spikes")), "outliers")
    assert finding.severity == "left out"
    assert finding.samples.tolist() == [457, 1147, 1686, 2412, 2670, 3110, 3480, 3844]
    # They were put in with 20 um; the line between two neighbours has their noise.
    assert finding.amounts["largest"] == pytest.approx(20.0, abs=5 * NOISE)


@pytest.mark.parametrize("kind", ["triangle", "sine"])
@pytest.mark.parametrize("size", [3.0, 20.0, 400.0])
@pytest.mark.parametrize("length", [1, 2, 3])
def test_outliers_of_any_size_and_length(kind: str, size: float, length: int) -> None:
    u, y = good(seed=2, kind=kind)
    places = np.array([333, 871, 1500, 2222, 3001, 3690])
    signs = np.array([1, -1, -1, 1, 1, -1])
    for place, sign in zip(places, signs, strict=True):
        y[place : place + length] += sign * size
    finding = only(diagnosed(record(u, y)), "outliers")
    assert finding.severity == "left out"
    expected = (places[:, None] + np.arange(length)).ravel()
    assert finding.samples.tolist() == expected.tolist()


@pytest.mark.parametrize("plant", [preisach, dynamic])
def test_other_plants(plant: object) -> None:
    u = triangle_wave(4000, 900.0, 50.0)
    y = with_noise(plant(u), 0.003)  # type: ignore[operator]
    places = [300, 1111, 2025, 3456]
    y[places] += 0.4 * np.ptp(y)
    finding = only(diagnosed(record(u, y)), "outliers")
    assert finding.samples.tolist() == places


def test_no_noise_and_quantised() -> None:
    u, y = good()
    y = np.round(y, 1)
    y[[400, 1600]] -= 7.0
    assert only(diagnosed(record(u, y)), "outliers").samples.tolist() == [400, 1600]


def test_so_many_are_not_left_out() -> None:
    u, y = good()
    y[20::25] += 15.0
    finding = only(diagnosed(record(u, y)), "outliers")
    assert finding.severity == "warning"
    assert finding.samples.size > 100


def test_outliers_of_the_input_are_a_warning() -> None:
    u, y = good()
    u = u.copy()
    u[[700, 2100]] += 30.0
    finding = only(diagnosed(record(u, y)), "outliers")
    assert finding.severity == "warning"
    assert finding.samples.tolist() == [700, 2100]
    assert "input" in finding.sentence


def test_an_answer_to_the_input_is_none() -> None:
    u, _ = good()
    u[[700, 2100]] += 30.0  # commanded
    y = 0.6 * u
    found = diagnosed(record(u, y))
    assert found.left_out(1).size == 0
