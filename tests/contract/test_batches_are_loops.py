"""A batch of models is a loop over them, bit for bit, whatever they are."""

from __future__ import annotations

import numpy as np
import pytest

from hyst import Operator
from hyst.operators.batches import batch_loss_gradient, evaluate_batch
from reference.examples import EXAMPLES

rng = np.random.default_rng(6)
u = np.cumsum(rng.normal(size=60)) * 0.1
records = [u, u[:17], -u[5:]]
each_example = pytest.mark.parametrize("operator", EXAMPLES.values(), ids=list(EXAMPLES))


@each_example
def test_many_models(operator: Operator) -> None:
    own = operator.parameters().values
    theta = np.array([own, 2.0 * own, own])
    models = [operator.with_parameters(row) for row in theta]
    if len({model.initial_state().size for model in models}) > 1:
        return
    together = evaluate_batch(operator, u, theta, threads=2)
    assert np.array_equal(together, [model(u) for model in models])
    apart = evaluate_batch(operator, records, theta, threads=2)
    for y, model, record in zip(apart, models, records, strict=True):
        assert y.tobytes() == model(record).tobytes()


@each_example
def test_losses_and_gradients(operator: Operator) -> None:
    own = operator.parameters().values
    targets = [operator(record) + 0.1 for record in records]
    losses, gradients = batch_loss_gradient(operator, records, targets, np.tile(own, (3, 1)))
    for i, (record, target) in enumerate(zip(records, targets, strict=True)):
        loss, gradient = operator.loss_gradient(record, target)
        assert losses[i] == loss
        assert gradients[i].tobytes() == gradient.tobytes()
