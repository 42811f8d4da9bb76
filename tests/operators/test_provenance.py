"""Where a model comes from: the hash of the data, and what was asked for."""

from __future__ import annotations

import hashlib
import platform
import struct
from datetime import UTC, datetime, timedelta
from typing import Any

import numpy as np
import pytest
import scipy

import hyst
from hyst._typed_command import carrying_out, typed_command
from hyst.operators import data_hash
from hyst.operators.provenance import options_asked, provenance

FIRST = hyst.Record([0.0, 1.0, -2.5], [0.5, 1.5, 0.1], dt=0.25)
SECOND = hyst.Record([1.0, 2.0], [3.0, 4.0], dt=0.25)


def test_the_hash_is_of_the_bytes_of_u_y_and_dt() -> None:
    content = struct.pack("<7d", 0.0, 1.0, -2.5, 0.5, 1.5, 0.1, 0.25)
    assert data_hash([FIRST]) == hashlib.sha256(content).hexdigest()
    content += struct.pack("<5d", 1.0, 2.0, 3.0, 4.0, 0.25)
    assert data_hash([FIRST, SECOND]) == hashlib.sha256(content).hexdigest()


def test_any_bit_of_the_data_changes_it_and_names_do_not() -> None:
    named = hyst.Record(FIRST.u, FIRST.y, FIRST.dt, input_name="drive", input_unit="V")
    assert data_hash([named]) == data_hash([FIRST])
    nudged = np.nextafter(FIRST.u, 9.0)
    others = [
        hyst.Record(nudged, FIRST.y, FIRST.dt),
        hyst.Record(FIRST.u, nudged, FIRST.dt),
        hyst.Record(FIRST.u, FIRST.y, np.nextafter(0.25, 1.0)),
    ]
    assert len({data_hash([each]) for each in (FIRST, *others)}) == 4
    assert data_hash([FIRST, SECOND]) != data_hash([SECOND, FIRST])


def test_it_says_when_with_what_and_how() -> None:
    before = datetime.now(UTC) - timedelta(seconds=1)
    found = provenance([FIRST], {"plays": 2, "radii": np.array([0.5, 1.0]), "memory": np.inf})
    assert before <= datetime.fromisoformat(found.date) <= datetime.now(UTC)
    assert found.date.endswith("+00:00")
    assert found.versions == {
        "hyst": hyst.__version__,
        "numpy": np.__version__,
        "scipy": scipy.__version__,
        "python": platform.python_version(),
    }
    assert found.options == {"plays": 2, "radii": [0.5, 1.0], "memory": "inf"}
    assert found.command == ""


def test_what_json_cannot_hold_does_not_cost_a_result() -> None:
    found = provenance([FIRST], {"odd": {1: 2}, "none": None, "nested": [[1.0, np.nan]]})
    assert found.options == {"odd": "{1: 2}", "none": None, "nested": "[[1.0, nan]]"}


def test_the_command_is_known_while_it_is_carried_out_and_forgotten_then() -> None:
    with carrying_out(["identify", "my data.csv", "--input", "0"]):
        assert provenance([FIRST], {}).command == "hyst identify 'my data.csv' --input 0"
    assert typed_command() == ""


def function(records: Any, *, plays: Any = "auto", radii: Any = None, kept: Any = ()) -> None:
    """Take options."""


@pytest.mark.parametrize(
    ("given", "asked"),
    [
        ({}, {}),
        ({"plays": "auto", "radii": None}, {}),
        ({"plays": 2}, {"plays": 2}),
        ({"radii": [1.0]}, {"radii": [1.0]}),
        ({"kept": (SECOND,)}, {}),
    ],
)
def test_options_by_default_are_not_listed(given: dict[str, Any], asked: dict[str, Any]) -> None:
    assert options_asked(function, {"records": FIRST, "plays": "auto", **given}) == asked
