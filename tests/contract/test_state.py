"""Records may be cut, stepped through and batched anywhere: the bits stay the same."""

from __future__ import annotations

import copy

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hyst import Affine, InputError, Operator, PrandtlIshlinskii
from reference.examples import EXAMPLES
from reference.numpy_operators import EPS
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
def test_an_output_may_be_given(operators: st.SearchStrategy, data: st.DataObject) -> None:
    operator, u = data.draw(operators), data.draw(signals())
    y, end = operator.run(u)
    apart, in_place = np.empty_like(u), u.copy()
    given, state = operator.run(u, out=apart)
    assert given is apart
    assert given.tobytes() == y.tobytes()
    assert state.tobytes() == end.tobytes()
    assert operator(in_place, out=in_place) is in_place
    assert in_place.tobytes() == y.tobytes()


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


def long_record(turns: int, samples: int = 12_000) -> np.ndarray:
    """So many turns of irregular height."""
    heights = np.random.default_rng(turns).uniform(-6.0, 6.0, turns)
    return np.interp(np.linspace(0.0, turns - 1.0, samples), np.arange(turns), heights)


@pytest.mark.parametrize("turns", [30, 6_000])
@pytest.mark.parametrize("plays", [1, 10, 37, 800])
def test_long_records_are_stepped_through_as_well(plays: int, turns: int) -> None:
    """Long enough for whatever is quicker than a loop over samples."""
    generator = np.random.default_rng(plays)
    p = generator.uniform(-0.5, 1.0, plays) / plays
    r = np.sort(generator.uniform(0.0, 7.0, plays))
    operator = Affine(2.0, -1.0) @ PrandtlIshlinskii(p, r, p0=0.3)
    u = long_record(turns)
    step = operator.stepper()
    stepped = np.array([step(value) for value in u.tolist()])

    y, state = operator.run(u)
    # The memory is always the same to the bit; the output may be summed in another order, at most
    # n + 2 roundings of sums up to sum(|p|) 13 2 < 26.
    assert state.tobytes() == step.state.tobytes()
    assert np.abs(y - stepped).max() <= (plays + 2) * EPS * 26.0
    assert operator.run(u, engine="loop")[0].tobytes() == stepped.tobytes()

    first, middle = operator.run(u[:7001])
    second, end = operator.run(u[7001:], middle)
    assert end.tobytes() == state.tobytes()
    assert np.abs(np.concatenate([first, second]) - y).max() <= 2.0 * (plays + 2) * EPS * 26.0


@pytest.mark.parametrize("turns", [30, 6_000])
@pytest.mark.parametrize("plays", [1, 10, 37])
def test_long_records_of_few_plays_give_the_same_bits(plays: int, turns: int) -> None:
    r = np.linspace(0.1, 5.0, plays)
    operator = PrandtlIshlinskii(np.full(plays, 0.1), r, p0=0.3)
    u = long_record(turns)
    y, _ = operator.run(u, engine="lanes")
    assert y.tobytes() == operator.run(u, engine="loop")[0].tobytes()
    batch, _ = operator.run(np.stack([u, -u, u[::-1]]), threads=2)
    assert np.abs(batch[0] - y).max() <= (plays + 2) * EPS * 26.0
