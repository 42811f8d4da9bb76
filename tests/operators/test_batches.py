"""What a batch refuses, and what it takes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import hyst
from hyst import InputError
from hyst.operators.batches import batch_loss_gradient, evaluate_batch

PI = hyst.PrandtlIshlinskii([0.5, 0.2], [0.1, 0.3], p0=1.0)
own = PI.parameters().values
u = np.sin(np.arange(50.0))


def test_records_alone_are_the_model() -> None:
    np.testing.assert_array_equal(evaluate_batch(PI, [u, u[:9]])[1], PI(u[:9]))
    np.testing.assert_array_equal(evaluate_batch(PI, np.array([u, -u])), PI(np.array([u, -u])))
    np.testing.assert_array_equal(evaluate_batch(PI, u), PI(u)[None])
    assert isinstance(evaluate_batch(PI, [u, -u]), np.ndarray)
    assert isinstance(evaluate_batch(PI, [u, u[:9]]), list)


def test_one_target_for_all() -> None:
    losses, gradients = batch_loss_gradient(PI, [u, -u], u)
    expected = [PI.loss_gradient(each, u) for each in (u, -u)]
    np.testing.assert_array_equal(losses, [loss for loss, _ in expected])
    np.testing.assert_array_equal(gradients, [gradient for _, gradient in expected])


def test_memory_that_is_given_is_kept() -> None:
    model = hyst.PrandtlIshlinskii([0.5, 0.2], [0.1, 0.3], p0=1.0, z0=[0.4, 0.5])
    y = evaluate_batch(model, u, [own, 2.0 * own])
    np.testing.assert_array_equal(y[1], model.with_parameters(2.0 * own)(u))


def test_states_of_several_lengths() -> None:
    short, long = (hyst.Delay(samples, 1.0) for samples in (2.0, 5.0))
    y = evaluate_batch(short, u, [short.parameters().values, long.parameters().values])
    np.testing.assert_array_equal(y, [short(u), long(u)])


falling = own[[0, 1, 2, 4, 3]]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: evaluate_batch(PI, u, own), r"theta has shape \(5,\); give \(models, 5\)"),
        (lambda: evaluate_batch(PI, u, np.ones((2, 4))), r"shape \(2, 4\)"),
        (lambda: evaluate_batch(PI, u, np.ones((0, 5))), r"shape \(0, 5\)"),
        (lambda: evaluate_batch(PI, [u, u], [own] * 3), "3 rows and there are 2 records"),
        (lambda: evaluate_batch(PI, u, [own, falling]), r"theta\[1\] cannot be used: .*r\[1\]"),
        (lambda: evaluate_batch(PI, u, [own * np.nan]), r"theta\[0\] cannot be used"),
        (lambda: evaluate_batch(PI, u, [-own]), r"theta\[0\] cannot be used"),
        (lambda: evaluate_batch(PI, [u, [1.0, np.nan]]), r"u\[1\]\[1\] is nan"),
        (lambda: evaluate_batch(PI, [u, np.ones((2, 2))]), r"u\[1\] has shape \(2, 2\)"),
        (lambda: evaluate_batch(PI, []), "u is empty"),
        (lambda: evaluate_batch(PI, [u, []]), r"u\[1\] is empty"),
        (lambda: evaluate_batch(PI, u, threads=0), "threads"),
        (
            lambda: batch_loss_gradient(PI, [u, u], [u, u[1:]]),
            "record 1 has 50 samples of u and 49",
        ),
        (lambda: batch_loss_gradient(PI, [u, u], [u] * 3), "u has 2 records for 3 models"),
        (lambda: batch_loss_gradient(PI, u, [u] * 3, [own] * 2), "2 rows and there are 3 records"),
    ],
)
def test_refusals(call: Callable[[], object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        call()
