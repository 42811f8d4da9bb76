"""A record in other units, by powers of two, gives the same findings in those units."""

from __future__ import annotations

import numpy as np
import pytest
from faulty_records import good

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
    expected = hyst.diagnose(faulty(1.0, 1.0)).findings
    found = hyst.diagnose(faulty(2.0**power_u, 2.0**power_y)).findings
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
