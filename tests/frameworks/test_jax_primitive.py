"""Operators inside JAX, against plays written for JAX and against differences."""

from __future__ import annotations

import pickle
import sys
from collections.abc import Iterator
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.typing import NDArray

import hyst
from hyst.jax import evaluate
from reference.examples import EXAMPLES

Array = NDArray[np.float64]

PLAYS = 4
BANK = hyst.PrandtlIshlinskii([0.5, 0.25, 0.7, 0.1], [0.2, 0.5, 1.1, 1.9], p0=0.3)
THETA = BANK.parameters().values


@pytest.fixture(autouse=True)
def _in_double() -> Iterator[None]:
    was = jax.config.jax_enable_x64
    jax.config.update("jax_enable_x64", True)
    yield
    jax.config.update("jax_enable_x64", was)


def walk(samples: int = 200, seed: int = 7) -> Array:
    return np.cumsum(np.random.default_rng(seed).standard_normal(samples))


def plays_of_jax(u: Any, theta: Any) -> Any:
    """The same bank, step by step, differentiated by JAX itself."""
    p0, p, r = theta[0], theta[1 : 1 + PLAYS], theta[1 + PLAYS :]

    def step(z: Any, sample: Any) -> tuple[Any, Any]:
        moved = jnp.maximum(sample - r, jnp.minimum(sample + r, z))
        return moved, p0 * sample + p @ moved

    return jax.lax.scan(step, jnp.zeros(PLAYS), u)[1]


def ours(u: Any, theta: Any) -> Any:
    return evaluate(BANK, theta)(u)


def loss(function: Any) -> Any:
    return lambda u, theta: jnp.sum(jnp.sin(3.0 * function(u, theta)))


# Sums of 200 terms of the size of 1 in another order.
TOLERANCE = {"rtol": 1e-12, "atol": 1e-11}


def test_values_and_gradients_are_those_of_plays_written_for_jax() -> None:
    found = jax.jit(jax.value_and_grad(loss(ours), argnums=(0, 1)))(walk(), THETA)
    wanted = jax.jit(jax.value_and_grad(loss(plays_of_jax), argnums=(0, 1)))(walk(), THETA)
    np.testing.assert_allclose(found[0], wanted[0], **TOLERANCE)
    np.testing.assert_allclose(found[1][0], wanted[1][0], **TOLERANCE)
    np.testing.assert_allclose(found[1][1], wanted[1][1], **TOLERANCE)


@pytest.mark.parametrize("axes", [(0, None), (None, 0), (0, 0)])
def test_batches_of_records_of_parameters_and_of_both(axes: tuple[int | None, int | None]) -> None:
    rows = np.stack([walk(seed=1), walk(seed=2), walk(seed=3)])
    sets = np.stack([THETA, 1.1 * THETA, 0.9 * THETA])
    given = rows if axes[0] == 0 else rows[0], sets if axes[1] == 0 else sets[0]
    found = jax.vmap(jax.grad(loss(ours), argnums=(0, 1)), axes)(*given)
    for i in range(3):
        u, theta = (
            np.broadcast_to(given[0], rows.shape)[i],
            np.broadcast_to(given[1], sets.shape)[i],
        )
        bank = BANK.with_parameters(theta)
        by_u, by_theta = bank.vjp(u, 3.0 * np.cos(3.0 * bank(u)))
        np.testing.assert_allclose(found[0][i], by_u, **TOLERANCE)
        np.testing.assert_allclose(found[1][i], by_theta, **TOLERANCE)


def test_every_record_with_every_set_of_parameters() -> None:
    rows = np.stack([walk(seed=1), walk(seed=2), walk(seed=3)])
    sets = np.stack([THETA, 1.1 * THETA])
    y = jax.vmap(jax.vmap(ours, (0, None)), (None, 0))(rows, sets)
    wanted = [[BANK.with_parameters(theta)(u) for u in rows] for theta in sets]
    np.testing.assert_array_equal(y, wanted)


def test_a_batch_given_as_such_and_inside_a_scan() -> None:
    rows = np.stack([walk(seed=1), walk(seed=2)])
    np.testing.assert_array_equal(evaluate(BANK)(rows), BANK(rows))
    scanned = jax.lax.scan(lambda carry, u: (carry, evaluate(BANK)(u)), 0.0, rows)[1]
    np.testing.assert_array_equal(scanned, BANK(rows))
    by_theta = jax.grad(lambda theta: jnp.sum(ours(rows, theta)))(THETA)
    np.testing.assert_allclose(by_theta, BANK.vjp(rows, np.ones_like(rows))[1].sum(0), rtol=1e-14)


@pytest.mark.parametrize(
    "name",
    [
        "gpi",
        "mpi",
        "rate-dependent",
        "ramberg-osgood",
        "preisach",
        "bouc-wen",
        "linear",
        "creep of hysteresis",
        "composition mixed",
    ],
)
def test_families_have_the_gradients_that_differences_show(name: str) -> None:
    model = EXAMPLES[name]
    theta = model.parameters()
    u = walk(150)

    @jax.jit
    def loss(u: Any, theta: Any) -> Any:
        return jnp.sum(jnp.sin(evaluate(model, theta)(u)))

    by_u, by_theta = jax.grad(loss, argnums=(0, 1))(u, theta.values)
    # Where a parameter may not go below its value there are no central differences.
    rng, step = np.random.default_rng(5), 1e-7
    inner = theta.values > theta.lower
    d_u, d_theta = rng.standard_normal(u.size), inner * rng.standard_normal(inner.size)
    for by, change_u, change in ((by_u, d_u, 0.0 * d_theta), (by_theta, 0.0 * d_u, d_theta)):
        up = loss(u + step * change_u, theta.values + step * change)
        down = loss(u - step * change_u, theta.values - step * change)
        along = np.asarray(by) @ (d_u if by is by_u else d_theta)
        # 150 sines, rounded, over the step: 1e-16 * 150 / 1e-7, and curvature of 1e-14.
        np.testing.assert_allclose(along, (up - down) / (2.0 * step), rtol=2e-6, atol=2e-6)


def test_the_type_of_the_input_is_kept() -> None:
    u = walk().astype(np.float32)
    y = evaluate(BANK)(u)
    assert y.dtype == np.float32
    # Computed in double, rounded once.
    np.testing.assert_array_equal(y, BANK(u).astype(np.float32))
    by_theta = jax.grad(lambda theta: jnp.sum(ours(u, theta)))(THETA.astype(np.float32))
    assert by_theta.dtype == np.float32
    assert evaluate(BANK)(np.arange(4)).dtype == np.float64  # whole numbers become reals
    assert evaluate(BANK)(u.astype(jnp.bfloat16)).dtype == np.float32


def test_a_state_is_where_records_start() -> None:
    state = BANK.run(walk(50, seed=9))[1]
    y = evaluate(BANK, THETA, state=state)(walk())
    np.testing.assert_array_equal(y, BANK.run(walk(), state)[0])
    by_u = jax.grad(lambda u: jnp.sum(evaluate(BANK, state=state)(u)))(walk())
    np.testing.assert_allclose(by_u, BANK.vjp(walk(), np.ones(200), state)[0], rtol=1e-15)


@pytest.mark.parametrize("derivative", [jax.hessian, lambda f: jax.jacrev(jax.jacrev(f))])
def test_second_derivatives_are_refused(derivative: Any) -> None:
    with pytest.raises((hyst.InputError, TypeError), match=r"first derivatives only|forward-mode"):
        derivative(lambda theta: loss(ours)(walk(), theta))(THETA)


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: evaluate(3.0), "model is of type float"),
        (lambda: evaluate(BANK, THETA[:3])(walk()), r"theta has shape \(3,\)"),
        (lambda: evaluate(BANK, THETA[None])(walk()), "use jax.vmap for many"),
        (lambda: evaluate(BANK)(np.zeros((2, 2, 2))), r"u has shape \(2, 2, 2\)"),
        (lambda: evaluate(BANK)(np.zeros(3) + 1j), "u has dtype complex"),
        (lambda: evaluate(BANK, state=[1.0, 2.0])(walk()), "state has shape"),
    ],
)
def test_what_cannot_be_used_is_named(call: Any, said: str) -> None:
    with pytest.raises(hyst.InputError, match=said):
        call()


def test_values_that_cannot_be_used_are_named_when_they_are_there() -> None:
    with pytest.raises(Exception, match="thresholds are zero or positive"):
        jax.block_until_ready(jax.jit(ours)(walk(), -THETA))
    with pytest.raises(Exception, match=r"u\[3\] is nan"):
        jax.block_until_ready(ours(np.where(np.arange(9) == 3, np.nan, 0.0), THETA))


def test_without_jax_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "jax", None)
    with pytest.raises(hyst.MissingExtraError, match=r"pip install 'hyst\[jax\]'"):
        evaluate(BANK)


def test_what_evaluate_gives_can_be_pickled() -> None:
    started = np.array([0.1, 0.0, -0.1, 0.0])
    given = pickle.loads(pickle.dumps(evaluate(BANK, THETA, state=started)))
    np.testing.assert_array_equal(given(walk()), BANK.run(walk(), started)[0])


@pytest.mark.parametrize("shape", [(0,), (3, 0)])
def test_no_samples_are_refused_before_they_reach_the_engine(shape: tuple[int, ...]) -> None:
    with pytest.raises(hyst.InputError, match="u is empty"):
        evaluate(BANK)(jnp.zeros(shape))


@pytest.mark.parametrize("state", [np.zeros((2, 4)), "abcd", [0.0], [np.nan] * 4])
def test_a_state_that_does_not_fit_is_refused_at_once(state: Any) -> None:
    with pytest.raises(hyst.InputError, match="state"):
        evaluate(BANK, state=state)
