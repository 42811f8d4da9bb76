"""The tracking error to expect is the model's own beside that of the inversion."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst.compensation import ModelError, invert_trajectory
from hyst.operators import ModelDescription

STAGE = hyst.PrandtlIshlinskii(p=[0.5, 0.3], r=[0.4, 1.1], p0=1.0)
U = 2.0 - 2.0 * np.cos(np.linspace(0.0, 20.0, 400))
TRAINING = {"rms": 0.1, "rms_percent": 1.0, "max_abs": 0.4}


def errors(rms: float) -> dict[str, float]:
    return {"rms": rms, "max_abs": 3.0 * rms}


def described(**about: object) -> hyst.operators.Operator:
    return STAGE.with_description(ModelDescription(**about))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("records", "expected"),
    [
        ({}, None),
        ({"training": TRAINING}, ModelError("training", 0.1, 0.4)),
        ({"training": TRAINING, "training, free offset": errors(0.5)}, ("training", 0.1)),
        ({"training": TRAINING, "validation": errors(0.2)}, ("validation", 0.2)),
        ({"training": TRAINING, "validation": errors(0.05)}, ("validation", 0.05)),
        ({"validation 1": errors(0.2), "validation 2": errors(0.3)}, ("validation 2", 0.3)),
        ({"training": {"rms": 0.1}}, None),
    ],
)
def test_a_record_the_model_has_not_seen_counts_more(records: dict, expected: object) -> None:
    found = invert_trajectory(described(errors=records), STAGE(U)).expected
    if isinstance(expected, tuple):
        assert found is not None
        assert (found.record, found.rms) == expected
    else:
        assert found == expected


def test_rounding_is_called_rounding_and_the_models_error_is_told() -> None:
    done = invert_trajectory(described(errors={"training": TRAINING}), STAGE(U))
    told = done.expectation("um")
    assert told.startswith("exact for the model (rounding ")
    assert "missed its record by 0.1 um rms, 0.4 at most (training): expect that" in told
    assert told in done.summary("um")
    assert "missed its record by 0.1 rms" in repr(done)
    assert "array" not in repr(done)


def test_what_was_taken_out_of_the_record_is_told_beside() -> None:
    records = {"training": TRAINING, "training, disturbances left in": errors(0.5)}
    done = invert_trajectory(described(errors=records), STAGE(U))
    assert done.expected == ModelError("training", 0.1, 0.4, disturbed=(0.5, 1.5))
    told = done.expectation("um")
    assert "0.1 um rms, 0.4 at most (training; 0.5 and 1.5 with drift and foreign" in told


def test_what_is_clipped_is_not_called_exact() -> None:
    model = described(errors={"training": TRAINING})
    done = invert_trajectory(model, STAGE(U), input_range=(0.0, 3.0), outside="clip")
    told = done.expectation()
    assert told.startswith(f"the model misses the reference by {done.rms:.3g} rms")
    assert told.endswith("expect both together")
    assert f"{done.clipped} of 400 samples were held at an end" in done.summary()


def test_a_model_that_tells_no_errors_is_said_to_tell_none() -> None:
    assert (
        "is not known, for the model tells no errors"
        in invert_trajectory(STAGE, STAGE(U)).expectation()
    )


def test_outside_the_records_nothing_is_known() -> None:
    inside = {"input_low": 0.0, "input_high": 4.0, "input_unit": "V"}
    y = STAGE(U)
    inside |= {"output_low": float(y.min()), "output_high": float(y.max())}
    assert invert_trajectory(described(**inside), y).unknown == ()
    beyond, above = invert_trajectory(described(**inside), STAGE(1.5 * U)).unknown
    assert "the command goes from 0 to 6" in beyond.replace("5.99997", "6")
    assert "the input from 0 to 4 V; beyond that the error is not known" in beyond
    assert above.startswith("the reference goes from ")


@pytest.mark.parametrize(("swing", "known"), [(0.5, True), (0.9, True), (1.3, False)])
@pytest.mark.parametrize("unit", [1.0, 2.0**-40, 2.0**30])
def test_smaller_loops_than_the_records_are_named(swing: float, known: bool, unit: float) -> None:
    # A drive with minor loops of exactly 1 between 1 and 2, in any unit.
    corners = np.array([0.0, 4.0, 1.0, 2.0, 1.0, 2.0, 1.0, 4.0, 0.0])
    u = np.interp(np.arange(0.0, 8.0, 0.02), np.arange(9.0), corners) * unit
    model = hyst.PrandtlIshlinskii([0.5, 0.3], [0.4 * unit, 1.1 * unit], p0=1.0)
    about = ModelDescription(input_low=0.0, input_high=4.0 * unit, smallest_swing=swing * unit)
    unknown = invert_trajectory(model.with_description(about), model(u)).unknown
    assert (unknown == ()) == known
    if not known:
        assert unknown[0].startswith("4 swings of the command are smaller than any in the records")
