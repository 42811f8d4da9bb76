"""A record in other units, by powers of two, gives the same findings in those units."""

from __future__ import annotations

import numpy as np
import pytest
from faulty_records import diagnosed, good

import hyst


def faulty(scale_u: float, scale_y: float) -> hyst.Record:
    """Give a record with every fault that does not refuse it, in any unit."""
    u, y = good(6000, 1500.0)
    u = np.round(u / 0.03) * 0.03
    y = np.minimum(y, 50.0)
    y[[300, 2200]] -= 11.0
    y[500:504] = -9999.0
    y[1000:1020] = y[999]
    u[[2800, 5300]] += 40.0
    return hyst.Record(scale_u * u, scale_y * y, 1e-3)


@pytest.mark.parametrize("power_u", [-40, 0, 33])
@pytest.mark.parametrize("power_y", [-60, 0, 21])
def test_scaled_records(power_u: int, power_y: int) -> None:
    expected = diagnosed(faulty(1.0, 1.0)).findings
    found = diagnosed(faulty(2.0**power_u, 2.0**power_y)).findings
    names = {each.name for each in expected}
    assert names >= {"outliers", "dropouts", "saturated sensor", "code for no measurement"}
    assert [(each.name, each.severity) for each in found] == [
        (each.name, each.severity) for each in expected
    ]
    for one, other in zip(expected, found, strict=True):
        assert one.samples.tolist() == other.samples.tolist()
        for name, amount in one.amounts.items():
            in_units_of_input = name == "moved" or "the input" in one.sentence[:12]
            counted = name in {"count", "levels"}
            power = 0 if counted else (power_u if in_units_of_input else power_y)
            assert other.amounts[name] == amount * 2.0**power


@pytest.mark.parametrize("scale_u", [1e-320, 1e-300, 1e160, 1e306])
@pytest.mark.parametrize("scale_y", [1e-320, 1e-300, 1e160, 2e306])
def test_absurd_units_are_no_obstacle(scale_u: float, scale_y: float) -> None:
    u, y = good(1000, 250.0)
    given = hyst.Record(scale_u * (u - 50.0), scale_y * np.minimum(y - 30.0, 20.0), 1e-3)
    (finding,) = diagnosed(given).named("saturated sensor")
    # The nearest multiple of 5e-324 to 20 times the scale is at most 2.5e-324 off it.
    assert finding.amounts["level"] == pytest.approx(20.0 * scale_y, rel=1e-12, abs=5e-324)


def test_a_range_beyond_all_numbers_is_refused() -> None:
    with pytest.raises(hyst.InputError, match=r"record 1: 'y' reaches over .* moderate size"):
        diagnosed(hyst.Record(np.arange(100.0), [1.7e308, -1.7e308] * 50, 1.0))
