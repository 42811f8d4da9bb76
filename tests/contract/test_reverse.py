"""The way back through every operator: against the Jacobian, and against differences of outputs."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from hyst import InputError, Operator, Play, PrandtlIshlinskii, Stop
from reference.derivatives import off_their_bounds
from reference.examples import EXAMPLES

Array = NDArray[np.float64]

# Two blocks of the engine and a part of one.
SAMPLES = 600
# A sum of 600 products in another order, each rounded to half an epsilon of its size.
ROUNDINGS = 600.0 * np.finfo(np.float64).eps
# Of central differences of a step of 1e-7 where the output is of the size of 1 to 100: rounding
# over the step, 1e-16 / 1e-7, and a kink or two that lies within the step.
DIFFERENCES = 1e-6


def walk() -> Array:
    """A signal off every threshold, that turns at random and never rests."""
    return np.cumsum(np.random.default_rng(7).standard_normal(SAMPLES))


def cotangent() -> Array:
    return np.random.default_rng(3).standard_normal(SAMPLES)


@pytest.mark.parametrize("operator", EXAMPLES.values(), ids=list(EXAMPLES))
def test_back_to_the_parameters_is_the_transposed_jacobian(operator: Operator) -> None:
    u, c, columns = walk(), cotangent(), off_their_bounds(operator)
    by_parameters = operator.vjp(u, c)[1]
    jacobian = operator.jacobian(u)
    size = np.abs(jacobian).T @ np.abs(c)
    assert by_parameters.shape == size.shape
    # A column of zeros may be a sum that cancels: its roundings are those of the sums around it.
    bound = ROUNDINGS * (size + size.max(initial=0.0) / SAMPLES)
    assert np.all((np.abs(by_parameters - jacobian.T @ c) <= bound)[columns])


@pytest.mark.parametrize("operator", EXAMPLES.values(), ids=list(EXAMPLES))
def test_back_to_the_input_is_what_differences_show(operator: Operator) -> None:
    u, c = walk(), cotangent()
    direction = np.random.default_rng(5).standard_normal(SAMPLES)
    step = 1e-7
    change = c @ (operator(u + step * direction) - operator(u - step * direction)) / (2.0 * step)
    by_u = operator.vjp(u, c)[0]
    size = abs(change) + np.abs(by_u) @ np.abs(direction)
    assert abs(change - by_u @ direction) <= DIFFERENCES * size


@pytest.mark.parametrize(
    "operator",
    [
        PrandtlIshlinskii([0.5, 0.3, 0.2], [0.0, 1.0, 2.0], p0=0.2),
        Play(0.0),
        Play(0.5),
        Stop(0.0),
        Stop(1.0, z0=-0.5),
    ],
    ids=repr,
)
def test_plays_have_the_jacobian_s_side_of_a_kink(operator: Operator) -> None:
    # Halves are added exactly: plays begin and cease to move on samples, and rest.
    u, c = np.round(2.0 * walk()) / 2.0, cotangent()
    jacobian = operator.jacobian(u)
    size = np.abs(jacobian).T @ np.abs(c)
    assert np.all(np.abs(operator.vjp(u, c)[1] - jacobian.T @ c) <= ROUNDINGS * size)


def test_by_hand() -> None:
    # Pushed up by sample 1, at rest at 2, pushed down by 3: y = 0.2 u + z.
    bank = PrandtlIshlinskii([1.0], [0.5], p0=0.2)
    by_u, by_parameters = bank.vjp([0.0, 2.0, 1.8, 0.0], [1.0, 10.0, 100.0, 1000.0])
    np.testing.assert_allclose(by_u, [0.2, 2.0 + 110.0, 20.0, 200.0 + 1000.0], rtol=1e-15)
    assert bank([0.0, 2.0, 1.8, 0.0]).tolist() == [0.0, 1.9, 1.86, 0.5]
    # By p0: c'u; by p: c'z; by r: -1 while it was pushed up last, 1 after it was pushed down.
    np.testing.assert_allclose(by_parameters, [200.0, 1.5 * 110.0 + 500.0, 890.0], rtol=1e-15)


def test_a_batch_is_its_records() -> None:
    operator = EXAMPLES["composition mixed"]
    rows, c = np.stack([walk(), -walk()]), np.stack([cotangent(), 2.0 * cotangent()])
    by_u, by_parameters = operator.vjp(rows, c)
    for i in range(2):
        alone = operator.vjp(rows[i], c[i])
        np.testing.assert_array_equal(by_u[i], alone[0])
        np.testing.assert_array_equal(by_parameters[i], alone[1])


def test_it_starts_from_the_state_given() -> None:
    play = Play(0.5)
    by_u, by_r = play.vjp([0.3], [1.0], state=[2.0])
    assert (by_u.tolist(), by_r.tolist()) == ([1.0], [1.0])  # pushed down
    by_u, by_r = play.vjp([0.3], [1.0], state=[0.0])
    assert (by_u.tolist(), by_r.tolist()) == ([0.0], [0.0])  # at rest


@pytest.mark.parametrize(
    ("u", "given", "said"),
    [
        ([0.0, 1.0], [1.0], "u has shape (2,) and cotangent (1,)"),
        ([0.0, np.nan], [1.0, 1.0], "u[1] is nan"),
        ([0.0, 1.0], [1.0, np.inf], "cotangent[1] is inf"),
    ],
)
def test_what_cannot_be_used_is_named(u: list[float], given: list[float], said: str) -> None:
    with pytest.raises(InputError) as refused:
        Play(0.5).vjp(u, given)
    assert said in str(refused.value)
