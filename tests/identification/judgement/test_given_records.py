"""Records that engineers sent, and measured ones: the verdict is the one their files call right."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hyst
from hyst.io import read_record
from hyst.operators import Verdict
from reference.judged_as_given import judged_as_given

PLAYS = hyst.families.PrandtlIshlinskii(plays=3)


@pytest.fixture(scope="module")
def cases(measured_data: Path) -> Path:
    folder = measured_data.parent / "cases"
    if not folder.is_dir():
        pytest.skip(f"records of users are not at {folder}")
    return folder


def case(cases: Path, name: str, file: str = "loop.csv", **columns: Any) -> hyst.Record:
    return read_record(cases / name / file, **({"input": 1, "output": 2, "time": 0} | columns))


def verdict_on(
    records: hyst.Record | list[hyst.Record], family: str = "pi", **options: Any
) -> Verdict:
    if family == "pi":
        options = {"plays": 3} | options
    return hyst.identify(records, family=family, **options).verdict


def test_a_butterfly_is_unfit_with_its_name(cases: Path) -> None:
    for family in ("linear", "gpi"):
        verdict = verdict_on(case(cases, "butterfly"), family=family)
        assert verdict.level == "unfit"
        assert "butterfly" in verdict.sentences[0]


def test_a_bouc_wen_stage_has_loops_of_another_shape(cases: Path) -> None:
    verdict = verdict_on(case(cases, "bouc-wen"), delay=0)
    assert verdict.level == "fair"
    assert "do not close or bend" in verdict.sentences[1]


def test_hum_of_the_mains_is_named(cases: Path) -> None:
    verdict = verdict_on(case(cases, "mains-hum"), delay=0, drift=False)
    assert verdict.level == "fair"
    assert "a sine of 50 Hz (the mains) and amplitude " in verdict.sentences[1]
    amplitude = float(verdict.sentences[1].split("amplitude ")[1].split(" um")[0])
    assert amplitude == pytest.approx(0.8, rel=0.02)


def test_hum_is_taken_out_and_told(cases: Path) -> None:
    found = hyst.identify(case(cases, "mains-hum"), family="pi", plays=3, delay=0)
    assert found.verdict.level == "fair"
    assert "a sine of 50 Hz with an amplitude of " in found.verdict.sentences[0]
    assert "taken out before the fit" in found.verdict.sentences[0]
    amplitude = float(found.verdict.sentences[0].split("amplitude of ")[1].split(" um")[0])
    assert amplitude == pytest.approx(0.8, rel=0.02)
    assert found.metrics["training"].rms < 0.03  # noise of 0.02 um was simulated


def test_drift_is_told_by_the_second(cases: Path) -> None:
    verdict = verdict_on(case(cases, "thermal-drift"), delay=0, drift=False)
    assert verdict.level == "fair"
    assert "drifts by 1.5 um/s" in verdict.sentences[1]


def test_drift_is_taken_out_and_told(cases: Path) -> None:
    found = hyst.identify(case(cases, "thermal-drift"), family="pi", plays=3, delay=0)
    assert found.verdict.level == "fair"
    assert "drifts by 1.5 um/s" in found.verdict.sentences[0]
    assert "taken out before the fit" in found.verdict.sentences[0]
    assert found.metrics["training"].rms < 0.03  # noise of 0.02 um was simulated


def test_a_noisy_sensor_is_no_fault_of_the_model(cases: Path) -> None:
    assert verdict_on(case(cases, "noise-lag"), delay=0).level == "good"


def test_minor_loops_that_were_not_determined_are_told(cases: Path) -> None:
    columns: dict[str, Any] = {"input": "u", "output": "y", "time": None, "rate": 100}
    major = case(cases, "minor-loops-from-major", "major.csv", **columns)
    minor = case(cases, "minor-loops-from-major", "with-minor.csv", **columns)
    # Signs that one amplitude does not determine, which only who asks for them gets.
    found = hyst.identify(
        major, family="gpi", plays=8, weights="invertible", delay=0, validation=minor
    )
    assert found.verdict.level == "fair"
    assert found.verdict.sentences[0].startswith("On validation the model misses by")


def test_rates_of_a_switching_material_do_not_agree(cases: Path) -> None:
    columns: dict[str, Any] = {"input": "u", "output": "y", "time": "t"}
    files = ("f1Hz.csv", "f0.2Hz.csv", "f0.05Hz.csv")
    records = [case(cases, "switching-with-rate", each, **columns) for each in files]
    verdict = verdict_on(records, delay=0, plays=4)
    assert verdict.level == "fair"
    assert any("rate" in each and "0.05" in each for each in verdict.sentences)


def test_outliers_are_counted(cases: Path) -> None:
    verdict = judged_as_given(case(cases, "spikes"), PLAYS)
    assert verdict.level == "fair"
    assert any(each.startswith("8 samples lie far") for each in verdict.sentences)


def test_outliers_are_left_out_and_counted(cases: Path) -> None:
    verdict = verdict_on(case(cases, "spikes"), delay=0)
    assert verdict.level == "good"
    assert any(each.startswith("8 samples were left out: ") for each in verdict.sentences)


def test_a_clipped_sensor_is_not_good(cases: Path) -> None:
    family = hyst.families.ModifiedPrandtlIshlinskii()
    assert judged_as_given(case(cases, "clipped-sensor"), family).level == "fair"


def test_samples_at_the_end_of_a_sensor_are_left_out_and_told(cases: Path) -> None:
    verdict = verdict_on(case(cases, "clipped-sensor"), delay=0)
    left_out = [each for each in verdict.sentences if "samples were left out: " in each]
    assert "stands at 48 um" in left_out[0]


def with_codes(cases: Path) -> hyst.Record:
    """Give the record with the codes in it, which its file is refused for."""
    path = cases / "sentinel-9999" / "loop.csv"
    t, u, y = np.genfromtxt(path, delimiter=",", skip_header=1, unpack=True)
    return hyst.Record(u, y, float(np.diff(t).mean()))


def test_codes_for_missing_values_make_it_unfit(cases: Path) -> None:
    assert judged_as_given(with_codes(cases), hyst.families.Linear()).level == "unfit"


def test_codes_for_missing_values_are_left_out_and_told(cases: Path) -> None:
    verdict = verdict_on(with_codes(cases), delay=0)
    assert verdict.level != "unfit"
    assert any("samples were left out: " in each and "-9999" in each for each in verdict.sentences)


def test_dynamics_that_were_not_found_make_it_unfit(cases: Path) -> None:
    record = case(cases, "multisine-below-half-rate", input="drive", output="pos", time="time")
    verdict = verdict_on(record, family="hammerstein", hysteresis="pi", period=2000, fir_order=8)
    assert verdict.level == "unfit"


def test_the_measured_piezo_drifts(measured_data: Path) -> None:
    """Its scatter from cycle to cycle is 0.085 um, and it moves by some 0.5 um in 40 s."""
    record = read_record(measured_data / "piezo-dbo" / "Model_Vi_Do.dat", 0, 4, rate=200.0)
    found = hyst.identify(record, family="gpi", plays=4)
    assert found.verdict.level == "fair"
    assert any("drifts" in each or "creeps" in each for each in found.verdict.sentences)
    assert "the record's own noise of 0.0" in found.verdict.sentences[0]
