"""The derivative of the memory, carried from one stretch of a record to the next."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst import _engine
from hyst.operators import Operator

PLAYS = hyst.PrandtlIshlinskii([0.5, 0.3], [0.5, 1.2], 1.0)
MODELS = {
    "plays": PLAYS,
    "rate-dependent": hyst.RateDependentPrandtlIshlinskii([0.5, 0.3], [0.5, 1.2], 0.01, 0.1, 1.0),
    "ramberg-osgood": hyst.RambergOsgood(1.0, 0.7, 1.3),
    "creep after plays": hyst.Creep([0.2, 0.1], [1.0, 10.0], 0.1) @ PLAYS,
    "creeping plays": hyst.CreepingPlays(
        [0.5, 0.3], [0.5, 1.2], 1.0, [[0.1, 0.05], [0.02, 0.1]], [1.0, 10.0], 0.1
    ),
}


def carried(model: Operator, parts: list[np.ndarray]) -> tuple[np.ndarray, ...]:
    """Run a record in stretches; give output, Jacobian, and state and derivatives after the last
    but one."""
    chain = _engine.Chain(model.stages())
    state = model.initial_state()
    memory = np.zeros((state.size, chain.parameter_count))
    outputs, rows = [], []
    for part in parts:
        before = state.copy(), memory.copy()
        signal, result = part.copy(), np.empty((part.size, chain.parameter_count))
        chain.carry_jacobian(state, memory, signal, result)
        outputs.append(signal)
        rows.append(result)
    return np.concatenate(outputs), np.vstack(rows), *before


@pytest.mark.parametrize("name", MODELS)
def test_stretches_give_the_bits_of_the_whole(name: str) -> None:
    u = 0.1 * np.cumsum(np.random.default_rng(0).standard_normal(1500))
    y, jacobian, *_ = carried(MODELS[name], [u])
    parts = carried(MODELS[name], [u[:611], u[611:612], u[612:]])
    assert parts[0].tolist() == y.tolist() == MODELS[name](u).tolist()
    assert parts[1].tolist() == jacobian.tolist()
    # The derivative by hand adds up in another order.
    assert jacobian == pytest.approx(MODELS[name].jacobian(u), abs=1e-12 * np.abs(jacobian).max())


@pytest.mark.parametrize("name", MODELS)
def test_it_moves_the_memory_with_the_constants(name: str) -> None:
    rng, model = np.random.default_rng(1), MODELS[name]
    u = 0.1 * np.cumsum(rng.standard_normal(1500))
    *_, state, memory = carried(model, [u[:700], u[700:]])
    theta = model.parameters().values
    step = 1e-4 * theta * rng.standard_normal(theta.size)
    other = model.with_parameters(theta + step)
    expected = other(u)[700:]
    told = other.run(u[700:], state + memory @ step)[0]
    kept = other.run(u[700:], state)[0]
    # Of second order: a ten-thousandth of what leaving the memory would miss, taken ten times.
    assert np.abs(told - expected).max() <= 1e-3 * np.abs(kept - expected).max()
