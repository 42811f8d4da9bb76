"""Constants that make no operator: refused when it is made, by name, in one sentence."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hyst import (
    Affine,
    Composition,
    DeadZone,
    GeneralizedPrandtlIshlinskii,
    InputError,
    ModifiedPrandtlIshlinskii,
    NotInvertibleError,
    Operator,
    Play,
    PrandtlIshlinskii,
    Stop,
)

NAN, INF = float("nan"), float("inf")
BANK = PrandtlIshlinskii([0.5], [1.0], p0=0.5)

# How one number, or one list of numbers, reaches each constructor.
NUMBERS: dict[str, Callable[[Any], Operator]] = {
    "gain": lambda value: Affine(value),
    "offset": lambda value: Affine(1.0, value),
    "r": lambda value: Play(value),
    "z0": lambda value: Stop(1.0, value),
    "p0": lambda value: PrandtlIshlinskii([1.0], [1.0], value),
}
LISTS: dict[str, Callable[[Any], Operator]] = {
    "p": lambda values: PrandtlIshlinskii(values, [1.0, 2.0]),
    "r": lambda values: PrandtlIshlinskii([1.0, 1.0], values),
    "z0": lambda values: PrandtlIshlinskii([1.0, 1.0], [1.0, 2.0], z0=values),
    "weights": lambda values: DeadZone(values, [1.0, 2.0]),
    "thresholds": lambda values: DeadZone([1.0, 1.0], values),
    "odd weights": lambda values: DeadZone.odd(values, [1.0, 2.0]),
    "odd thresholds": lambda values: DeadZone.odd([1.0, 1.0], values),
}


def refusal(make: Callable[[Any], Any], value: Any) -> str:
    with pytest.raises(InputError) as caught:
        make(value)
    message = str(caught.value)
    assert "\n" not in message
    assert message
    return message


@pytest.mark.parametrize("name", NUMBERS)
def test_what_is_no_number(name: str) -> None:
    make = NUMBERS[name]
    said = {
        "nan": NAN,
        "inf": INF,
        "-inf": -INF,
        "(1+0j)": 1.0 + 0.0j,
        "'1'": "1",
        "None": None,
        "True": True,
        "{}": {},
        "[1.0]": [1.0],
        "[[1.0], [1.0, 2.0]]": [[1.0], [1.0, 2.0]],
    }
    for shown, value in said.items():
        assert refusal(make, value) == f"{name} is {shown}; give a finite number"
    assert refusal(make, 10**400).startswith(f"{name} is 1000")
    assert refusal(make, np.ones(200)).startswith(f"{name} is array([1., 1.")


@pytest.mark.parametrize("label", LISTS)
def test_what_is_no_list(label: str) -> None:
    make, name = LISTS[label], label.removeprefix("odd ")
    assert refusal(make, [1.0, NAN]) == f"{name}[1] is nan; every number must be finite"
    assert refusal(make, [INF, NAN]) == f"{name}[0] is inf; every number must be finite"
    assert refusal(make, np.ones(2) + 0j).startswith(f"{name} has dtype complex128")
    assert refusal(make, ["1", "2"]).startswith(f"{name} has dtype <U1")
    assert refusal(make, "12").startswith(f"{name} has dtype <U2")
    assert refusal(make, [1.0, None]).startswith(f"{name} has dtype object")
    assert refusal(make, 1.0) == f"{name} has shape (); give a list of numbers"
    assert refusal(make, np.ones((2, 1))) == f"{name} has shape (2, 1); give a list of numbers"
    assert refusal(make, [[1.0], [1.0, 2.0]]).startswith(f"{name} is not a rectangular array")
    assert refusal(make, np.ma.masked_array([1.0, 2.0], [0, 1])).startswith(f"{name} has masked")


def test_numbers_of_other_types_are_taken() -> None:
    assert Affine(np.float32(0.5), np.int8(2)) == Affine(0.5, 2.0)
    assert Play(np.array(1.5)) == Play(1.5)
    assert PrandtlIshlinskii((1, 2), np.array([0, 3], dtype=np.uint8), 1) == PrandtlIshlinskii(
        [1.0, 2.0], [0.0, 3.0], 1.0
    )


@pytest.mark.parametrize("kind", [Play, Stop])
def test_negative_threshold(kind: type[Play] | type[Stop]) -> None:
    message = refusal(lambda r: kind(r), -0.5)
    assert message == "r is -0.5; a threshold is zero or positive"


def test_thresholds_of_a_bank() -> None:
    make = LISTS["r"]
    assert refusal(make, [-1.0, 2.0]) == "r[0] is -1.0; thresholds are zero or positive"
    assert refusal(make, [1.0, -2.0]) == "r[1] is -2.0; thresholds are zero or positive"
    assert refusal(make, [2.0, 1.0]) == (
        "r[1] = 1.0 is smaller than r[0] = 2.0; sort the thresholds in ascending order, with "
        "their weights"
    )
    assert refusal(make, [1.0]) == "p has 2 entries but r has 1; give one p for each r"
    assert refusal(LISTS["p"], []) == "p has 0 entries but r has 2; give one p for each r"
    assert refusal(LISTS["z0"], [1.0]) == "z0 has 1 entries; give one for each of 2 plays"


def test_dead_zones() -> None:
    assert refusal(LISTS["weights"], [1.0]) == "1 weights but 2 thresholds; give one for each"
    assert refusal(LISTS["odd weights"], [1.0]) == "1 weights but 2 thresholds; give one for each"
    assert refusal(lambda _: DeadZone([], []), None).startswith(
        "a dead-zone map needs at least one"
    )
    assert refusal(LISTS["odd thresholds"], [0.0, -1.0]).startswith("thresholds go down to -1.0")
    for variant in ("one-sided", "", None, 1, ["two-sided"], np.array(["two-sided", "x"])):
        message = refusal(lambda each: DeadZone([1.0], [1.0], each), variant)
        assert message.endswith("choose 'two-sided' or 'by-direction'")


@pytest.mark.parametrize("stages", [(), [], None, 5, "ab", {}, (Play(1.0), 3.0), [None], [[BANK]]])
def test_what_is_no_composition(stages: Any) -> None:
    assert "compose" in refusal(Composition, stages) or "composition" in refusal(
        Composition, stages
    )


@pytest.mark.parametrize("other", [1.0, None, "x", np.ones(3000), [BANK]])
def test_only_operators_are_composed(other: Any) -> None:
    assert refusal(lambda each: BANK @ each, other).endswith("compose operators only")


@pytest.mark.parametrize(
    ("other", "named"),
    [
        (Play(1.0), "play"),
        (BANK, "prandtl-ishlinskii"),
        (Affine(1.0) @ BANK, "composition"),
        (DeadZone([1.0], [0.0], "by-direction"), "dead-zone"),
        (2.0, "float"),
        (None, "NoneType"),
        (np.ones(5000), "ndarray"),
    ],
)
def test_parts_of_named_models(other: Any, named: str) -> None:
    expected = f"is a {named}; give an operator without memory, as DeadZone"
    assert refusal(lambda each: GeneralizedPrandtlIshlinskii(each, BANK), other) == (
        f"envelope {expected}"
    )
    assert refusal(lambda each: ModifiedPrandtlIshlinskii(BANK, each), other) == (
        f"output_map {expected}"
    )
    if other is not BANK:
        expected = f"pi is a {named}; give a PrandtlIshlinskii"
        assert refusal(lambda each: GeneralizedPrandtlIshlinskii(Affine(1.0), each), other) == (
            expected
        )
        assert refusal(lambda each: ModifiedPrandtlIshlinskii(each, Affine(1.0)), other) == expected


anything = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.complex_numbers()
    | st.text(max_size=3)
    | st.binary(max_size=3),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=2), inner),
    max_leaves=6,
)


@pytest.mark.parametrize("name", [*NUMBERS, *(f"list of {each}" for each in LISTS)])
@given(value=anything)
def test_nothing_else_is_ever_raised(name: str, value: Any) -> None:
    make = NUMBERS[name] if name in NUMBERS else LISTS[name.removeprefix("list of ")]
    try:
        operator = make(value)
    except InputError as error:
        assert "\n" not in str(error)  # noqa: PT017  a refusal or an operator, both are right
    else:
        assert np.isfinite(operator.parameters().values).all()


@given(u=anything, state=anything)
def test_nothing_else_is_ever_raised_by_records(u: Any, state: Any) -> None:
    for operator in (BANK, Affine(1.0), Play(1.0)):
        for use in (
            lambda each: each.run(u, state),
            lambda each: each.jacobian(u),
            lambda each: each.with_parameters(u),
        ):
            try:
                use(operator)
            except InputError as error:
                assert "\n" not in str(error)  # noqa: PT017


def test_errors_are_value_errors() -> None:
    """Callers may catch what Python itself would raise."""
    with pytest.raises(ValueError, match="r is -1"):
        Play(-1.0)
    assert issubclass(InputError, ValueError)
    assert issubclass(NotInvertibleError, ValueError)
