"""What identification refuses, in one sentence that names the value."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from simulated_records import TRUE_PI, drive, record

import hyst

GIVEN = record(TRUE_PI)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"family": "duhem"}, "duhem"),
        ({"plays": 0}, "plays is 0"),
        ({"plays": 201}, "plays is 201"),
        ({"plays": 2.5}, "plays is 2.5"),
        ({"plays": True}, "plays is True"),
        ({"plays": 2, "radii": [0.1]}, "1 radii"),
        ({"radii": []}, "radii"),
        ({"radii": [0.1, -0.2]}, "radii"),
        ({"radii": [np.nan]}, "radii"),
        ({"family": "linear", "radii": [0.1]}, "linear"),
        ({"knots": 0}, "knots is 0"),
        ({"delay": -3000}, "delay is -3000"),
        ({"delay": 3000}, "delay is 3000"),
        ({"delay": math.nan}, "delay is nan"),
        ({"delay": True}, "delay is True"),
        ({"start": 3000}, "start is 3000"),
        ({"start": -1}, "start is -1"),
        ({"max_iterations": -1}, "max_iterations is -1"),
        ({"max_iterations": None}, "max_iterations is None"),
        ({"validation": None}, "validation record is of type NoneType"),
        ({"validation": [GIVEN.u]}, "validation record 1 is ndarray"),
    ],
)
def test_arguments_that_cannot_be_used(arguments: dict[str, Any], said: str) -> None:
    with pytest.raises(hyst.InputError, match=said) as caught:
        hyst.identify(GIVEN, **arguments)
    assert "\n" not in str(caught.value)


def test_no_record() -> None:
    with pytest.raises(hyst.InputError, match="no record"):
        hyst.identify([])


def test_something_else_than_a_record() -> None:
    with pytest.raises(hyst.InputError, match="ndarray"):
        hyst.identify([GIVEN.u])  # type: ignore[list-item]


def test_nothing_of_a_record() -> None:
    with pytest.raises(hyst.InputError, match="record is of type NoneType"):
        hyst.identify(None)  # type: ignore[arg-type]


@pytest.mark.parametrize("family", ["auto", *hyst.families])
@pytest.mark.parametrize("left", [1, 2, 3, 4, 5, 7, 10, 15])
def test_a_start_that_leaves_next_to_nothing_is_used_or_refused(family: str, left: int) -> None:
    """The delay is looked for among the samples that are used, and leaves some of them."""
    try:
        found = hyst.identify(GIVEN, family=family, start=len(GIVEN) - left)
    except (hyst.NotIdentifiableError, hyst.SolverError):
        return
    assert found.delay <= left // 2


def test_a_constant_input() -> None:
    with pytest.raises(hyst.NotIdentifiableError, match="constant"):
        hyst.identify(hyst.Record(np.full(100, 2.0), GIVEN.y[:100], 1e-3))


def test_a_constant_output() -> None:
    with pytest.raises(hyst.NotIdentifiableError, match="output"):
        hyst.identify(hyst.Record(GIVEN.u, np.full(len(GIVEN), 2.0), 1e-3))


def test_an_input_that_does_not_turn_twice() -> None:
    u = np.linspace(0.0, 1.0, 100)
    with pytest.raises(hyst.NotIdentifiableError, match="turns"):
        hyst.identify(hyst.Record(u, u**2, 1e-3))


def test_fewer_samples_than_parameters() -> None:
    u = drive(30)
    with pytest.raises(hyst.NotIdentifiableError, match="samples"):
        hyst.identify(hyst.Record(u, TRUE_PI(u), 1e-3), family="pi", plays=15)


def test_no_radius_within_reach() -> None:
    with pytest.raises(hyst.NotIdentifiableError, match="radius"):
        hyst.identify(GIVEN, radii=[5.0])


def test_not_converged_raises_unless_allowed() -> None:
    noisy = record(TRUE_PI, noise=0.02)
    with pytest.raises(hyst.SolverError, match="did not converge"):
        hyst.identify(noisy, family="mpi", plays=4, max_iterations=1)
    found = hyst.identify(noisy, family="mpi", plays=4, max_iterations=1, allow_unconverged=True)
    assert found.status == "iteration limit"


@pytest.mark.parametrize("signal", ["input", "output"])
@pytest.mark.parametrize("validating", [False, True])
def test_records_in_different_units(signal: str, validating: bool) -> None:
    first = replace(GIVEN, **{f"{signal}_unit": "um"})
    other = replace(GIVEN, **{f"{signal}_unit": "nm"})
    records, validation = (first, other) if validating else ([first, other], ())
    with pytest.raises(hyst.InputError, match=f"the {signal} of record 2 .* 'nm'"):
        hyst.identify(records, family="linear", validation=validation)


def test_an_unknown_unit_and_another_sign_for_micro_are_no_other_unit() -> None:
    others = [replace(GIVEN, output_unit=unit) for unit in ("um", "", "\N{MICRO SIGN}m")]
    assert hyst.identify(others, family="linear").status == "converged"


def test_too_few_samples_to_choose_the_number_of_plays() -> None:
    u = np.array([0.0, 1.0, -1.0, 1.0, -1.0, 0.5, -0.5, 0.2])
    with pytest.raises(hyst.NotIdentifiableError, match="too few to choose"):
        hyst.identify(hyst.Record(u, TRUE_PI(u), 1e-3), family="pi", delay=0)
