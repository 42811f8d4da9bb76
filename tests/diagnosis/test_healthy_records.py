"""Where every value is a measurement, no finding on values leaves any out or warns."""

from __future__ import annotations

from pathlib import Path

import pytest
from faulty_records import diagnosed
from healthy_records import SENSORS, drives, healthy, measured_records, plants

import hyst
from hyst.diagnosis.finding import Finding

# What is true of these records, and no fault of a sensor.
TRUE = {
    ("dead_zone", "from_zero"): "saturated sensor",  # at zero; a warning that names both causes
    ("butterfly", "prbs"): "still signal",  # y = u^2 of u = +-50
    ("friction", "prbs"): "quantisation",  # four values
}
TRUE |= {("few_relays", drive): "quantisation" for drive in drives()}  # 13 values


def told(record: hyst.Record) -> list[Finding]:
    """Give what the findings on values tell beyond remarks."""
    return [each for each in diagnosed(record).findings if each.severity != "remark"]


@pytest.mark.parametrize("plant", plants())
def test_simulated_records(plant: str) -> None:
    for drive in drives():
        for sensor in SENSORS:
            for each in told(healthy(plant, drive, sensor)):
                told_of = f"{drive}, {sensor}: {each.sentence}"
                assert each.name == TRUE.get((plant, drive)), told_of
                assert each.severity != "left out", told_of


def test_measured_records(measured_data: Path) -> None:
    number = 0
    for name, record in measured_records(measured_data):
        number += 1
        found = told(record)
        if name.startswith("O-ring"):
            # Single samples of this laser lie half a millimetre beside their neighbours.
            assert {(each.name, each.severity) for each in found} == {("outliers", "warning")}
        else:
            assert not found, f"{name}: {found[0].sentence}"
    assert number >= 10
