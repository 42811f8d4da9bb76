"""``identify(u, y, dt=)`` is ``identify`` of the record they make, and results keep records."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest
from simulated_records import TRUE_PI, record

import hyst

GIVEN = record(TRUE_PI)
ASKED: dict[str, Any] = {"family": "pi", "plays": 2, "delay": 0}


def test_input_and_output_are_as_good_as_their_record() -> None:
    bare = hyst.Record(GIVEN.u, GIVEN.y, GIVEN.dt)
    of_record = hyst.identify(bare, **ASKED)
    found = hyst.identify(GIVEN.u.tolist(), GIVEN.y, dt=GIVEN.dt, **ASKED)
    assert found.model == of_record.model
    assert found.records == (bare,)
    # The time is of the data, not one of the options that were asked for.
    origins = [each.description.provenance for each in (found, of_record)]
    assert origins[0].options == origins[1].options
    assert origins[0].data_sha256 == origins[1].data_sha256


@pytest.mark.parametrize(
    ("given", "asked", "said"),
    [
        ((GIVEN.u, GIVEN.y), {}, "u comes without dt, the time between samples in s"),
        ((GIVEN.u,), {"dt": 0.01}, "u comes without y, the output"),
        ((GIVEN, GIVEN.y), {}, "y is given beside records"),
        (([GIVEN],), {"dt": 0.01}, "dt is given beside records"),
        ((GIVEN.u,), {}, "record 1 is float64; give a hyst.Record, or u, y and dt"),
        ((GIVEN.u, GIVEN.y[1:]), {"dt": 0.01}, "different lengths|lengths differ|samples"),
        ((GIVEN.u, GIVEN.y), {"dt": 0.0}, "dt is 0"),
        ((GIVEN.u, np.append(GIVEN.y[1:], np.nan)), {"dt": 0.01}, "output 'y'"),
    ],
)
def test_what_makes_no_record_is_refused(
    given: tuple[Any, ...], asked: dict[str, Any], said: str
) -> None:
    with pytest.raises(hyst.InputError, match=said):
        hyst.identify(*given, **asked, **ASKED)


def test_a_result_keeps_its_records_without_copies_and_through_pickles() -> None:
    found = hyst.identify([GIVEN, GIVEN.slice(0, 2000)], **ASKED)
    assert found.records[0].u is GIVEN.u
    parts = [each.stop - each.start for each in found.used]
    assert found.residuals.size == sum(parts)
    again = pickle.loads(pickle.dumps(found))
    np.testing.assert_array_equal(again.residuals, found.residuals)


def test_the_input_of_a_converter_is_kept_in_volts() -> None:
    codes = np.round(200.0 + 200.0 * np.sin(np.arange(1500) / 40.0) * np.linspace(1.0, 0.4, 1500))
    driver = hyst.Driver([0, 400], [0.0, 100.0])
    y = hyst.PrandtlIshlinskii([0.5], [10.0], p0=1.0)(codes / 4.0)
    found = hyst.identify(hyst.Record(codes, y, 1e-3), driver=driver, family="pi", plays=1, delay=0)
    np.testing.assert_allclose(found.records[0].u, codes / 4.0, rtol=1e-15)
    assert float(np.abs(found.residuals).max()) < 1e-6 * np.ptp(y)
