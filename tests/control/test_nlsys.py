"""Blocks of hyst inside python-control: its simulator gives the bits of ``run``."""

from __future__ import annotations

import subprocess
import sys

import closed_loop_cases as s1
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import control
import hyst
from hyst import InputError, Operator
from hyst.control import TrackingController, to_nlsys
from reference.examples import EXAMPLES
from reference.random_operators import every_operator, signals

BLOCK = TrackingController.from_continuous(
    s1.CONTROLLER, 1e-3, observer=s1.printed_observer(), inverse=hyst.Affine(0.7) @ s1.INVERSE
)
WITH_MEMORY = hyst.Play(0.75, z0=2.5)


def times(system: control.NonlinearIOSystem, samples: int) -> np.ndarray:
    return np.arange(samples) * (0.1 if system.dt is True else system.dt)


def walk(samples: int, seed: int = 5) -> np.ndarray:
    return np.cumsum(np.random.default_rng(seed).normal(size=samples))


@every_operator
@settings(max_examples=10)
@given(data=st.data())
def test_a_simulation_has_the_bits_of_run(
    operators: st.SearchStrategy[Operator], data: st.DataObject
) -> None:
    # python-control interpolates inputs, which takes the sign from a zero.
    operator, u = data.draw(operators), data.draw(signals()) + 0.0
    u = np.append(u, [0.5, -0.25])  # python-control takes no record of one sample
    system = to_nlsys(operator)
    response = control.input_output_response(system, times(system, u.size), u)
    assert response.outputs.tobytes() == operator.run(u)[0].tobytes()


@pytest.mark.parametrize("name", EXAMPLES)
def test_states_are_those_of_the_operator(name: str) -> None:
    operator, u = EXAMPLES[name], walk(12)
    system, start = to_nlsys(operator), EXAMPLES[name].initial_state()
    if start.size == 0:
        assert system.nstates == 0
        return
    states = control.input_output_response(system, times(system, u.size), u).states
    assert system.nstates == start.size + bool(start.any())
    for k in range(1, u.size):
        assert states[: start.size, k].tobytes() == operator.run(u[:k])[1].tobytes()
    assert states[start.size :].tolist() == [[0.0] + [1.0] * 11] * bool(start.any())


@pytest.mark.parametrize("name", ["pi", "linear with delay", "inverse of mpi", "play with memory"])
def test_evaluating_changes_nothing(name: str) -> None:
    operator = EXAMPLES[name]
    system, (_, state) = to_nlsys(operator), operator.run(walk(9))
    x = np.append(state, 1.0) if operator.initial_state().any() else state
    before, u = x.copy(), np.array([0.7])
    answers = [(system.dynamics(0.0, x, u), system.output(0.0, x, u)) for _ in range(3)]
    for following, y in answers:
        following += 1.0  # nor do answers stay tied to what is remembered
        y += 1.0
    for _ in range(12):  # other samples in between
        system.output(0.0, x, np.random.default_rng(1).normal(size=1))
    y, end = operator.run(u, state)
    assert x.tobytes() == before.tobytes()
    assert system.output(0.0, x, u).tobytes() == y.tobytes()
    assert system.dynamics(0.0, x, u)[: end.size].tobytes() == end.tobytes()


def test_the_output_answers_to_the_input_of_the_same_sample() -> None:
    system = to_nlsys(hyst.Play(0.5))
    assert system.output(0.0, [0.0], [2.0]).tolist() == [1.5]
    assert system.dynamics(0.0, [0.0], [2.0]).tolist() == [1.5]


def test_it_begins_at_the_initial_state_or_where_it_is_told() -> None:
    t = np.arange(3.0)

    def first(**start: object) -> float:
        return control.input_output_response(
            to_nlsys(WITH_MEMORY), t, [2.9, 2.9, 2.9], **start
        ).outputs[0]

    assert first() == 2.5
    assert first(X0=[2.5, 0.0]) == 2.5
    assert first(X0=[3.0, 1.0]) == 3.0
    with pytest.raises(InputError, match=r"play at 0 s: its last state is 0 .* give 1 behind"):
        first(X0=[3.0, 0.0])


@pytest.mark.parametrize("watch", [False, True])
def test_the_block_has_the_bits_of_run(watch: bool) -> None:
    y_ref, y = walk(40), walk(40, seed=6)
    system = to_nlsys(BLOCK, watch=watch)
    assert (system.input_labels, system.name) == (["y_ref", "y"], "controller")
    response = control.input_output_response(system, times(system, 40), [y_ref, y])
    outputs = np.atleast_2d(response.outputs)
    assert outputs[0].tobytes() == BLOCK.run(y_ref, y)[0].tobytes()
    assert system.output_labels == (["u", "v", "d_hat"] if watch else ["u"])
    if watch:
        bare = TrackingController(BLOCK.A, BLOCK.B, BLOCK.C, BLOCK.D, BLOCK.dt)
        assert outputs[1].tobytes() == bare.run(y_ref, y)[0].tobytes()
        assert outputs[2].tobytes() == BLOCK.estimate(y_ref, y).tobytes()


def test_a_scheduled_model_and_its_inverse_take_the_second_signal() -> None:
    cold = hyst.PrandtlIshlinskii([0.5], [0.2], p0=1.0)
    model = hyst.Scheduled([cold, hyst.PrandtlIshlinskii([0.7], [0.1], p0=1.2)], [20.0, 40.0])
    u, s = walk(30), np.linspace(25.0, 45.0, 30)
    t = np.arange(30) * 0.5
    y, outside = control.input_output_response(to_nlsys(model, watch=True), t, [u, s]).outputs
    assert y.tobytes() == model.run(u, s).y.tobytes()
    assert outside.tolist() == (s > 40.0).tolist()
    inverse = model.inverse()
    back = control.input_output_response(to_nlsys(inverse, 0.5), t, [y, s]).outputs
    assert back.tobytes() == inverse.run(y, s).y.tobytes()


def test_their_product_is_the_composition() -> None:
    f, g, u = EXAMPLES["creep"], EXAMPLES["play with memory"], walk(30)
    product = to_nlsys(f) * to_nlsys(g)
    y = control.input_output_response(product, 0.01 * np.arange(30), u).outputs
    assert y.tobytes() == (f @ g).run(u)[0].tobytes()


def test_sample_times() -> None:
    lag = hyst.Lag(0.013, dt=0.01)
    assert to_nlsys(lag).dt == 0.01
    assert to_nlsys(lag, 0.01 * (1 + 1e-9)).dt == 0.01
    assert to_nlsys(hyst.Play(1.0)).dt is True
    assert to_nlsys(hyst.Play(1.0), 0.2).dt == 0.2
    assert to_nlsys(lag @ hyst.Play(1.0)).dt == 0.01


def test_what_cannot_be_made_is_refused() -> None:
    with pytest.raises(InputError, match=r"dt is 0.02 s, that of lag 0.01 s"):
        to_nlsys(hyst.Lag(0.013, dt=0.01), 0.02)
    with pytest.raises(InputError, match="continuous time, but hyst steps from sample to sample"):
        to_nlsys(hyst.Play(1.0), 0)
    with pytest.raises(InputError, match="dt is -1"):
        to_nlsys(hyst.Play(1.0), -1)
    with pytest.raises(InputError, match="the block is int; give an operator"):
        to_nlsys(3)


def test_what_cannot_be_simulated_is_refused() -> None:
    play, lag, t = to_nlsys(hyst.Play(1.0)), to_nlsys(hyst.Lag(0.013, dt=0.01)), np.arange(5.0)
    with pytest.raises(InputError, match="play at 2 s: u is inf; the loop diverges"):
        control.input_output_response(play, t, [1.0, 2.0, np.inf, 3.0, 4.0])
    with pytest.raises(ValueError, match="Wrong shape"):  # a batch
        control.input_output_response(play, t, np.ones((2, 5)))
    with pytest.raises(InputError, match="play at 0 s: 2 inputs are given; it has u"):
        play.output(0.0, [0.0], [1.0, 2.0])
    with pytest.raises(ValueError, match="sampling time"):
        control.input_output_response(lag, 0.02 * t, t)
    with pytest.raises(InputError, match=r"affine at 1 s: .* overflows"):
        control.input_output_response(to_nlsys(hyst.Affine(1e300)), t, 1e10 * t)


def test_neither_hyst_nor_its_control_loads_python_control() -> None:
    program = "import sys, hyst.control; print('control' in sys.modules, hyst.control.to_nlsys)"
    ended = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert ended.stdout.startswith("False <function to_nlsys")
