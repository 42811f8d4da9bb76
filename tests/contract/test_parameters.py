"""The flat parameter vector gives the operator back, and takes only what it can mean."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hyst import Affine, DeadZone, InputError, Operator, Play, PrandtlIshlinskii
from hyst.models import RateCurve
from reference.examples import EXAMPLES, GPI, NESTED
from reference.random_operators import every_operator, signals

each_example = pytest.mark.parametrize("operator", EXAMPLES.values(), ids=list(EXAMPLES))


@every_operator
@given(data=st.data())
def test_its_own_parameters_give_the_operator(
    operators: st.SearchStrategy, data: st.DataObject
) -> None:
    operator, u = data.draw(operators), data.draw(signals())
    parameters = operator.parameters()
    again = operator.with_parameters(parameters.values)
    assert again == operator
    assert type(again) is type(operator)
    assert again.initial_state().tobytes() == operator.initial_state().tobytes()
    assert again(u).tobytes() == operator(u).tobytes()
    assert (parameters.lower <= parameters.values).all()
    assert (parameters.values <= parameters.upper).all()


@every_operator
@given(data=st.data())
def test_other_values_arrive_where_their_names_say(
    operators: st.SearchStrategy, data: st.DataObject
) -> None:
    operator = data.draw(operators)
    # Twice the value keeps signs, zeros and the order of thresholds.
    theta = 2.0 * operator.parameters().values
    changed = operator.with_parameters(theta)
    assert changed.parameters().values.tobytes() == theta.tobytes()
    assert changed.parameters().names == operator.parameters().names
    assert operator.with_parameters(theta.tolist()) == changed


@each_example
def test_names_are_distinct_and_one_for_each(operator: Operator) -> None:
    parameters = operator.parameters()
    m = parameters.values.size
    assert len(set(parameters.names)) == len(parameters.names) == len(parameters) == m
    assert parameters.lower.shape == parameters.upper.shape == (m,)
    assert operator.jacobian([1.0, 2.0]).shape == (2, m)


def test_names_say_what_they_are() -> None:
    assert Affine(2.0, 1.0).parameters().names == ("gain", "offset")
    assert Play(2.0).parameters().names == ("r",)
    pi = PrandtlIshlinskii([5.0, 6.0], [1.0, 2.0], p0=4.0).parameters()
    assert dict(zip(pi.names, pi.values.tolist(), strict=True)) == {
        "p0": 4.0, "p[1]": 5.0, "p[2]": 6.0, "r[1]": 1.0, "r[2]": 2.0
    }  # fmt: skip
    assert GPI.parameters().names[:2] == ("dead_zone.weights[1]", "dead_zone.weights[2]")
    assert GPI.parameters().names[-1] == "prandtl_ishlinskii.r[3]"
    assert DeadZone([1.0, 2.0], [0.0, 3.0]).parameters().names == (
        "weights[1]", "weights[2]", "thresholds[1]", "thresholds[2]"
    )  # fmt: skip
    curve = RateCurve(0.5, (0.1,), [0.2, 0.3], [1.0, 2.0])
    assert curve.parameters().names == ("beta", "powers[2]", "slopes[1]", "slopes[2]")
    numbered = NESTED.parameters().names
    assert "dead_zone_1.weights[1]" in numbered
    assert "prandtl_ishlinskii_2.r[3]" in numbered
    assert "affine.gain" in numbered


def test_bounds_keep_an_operator_what_it_is() -> None:
    assert Play(2.0).parameters().lower.tolist() == [0.0]
    assert PrandtlIshlinskii([1.0], [2.0]).parameters().lower.tolist() == [-np.inf, -np.inf, 0.0]
    parameters = DeadZone([1.0, 1.0, 1.0], [0.0, 2.0, -2.0]).parameters()
    # The linear part stays at threshold 0, the others on their side: S jumps across 0.
    assert parameters.lower[3:].tolist() == [0.0, 5e-324, -np.inf]
    assert parameters.upper[3:].tolist() == [0.0, np.inf, -5e-324]


@pytest.mark.parametrize(
    "operator",
    [pytest.param(each, id=name) for name, each in EXAMPLES.items() if len(each.parameters())],
)
def test_what_is_no_vector_is_refused(operator: Operator) -> None:
    theta = operator.parameters().values
    m = theta.size
    refused = {
        rf"theta has {m + 1} entries; .* {m} parameters": np.zeros(m + 1),
        rf"theta has {m - 1} entries": theta[1:],
        r"theta has shape": theta.reshape(1, -1),
        rf"theta\[{m - 1}\] is nan": np.append(theta[:-1], np.nan),
        r"theta\[0\] is inf": np.append(np.inf, theta[1:]),
        r"theta has dtype <U": ["1"] * m,
        r"theta has dtype complex128": theta + 1j,
        r"theta has dtype object": [None] * m,
        r"theta is not a rectangular": [[1.0], [1.0, 2.0]],
    }
    for message, wrong in refused.items():
        with pytest.raises(InputError, match=message):
            operator.with_parameters(wrong)


def test_a_vector_outside_the_bounds_is_refused() -> None:
    with pytest.raises(InputError, match="r is -1"):
        Play(1.0).with_parameters([-1.0])
    with pytest.raises(InputError, match="sort the thresholds"):
        PrandtlIshlinskii([1.0, 1.0], [1.0, 2.0]).with_parameters([0.0, 1.0, 1.0, 2.0, 1.0])
