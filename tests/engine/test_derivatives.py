"""Gradients, Jacobians and Gram matrices against what NumPy makes of the plays' definition."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from numpy.typing import NDArray

import hyst
from hyst import _engine
from hyst.errors import InputError
from hyst.operators.engine_name import EngineName

Array = NDArray[np.float64]


def plays(u: Array, r: Array, z: Array) -> tuple[Array, Array]:
    """Play outputs and, by the contact rule, their derivatives by r: samples x n each."""
    outputs, ways = np.empty((u.size, r.size)), np.empty((u.size, r.size))
    way = np.zeros(r.size)
    for k, sample in enumerate(u):
        pushed = np.maximum(sample - r, np.minimum(sample + r, z))
        way = np.where(pushed > z, -1.0, np.where(pushed < z, 1.0, way))
        outputs[k], ways[k], z = pushed, way, pushed
    return outputs, ways


def records() -> dict[str, Array]:
    rng = np.random.default_rng(0)
    return {
        "rough": rng.uniform(-1.0, 1.0, 3001),
        "ties": np.round(rng.uniform(-1.0, 1.0, 2000) * 8) / 8,
        "plateaus": np.repeat(np.round(rng.normal(size=500) * 4) / 4, 5),
        "smooth": np.sin(np.arange(40_000) * 0.01) * np.linspace(0.1, 1.0, 40_000),
        "short": np.array([0.3, -0.4, 0.9]),
    }


@functools.cache
def expected_plays(name: str, n: int) -> tuple[Array, Array]:
    r = np.linspace(0.0, 0.9, n)
    return plays(records()[name], r, 0.5 * r)


@pytest.mark.parametrize("name", records())
@pytest.mark.parametrize("n", [1, 7, 19])
@pytest.mark.parametrize(("engine", "threads"), [("lanes", 1), ("memory-curve", 1), ("auto", 2)])
def test_loss_gradient(
    instruction_set: str, name: str, n: int, engine: EngineName, threads: int
) -> None:
    u, rng = records()[name], np.random.default_rng(n)
    r, p = np.linspace(0.0, 0.9, n), rng.normal(size=n)
    target = rng.normal(size=u.size)
    model = hyst.PrandtlIshlinskii(p, r, 0.5, 0.5 * r)
    loss, gradient = model.loss_gradient(u, target, engine=engine, threads=threads)
    outputs, ways = expected_plays(name, n)
    error = 0.5 * u + outputs @ p - target
    expected = np.concatenate([[error @ u], error @ outputs, p * (error @ ways)])
    # A sum of N products may be off by N / 2 epsilon of the sum of their sizes.
    size = np.abs(error).sum() * (1.0 + np.abs(p).max())
    assert loss == pytest.approx(0.5 * error @ error, rel=1e-11)
    np.testing.assert_allclose(gradient, expected, rtol=0.0, atol=1e-12 * size)


@pytest.mark.parametrize("name", records())
@pytest.mark.parametrize("n", [1, 7, 19])
def test_jacobian(instruction_set: str, name: str, n: int) -> None:
    u, r = records()[name], np.linspace(0.0, 0.9, n)
    p = np.random.default_rng(n).normal(size=n)
    outputs, ways = expected_plays(name, n)
    jacobian = hyst.PrandtlIshlinskii(p, r, 0.5, 0.5 * r).jacobian(u)
    np.testing.assert_array_equal(jacobian, np.column_stack([u, outputs, p * ways]))


def test_gradient_of_a_chain_is_that_of_its_jacobian() -> None:
    rng = np.random.default_rng(3)
    u, target = rng.normal(size=(2, 500))
    plays_in_the_middle = hyst.PrandtlIshlinskii([0.5, 0.2], [0.1, 0.4], 1.0)
    model = hyst.Affine(2.0, 0.1) @ plays_in_the_middle @ hyst.Affine(0.5, -0.2)
    error = model(u) - target
    loss, gradient = model.loss_gradient(u, target)
    assert loss == pytest.approx(0.5 * error @ error, rel=1e-13)
    np.testing.assert_allclose(gradient, model.jacobian(u).T @ error, rtol=1e-12, atol=1e-11)


def test_gradient_predicts_the_change_of_the_loss() -> None:
    rng = np.random.default_rng(4)
    u, target = rng.normal(size=(2, 2000))
    model = hyst.PrandtlIshlinskii(rng.normal(size=5), np.linspace(0.1, 1.3, 5), 0.7)
    _, gradient = model.loss_gradient(u, target)
    theta, step = model.parameters().values, 1e-6
    for i in range(theta.size):
        ahead, behind = (
            model.with_parameters(theta + way * step * np.eye(theta.size)[i]) for way in (1, -1)
        )
        change = (ahead.loss_gradient(u, target)[0] - behind.loss_gradient(u, target)[0]) / 2 / step
        # The loss is some 1e4; its rounding over the step is 1e4 1e-16 / 1e-6 = 1e-6. Between kinks
        # it is quadratic, and no play of 2000 random samples is within 1e-6 of one.
        assert change == pytest.approx(gradient[i], abs=1e-4)


@pytest.mark.parametrize("n", [0, 1, 5, 13, 30])
@pytest.mark.parametrize("edges", [[0, 3001], [0, 64, 128, 3001], [100, 163, 163, 3000]])
def test_gram_matrices(instruction_set: str, n: int, edges: list[int]) -> None:
    u, rng = records()["rough"], np.random.default_rng(n)
    r, y, z = np.sort(rng.random(n)), rng.normal(size=u.size), np.zeros(n)
    result = np.empty((len(edges) - 1, n + 3, n + 3))
    _engine.play_gram(r.tolist(), z, u, y, edges, result)
    outputs, _ = plays(u, r, np.zeros(n))
    rows = np.column_stack([u, outputs, np.ones(u.size), y])
    for block, gram in enumerate(result):
        part = rows[edges[block] : edges[block + 1]]
        # 3001 roundings of sums of at most 3000, half an epsilon each: 1e-9.
        np.testing.assert_allclose(gram, part.T @ part, rtol=0.0, atol=1e-9)
    if n:
        np.testing.assert_array_equal(z, outputs[edges[-1] - 1])


@pytest.mark.parametrize("n", [1, 5, 16, 30])
def test_play_outputs(instruction_set: str, n: int) -> None:
    u, r = records()["ties"], np.linspace(0.0, 1.2, n)
    z, result = np.zeros(n), np.empty((u.size, n))
    _engine.play_outputs(r.tolist(), z, u, result)
    outputs, _ = plays(u, r, np.zeros(n))
    np.testing.assert_array_equal(result, outputs)
    np.testing.assert_array_equal(z, outputs[-1])


def test_gradient_refuses_records_that_do_not_fit() -> None:
    model = hyst.PrandtlIshlinskii([1.0], [0.1])
    with pytest.raises(InputError, match="one record of each"):
        model.loss_gradient([0.0, 1.0], [0.0])
    with pytest.raises(InputError, match=r"y\[1\] is nan"):
        model.loss_gradient([0.0, 1.0], [0.0, float("nan")])
