"""Fleets: one model each, the odd ones and the failures named, nothing stops."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hyst
from fleet.lots import CHEAP, DRIVE, Fails, Kills, device, lot
from hyst.fleet import Fleet


def found(records: Any, **options: Any) -> Fleet:
    return hyst.fleet.identify(records, **{"scheduler": "threads", **CHEAP, **options})


def test_odd_devices_and_failures_are_named_and_stop_nothing() -> None:
    records: dict[str, Any] = lot(24)
    records["D03"] = device(3, gain=1.5)
    records["D11"] = device(11, weight=0.5)
    friction = np.sign(np.diff(DRIVE, prepend=-1.0))
    other = np.tanh(3.0 * DRIVE) + 0.3 * DRIVE**2 + 0.2 * friction
    records["D17"] = hyst.Record(DRIVE, other, 1e-3)
    records["torn"] = Fails("torn")
    records["odd error"] = Fails("odd error", ZeroDivisionError)
    fleet = found(records)
    assert {each.identifier for each in fleet.outliers} == {"D03", "D11", "D17"}
    assert set(fleet.failures) == {"torn", "odd error"}
    assert "the file is torn" in fleet.failures["torn"]
    assert len(fleet.models) == 24
    reasons = {each.identifier: each.reasons[0] for each in fleet.outliers}
    assert reasons["D03"].startswith("gain: ")
    assert "opening" in reasons["D11"]
    assert fleet.table.row("D17")["verdict"] == "unfit"
    told = fleet.summary()
    assert "failed: torn: the file is torn" in told


def test_a_sensor_at_its_end_is_odd_though_its_model_is_good() -> None:
    records = lot(10)
    y = records["D04"].y
    records["D04"] = hyst.Record(DRIVE, np.minimum(y, 0.6 * y.max()), 1e-3)
    (odd,) = found(records).outliers
    assert odd.identifier == "D04"
    assert "the sensor is at its upper end; hardly any other" in odd.reasons[0]


def test_numbers_of_a_device_are_those_of_its_loop() -> None:
    record = device(1)
    row = found({"A": record}).table.row("A")
    alone = hyst.identify(record, **CHEAP)
    assert row["rms_error"] == alone.metrics["training"].rms
    # By hand: a PI loop from -1 to 1 rises by 2 p0 + sum 2 p (1 - r), and opens by sum 2 p r.
    p0, p1, p2 = (row[f"parameter prandtl_ishlinskii.{each}"] for each in ("p0", "p[1]", "p[2]"))
    r1, r2 = (row[f"parameter prandtl_ishlinskii.{each}"] for each in ("r[1]", "r[2]"))
    half = 0.5 * float(np.ptp(DRIVE))
    rise = 2.0 * (p0 * half + p1 * (half - r1) + p2 * (half - r2))
    assert row["gain"] == pytest.approx(rise / (2.0 * half), rel=1e-6)
    opening = 2.0 * (p1 * r1 + p2 * r2)
    assert row["hysteresis_percent"] == pytest.approx(100.0 * opening / rise, rel=1e-3)
    assert row["noise"] == pytest.approx(0.004, rel=0.2)  # of 240 samples: 7 %
    assert row["output_range"] == np.ptp(record.y)


def test_family_size_and_delay_are_chosen_once_and_told() -> None:
    records = lot(9)
    records["D04"] = hyst.Record(DRIVE, np.tanh(4.0 * DRIVE) ** 3, 1e-3)
    fleet = hyst.fleet.identify(records, scheduler="threads", family="linear,pi", creep=None)
    assert fleet.choice.family == "pi"
    assert fleet.choice.plays in (2, 3)
    assert set(fleet.table["family"]) == {"pi"}
    assert any(
        "pi with" in each and "9 of 9 records" in each for each in fleet.choice.sentences
    ) or (any("pi with" in each for each in fleet.choice.sentences))
    assert set(fleet.table["delay"]) == {0.0}


@pytest.mark.parametrize("count", [1, 2, 5])
def test_of_few_devices_nothing_is_judged(count: int) -> None:
    fleet = found(lot(count))
    assert fleet.outliers == ()
    assert "too few to say which is odd" in fleet.judged.sentence
    assert np.isnan(fleet.table["distance"]).all()


def test_units_that_differ_are_a_failure_of_their_record() -> None:
    records = {f"D{k}": device(k, input_unit="V", output_unit="um") for k in range(4)}
    records["D3"] = device(3, input_unit="mV", output_unit="um")
    fleet = found(records)
    assert list(fleet.failures) == ["D3"]
    assert "'mV'" in fleet.failures["D3"]
    assert fleet.table.units["gain"] == "um/V"


@pytest.mark.parametrize(
    ("records", "more", "said"),
    [
        ([], {}, "no record"),
        ([device(1), device(2)], {"identifiers": ["A", "A"]}, "given twice: A"),
        ([device(1)], {"identifiers": ["A", "B"]}, "2 identifiers for 1 records"),
        ([device(1), 3.0], {}, "record 2 is of type float"),
        ([device(1)], {"limits": {"strength": (0.0, 1.0)}}, "'strength', which is no quantity"),
        ([device(1)], {"scheduler": "cloud"}, "'cloud'"),
        ([device(1)], {"shape": 3}, "shape is 3"),
        ([device(1)], {"validation": device(2)}, "validation is no option of a fleet"),
        ([device(1)], {"plyas": 3}, "'plyas' is no option"),
    ],
)
def test_refusals_come_before_the_work(records: Any, more: dict[str, Any], said: str) -> None:
    with pytest.raises(hyst.InputError, match=said):
        found(records, **more)


def test_limits_pass_or_fail_and_say_which() -> None:
    records: dict[str, Any] = lot(3)
    records["torn"] = Fails("torn")
    records["D01"] = device(1, gain=2.0)
    fleet = found(records, limits={"gain": (1.2, 2.0), "rms_percent": {"max": 2.0}})
    assert list(fleet.table["limits"]) == ["pass", "fail", "pass", "fail"]
    assert fleet.table.row("D01")["limits_broken"].startswith("gain ")
    assert fleet.passed is False
    assert fleet.counts()["fail"] == 2


def test_a_shape_that_is_shared_serves_all_devices() -> None:
    fleet = found(lot(12), shape="shared")
    assert not fleet.failures
    held = found(lot(2), shape=hyst.PrandtlIshlinskii([0.5, 0.3], [0.15, 0.4], 1.0))
    assert not held.failures


def test_a_process_that_dies_takes_no_other_device_with_it() -> None:
    records: dict[str, Any] = {**lot(1), "killer": Kills("killer")}
    fleet = found(records, scheduler="processes", workers=1)
    assert list(fleet.failures) == ["killer"]
    assert "died" in fleet.failures["killer"]
    assert list(fleet.models) == ["D00"]
