"""Codes of instruments and loggers are told from measurements by their distance alone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from faulty_records import case_record, diagnosed, good, only, record

import hyst
from hyst.diagnosis.values.codes import codes_in

NAME = "code for no measurement"


@pytest.mark.parametrize(
    ("case", "code", "samples", "words"),
    [
        ("scpi-nan", 9.91e37, [240, 241, 242, 243], "not a number"),
        ("scpi-overload", 9.9e37, [240], "overload"),
        ("sentinel-9999", -9999.0, [240, 241, 242, 243], "missing value"),
    ],
)
def test_cases(measured_data: Path, case: str, code: float, samples: list[int], words: str) -> None:
    given = case_record(measured_data, case)
    finding = only(diagnosed(given), NAME)
    assert finding.severity == "left out"
    assert finding.samples.tolist() == samples
    assert finding.amounts["value"] == code
    assert words in finding.sentence
    assert f"{code:.7g}" in finding.sentence
    assert hyst.diagnose(given).left_out(1).tolist() == samples


@pytest.mark.parametrize(
    "code", [9.9e37, -9.9e37, 1e38, 3.4028235e38, 1.7e308, 1e20, 9.96921e36, -9999, 99999, -999]
)
def test_codes_anywhere_in_the_output(code: float) -> None:
    u, y = good(seed=3)
    places = np.sort(np.random.default_rng(7).choice(y.size, 30, replace=False))
    y[places] = code
    found = diagnosed(record(u, y))
    finding = only(found, NAME)
    assert finding.severity == "left out"
    assert found.left_out(1).tolist() == places.tolist()


def test_several_codes_and_those_of_the_input() -> None:
    u, y = good()
    y[[5, 9]], y[100], y[3000:3004] = 9.91e37, -9.9e37, -9999.0
    assert [each.value for each in codes_in(y)] == [-9.9e37, -9999.0, 9.91e37]
    assert [each.samples.tolist() for each in codes_in(y)] == [
        [100],
        [3000, 3001, 3002, 3003],
        [5, 9],
    ]
    u[77] = 9.91e37
    found = diagnosed(record(u, y))
    (refusal,) = found.of("refusal")
    assert (refusal.name, refusal.samples.tolist()) == (NAME, [77])
    assert "input" in refusal.sentence


def test_many_codes_refuse_the_record() -> None:
    u, y = good()
    y[1000:1400] = 9.9e37
    assert diagnosed(record(u, y)).of("refusal")[0].name == NAME


@pytest.mark.parametrize("share", [0.001, 0.1, 0.3, 0.6, 0.85])
@pytest.mark.parametrize("code", [9.91e37, -9.9e37, 3.4028235e38])
@pytest.mark.parametrize("unit", [2.0**-30, 1.0, 2.0**20])
def test_no_share_hides_what_no_signal_can_stand_beside(
    share: float, code: float, unit: float
) -> None:
    _, y = good()
    y *= unit
    places = np.random.default_rng(5).choice(y.size, int(share * y.size), replace=False)
    y[places] = code
    (found,) = codes_in(y)
    assert (found.value, found.samples.tolist()) == (code, sorted(places.tolist()))


def test_levels_of_a_quiet_generator_are_none() -> None:
    rng = np.random.default_rng(2)
    levels = np.arange(1000) // 10 % 2
    assert codes_in(levels + 1e-12 * rng.standard_normal(1000)) == ()
    assert codes_in(np.where(levels == 1, 1.0, 1e-20 * rng.standard_normal(1000))) == ()


def test_the_record_is_named() -> None:
    u, y = good()
    first = record(u, y)
    second = y.copy()
    second[8] = -1e30
    found = diagnosed(first, record(u, second))
    finding = only(found, NAME)
    assert finding.record == 2
    assert "the output of record 2" in finding.sentence
    assert found.left_out(1).size == 0
    assert found.left_out(2).tolist() == [8]


def test_values_near_the_others_are_none() -> None:
    u, y = good()
    assert codes_in(y) == ()
    y[50] = y.max() + 9.0 * np.ptp(y)  # an outlier, and found as one
    assert codes_in(y) == ()
    assert only(diagnosed(record(u, y)), "outliers").samples.tolist() == [50]


@pytest.mark.parametrize("signal", [[1.0], [0.0, 1e38], [2.0] * 50, [0.0] * 30 + [1.0] * 30])
def test_short_and_still_signals_have_none(signal: list[float]) -> None:
    assert codes_in(np.array(signal)) == ()
