"""Records may be cut, stepped through and batched anywhere: the bits stay the same."""

from __future__ import annotations

import copy

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hyst import InputError, Operator
from reference.examples import EXAMPLES
from reference.random_operators import every_operator, signals


@every_operator
@given(data=st.data())
def test_two_halves_are_the_whole(operators: st.SearchStrategy, data: st.DataObject) -> None:
    operator, u = data.draw(operators), data.draw(signals())
    y, end = operator.run(u)
    cut = data.draw(st.integers(1, u.size))
    first, state = operator.run(u[:cut])
    if cut == u.size:
        second, last = np.empty(0), state
    else:
        second, last = operator.run(u[cut:], state)
    assert np.concatenate([first, second]).tobytes() == y.tobytes()
    assert last.tobytes() == end.tobytes()


@every_operator
@given(data=st.data())
def test_stepping_is_running(operators: st.SearchStrategy, data: st.DataObject) -> None:
    operator, u = data.draw(operators), data.draw(signals())
    y, end = operator.run(u)
    step = operator.stepper()
    assert np.array([step(value) for value in u.tolist()]).tobytes() == y.tobytes()
    assert step.state.tobytes() == end.tobytes()
    assert not step.fault


@every_operator
@given(data=st.data())
def test_a_stepper_goes_on_from_a_saved_state(
    operators: st.SearchStrategy, data: st.DataObject
) -> None:
    operator, u, tail = data.draw(operators), data.draw(signals()), data.draw(signals())
    _, state = operator.run(u)
    expected = operator.run(tail, state)[0]

    begun = operator.stepper(state)
    assert np.array([begun(value) for value in tail.tolist()]).tobytes() == expected.tobytes()

    restored = operator.stepper()
    restored(1.0)
    restored.state[:] = state
    assert np.array([restored(value) for value in tail.tolist()]).tobytes() == expected.tobytes()


@every_operator
@given(data=st.data())
def test_a_batch_is_a_loop_over_records(operators: st.SearchStrategy, data: st.DataObject) -> None:
    operator, u = data.draw(operators), data.draw(signals(most=12))
    batch = np.stack([u, u[::-1], -u, 2.0 * u])
    y, states = operator.run(batch)
    assert y.shape == batch.shape
    assert states.shape == (4, operator.initial_state().size)
    for row, output, state in zip(batch, y, states, strict=True):
        alone, end = operator.run(row)
        assert output.tobytes() == alone.tobytes()
        assert state.tobytes() == end.tobytes()

    again, _ = operator.run(batch, states)
    one_for_all, _ = operator.run(batch, states[1])
    for row, own, shared, state in zip(batch, again, one_for_all, states, strict=True):
        assert own.tobytes() == operator.run(row, state)[0].tobytes()
        assert shared.tobytes() == operator.run(row, states[1])[0].tobytes()


@every_operator
@given(data=st.data())
def test_nothing_given_is_changed(operators: st.SearchStrategy, data: st.DataObject) -> None:
    operator, u = data.draw(operators), data.draw(signals())
    model = copy.deepcopy(operator.to_dict())
    state = operator.run(u)[1]
    u_before, state_before = u.tobytes(), state.tobytes()
    operator.run(u, state)
    operator.stepper(state)(3.0)
    operator.jacobian(u, state)
    operator.initial_state()[:] = 7.0
    assert u.tobytes() == u_before
    assert state.tobytes() == state_before
    assert operator.to_dict() == model
    assert operator.run(u)[1].tobytes() == state_before


@pytest.mark.parametrize("operator", EXAMPLES.values(), ids=list(EXAMPLES))
def test_state_and_output_are_float64(operator: Operator) -> None:
    y, state = operator.run([1, 2])
    assert y.dtype == state.dtype == operator.initial_state().dtype == np.float64
    assert y.shape == (2,)
    assert state.shape == operator.initial_state().shape


@pytest.mark.parametrize("operator", EXAMPLES.values(), ids=list(EXAMPLES))
@pytest.mark.parametrize("bad", [float("nan"), float("inf"), -float("inf")])
def test_a_stepper_holds_its_output_on_what_is_no_number(operator: Operator, bad: float) -> None:
    u = [3.0, -1.0, 2.5, 0.5]
    clean, step = operator.stepper(), operator.stepper()
    assert step(bad) == 0.0  # nothing to repeat yet
    assert step.fault
    step.clear_fault()
    for value in u:
        y = clean(value)
        assert step(value) == y
        assert not step.fault
        assert step(bad) == y
        assert step.fault
        assert step.state.tobytes() == clean.state.tobytes()
        step.clear_fault()


@pytest.mark.parametrize("operator", EXAMPLES.values(), ids=list(EXAMPLES))
def test_a_state_of_another_length_or_type_is_refused(operator: Operator) -> None:
    n = operator.initial_state().size
    for state in (np.zeros(n + 1), np.zeros((1, n)), np.zeros((2, n)), 0.0):
        with pytest.raises(InputError, match=rf"state has shape .*needs \({n},\)"):
            operator.run([1.0], state)
        with pytest.raises(InputError, match="state has shape"):
            operator.stepper(state)
    with pytest.raises(InputError, match=rf"\({n},\) or \(3, {n}\)"):
        operator.run(np.ones((3, 2)), np.zeros((2, n + 1)))
    if n:
        for wrong in (np.float32, np.int64, np.complex128, object):
            with pytest.raises(InputError, match=r"state has dtype .*; give float64"):
                operator.run([1.0], np.zeros(n, dtype=wrong))
        with pytest.raises(InputError, match=r"state\[0\] is nan"):
            operator.run([1.0], np.full(n, np.nan))
