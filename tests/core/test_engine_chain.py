"""The compiled chain against its equations in plain Python, to the last bit."""

from __future__ import annotations

import math

import numpy as np
import pytest
from equations import Pair

from hyst import _engine
from hyst.operators.stage import Stage


def run(chain: _engine.Chain, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    state = np.zeros((1, chain.state_length))
    y = np.empty((1, u.size))
    chain.run(state, u.reshape(1, -1), y)
    return y[0], state[0]


def test_record_follows_the_equations(pair: Pair, noise: np.ndarray) -> None:
    assert run(pair.chain, noise)[0].tobytes() == pair.oracle(noise).tobytes()


def test_step_gives_what_the_record_gives(pair: Pair, noise: np.ndarray) -> None:
    y, state = run(pair.chain, noise)
    step = _engine.stepper(pair.chain, np.zeros(pair.chain.state_length), 0.0)
    steps = np.array([step(u) for u in noise])
    assert steps.tobytes() == y.tobytes()
    assert step.state.tobytes() == state.tobytes()


def test_rows_of_a_batch_do_not_meet(pair: Pair, noise: np.ndarray) -> None:
    rows = noise.reshape(3, -1)
    y = np.empty_like(rows)
    pair.chain.run(np.zeros((3, pair.chain.state_length)), rows, y)
    for row, result in zip(rows, y, strict=True):
        assert result.tobytes() == run(pair.chain, row.copy())[0].tobytes()


def test_lengths(pair: Pair) -> None:
    assert pair.chain.state_length == 3 + 1 + 1 + 1
    assert pair.chain.parameter_count == 2 + 6 + 7 + 1 + 1 + 4


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_step_holds_on_a_bad_sample_until_told(pair: Pair, bad: float) -> None:
    state = np.zeros(pair.chain.state_length)
    step = _engine.stepper(pair.chain, state, 7.5)
    assert step(bad) == 7.5  # nothing came before: the safe output
    good = step(2.0)
    held = state.copy()
    assert step(bad) == good
    assert state.tobytes() == held.tobytes()
    assert step.fault
    step.clear_fault()
    step(1.0)
    assert not step.fault


@pytest.mark.parametrize(
    ("state", "u", "y"),
    [
        (np.zeros((1, 5)), np.zeros((1, 4)), np.zeros((1, 4))),
        (np.zeros((2, 6)), np.zeros((1, 4)), np.zeros((1, 4))),
        (np.zeros((1, 6)), np.zeros((1, 4)), np.zeros((1, 3))),
        (np.zeros((1, 6)), np.zeros((1, 4)), np.zeros((2, 4))),
    ],
    ids=["short state", "too many states", "short output", "too many outputs"],
)
def test_wrong_shapes_are_refused(
    pair: Pair, state: np.ndarray, u: np.ndarray, y: np.ndarray
) -> None:
    with pytest.raises(ValueError, match="shape"):
        pair.chain.run(state, u, y)


def test_copies_are_refused_where_results_would_be_lost(pair: Pair) -> None:
    state, u, y = np.zeros((1, 6)), np.zeros((1, 4)), np.zeros((1, 4))
    for arguments in [
        (state.astype(np.float32), u, y),
        (state, u, y.astype(np.float32)),
        (state, u, np.zeros((1, 8))[:, ::2]),
        (np.zeros((1, 12))[:, ::2], u, y),
    ]:
        with pytest.raises(TypeError):
            pair.chain.run(*arguments)


@pytest.mark.parametrize(
    "state", [np.zeros(5), np.zeros(7), np.zeros(6, np.float32), np.zeros(6, np.int64)]
)
def test_stepper_refuses_a_state_that_does_not_fit(pair: Pair, state: np.ndarray) -> None:
    with pytest.raises(ValueError, match="float64 of the right length"):
        _engine.stepper(pair.chain, state, 0.0)


def test_stepper_takes_one_number(pair: Pair) -> None:
    step = _engine.stepper(pair.chain, np.zeros(6), 0.0)
    assert step(1) == _engine.stepper(pair.chain, np.zeros(6), 0.0)(1.0)
    with pytest.raises(TypeError):
        step()
    with pytest.raises(TypeError):
        step("1.0")
    with pytest.raises(TypeError):
        step(1.0, 2.0)


def test_stepper_keeps_its_chain_and_state_alive(noise: np.ndarray) -> None:
    chain = _engine.Chain([Stage("play", (0.5,))])
    step = _engine.stepper(chain, np.zeros(1), 0.0)
    expected = run(chain, noise)[0]
    del chain
    np.zeros(1)  # would be given the freed state's place
    assert np.array([step(u) for u in noise]).tobytes() == expected.tobytes()
