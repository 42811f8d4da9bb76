"""The described cases of loops, and measured records as a colleague would judge them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import hyst


def found_in(path: Path, **how: object) -> hyst.Diagnosis:
    """Diagnose one file of a case."""
    columns = {"input": 1, "output": 2, "time": 0} | how
    return hyst.diagnose(hyst.read_record(path, **columns))  # type: ignore[arg-type]


def warnings(found: hyst.Diagnosis) -> set[str]:
    """Names of all warnings."""
    return {each.name for each in found.of("warning")}


def test_mains_hum(cases: Path) -> None:
    (line,) = found_in(cases / "mains-hum" / "loop.csv").named("foreign line")
    # The README: 0.8 um of 50 Hz.
    assert line.amounts["frequency"] == pytest.approx(50.0, abs=0.02)
    assert line.amounts["amplitude"] == pytest.approx(0.8, rel=0.1)


def test_thermal_drift(cases: Path) -> None:
    found = found_in(cases / "thermal-drift" / "loop.csv")
    (drift,) = found.named("drift")
    assert drift.amounts["rate"] == pytest.approx(1.5, abs=0.01)
    assert "the output drifts by 1.5 um/s" in drift.sentence
    assert warnings(found) == {"drift"}


def test_output_leads(cases: Path) -> None:
    assert "run direction" in warnings(found_in(cases / "output-leads" / "loop.csv"))


def test_reversed_sensor(cases: Path) -> None:
    found = found_in(cases / "reversed-sensor" / "loop.csv")
    (sign,) = found.named("sign")
    assert sign.amounts["gain"] < 0.0
    assert not warnings(found)


@pytest.mark.parametrize(
    ("case", "how"),
    [("butterfly", {}), ("butterfly-of-switching", {"input": "u", "output": "y", "time": None})],
)
def test_butterflies(cases: Path, case: str, how: dict[str, object]) -> None:
    rate = {"rate": 100.0} if how else {}
    assert "butterfly" in warnings(found_in(cases / case / "loop.csv", **how, **rate))


def test_switching_with_rate(cases: Path) -> None:
    records = [
        hyst.read_record(path, input="u", output="y", time="t")
        for path in sorted((cases / "switching-with-rate").glob("*.csv"))
    ]
    (found,) = hyst.diagnose(records).named("rate dependence")
    assert "lag" not in found.amounts


@pytest.mark.parametrize("case", ["noise-lag", "bouc-wen"])
def test_what_is_no_fault_of_the_record(cases: Path, case: str) -> None:
    assert not warnings(found_in(cases / case / "loop.csv"))


def test_one_amplitude(cases: Path) -> None:
    how = {"input": "u", "output": "y", "time": None, "rate": 100.0}
    major = found_in(cases / "minor-loops-from-major" / "major.csv", **how)
    minor = found_in(cases / "minor-loops-from-major" / "with-minor.csv", **how)
    assert (warnings(major), warnings(minor)) == (set(), set())
    _, u, y = np.loadtxt(cases / "one-loop" / "loop.csv", delimiter=",", skiprows=1).T
    assert warnings(hyst.diagnose(hyst.Record(u, y, 0.01))) == set()
    for path in (cases / "delay-or-radius").glob("*.csv"):
        (told,) = found_in(path, **how).named("amplitudes")
        assert "a lag and a small radius" in told.sentence


def test_piezo_drifts_by_its_size(measured_data: Path) -> None:
    path = measured_data / "piezo-dbo" / "Model_Vi_Do.dat"
    record = hyst.read_record(path, input=0, output=4, rate=200.0)
    found = hyst.diagnose(record)
    assert warnings(found) == {"drift"}
    # Independent of hyst: range of the means of whole periods of 200 samples, but for the first.
    total = float(np.ptp(record.y[200:8000].reshape(-1, 200).mean(axis=1)))
    (drift,) = found.named("drift")
    assert 0.8 * total < drift.amounts["total"] < 1.25 * total
    assert drift.amounts["early"] > drift.amounts["late"]
    # Scatter of equal phases about a running mean over three periods, likewise.
    rows = record.y[400:8000].reshape(-1, 200)
    change = np.diff(rows, axis=0)
    change = change - change.mean(axis=1, keepdims=True)
    (noise,) = found.named("noise")
    assert noise.amounts["noise"] == pytest.approx(float(change.std()) / np.sqrt(2.0), rel=0.2)


def test_friction_of_a_seal(measured_data: Path) -> None:
    path = measured_data / "pneumatic-seal" / "O-ring_3bar.csv"
    record = hyst.read_record(path, input=4, output=6, rate=100.0)
    # Single samples of its laser are far off, too.
    assert warnings(hyst.diagnose(record)) == {"run direction", "outliers"}
