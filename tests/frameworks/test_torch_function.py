"""Operators inside PyTorch, where it is installed.

The package index has it with gigabytes of drivers only, so that it is no dependency of development.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import hyst
from hyst.torch import evaluate
from reference.examples import EXAMPLES

Array = NDArray[np.float64]

try:
    import torch
except ImportError:
    torch = None

needs_torch = pytest.mark.skipif(
    torch is None, reason="PyTorch is not installed; its wheels bring gigabytes of drivers"
)
BANK = hyst.PrandtlIshlinskii([0.5, 0.25, 0.7], [0.2, 0.5, 1.1], p0=0.3)


def walk(samples: int = 40, seed: int = 7) -> Any:
    return torch.from_numpy(np.cumsum(np.random.default_rng(seed).standard_normal(samples)))


def parameters(model: hyst.Operator) -> Any:
    return torch.from_numpy(model.parameters().values.copy())


@needs_torch
@pytest.mark.parametrize("name", ["gpi", "mpi", "ramberg-osgood", "bouc-wen", "linear", "preisach"])
def test_gradients_are_what_differences_show(name: str) -> None:
    model = EXAMPLES[name]
    u, theta = walk().requires_grad_(), parameters(model)
    inner = torch.from_numpy(model.parameters().values > model.parameters().lower)
    free = theta[inner].clone().requires_grad_()

    def output(u: Any, free: Any) -> Any:
        return evaluate(model, theta.masked_scatter(inner, free))(u)

    assert torch.autograd.gradcheck(output, (u, free), eps=1e-7, atol=1e-5)
    assert torch.autograd.gradcheck(evaluate(model), (u,), eps=1e-7, atol=1e-5)


@needs_torch
def test_leading_axes_are_broadcast_and_summed_over_on_the_way_back() -> None:
    rows = torch.stack([walk(seed=1), walk(seed=2)])
    sets = torch.stack([parameters(BANK), 1.1 * parameters(BANK), 0.9 * parameters(BANK)])
    theta = sets[:, None].clone().requires_grad_()
    y = evaluate(BANK, theta)(rows)
    y.sum().backward()
    for i in range(3):
        model = BANK.with_parameters(sets[i].numpy())
        np.testing.assert_array_equal(y[i].detach().numpy(), model(rows.numpy()))
        by_theta = model.vjp(rows.numpy(), np.ones(rows.shape))[1].sum(axis=0)
        np.testing.assert_allclose(theta.grad[i, 0].numpy(), by_theta, rtol=1e-14)


@needs_torch
def test_the_type_is_kept_and_a_state_is_where_records_start() -> None:
    y = evaluate(BANK)(walk().float())
    assert y.dtype == torch.float32
    np.testing.assert_array_equal(y, BANK(walk().float().numpy()).astype(np.float32))
    y = evaluate(BANK, state=[1.0, 1.0, 1.0])(walk())
    np.testing.assert_array_equal(y, BANK.run(walk().numpy(), [1.0, 1.0, 1.0])[0])


@needs_torch
def test_what_cannot_be_used_is_named() -> None:
    u, theta = walk().requires_grad_(), parameters(BANK).requires_grad_()
    with pytest.raises(hyst.InputError, match="thresholds are zero or positive"):
        evaluate(BANK, -theta)(u)
    with pytest.raises(hyst.InputError, match=r"theta has shape \(2,\)"):
        evaluate(BANK, theta[:2])(u)
    with pytest.raises(hyst.InputError, match="u is int"):
        evaluate(BANK)(3)
    with pytest.raises(hyst.InputError, match=r"u is torch.int64 of 1 axes"):
        evaluate(BANK)(torch.arange(3))
    by_u = torch.autograd.grad(evaluate(BANK, theta)(u).sin().sum(), u, create_graph=True)[0]
    with pytest.raises(RuntimeError, match="once_differentiable"):
        by_u.sum().backward()


def test_without_pytorch_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    from hyst.torch.function import _function

    _function.cache_clear()
    monkeypatch.setitem(sys.modules, "torch", None)
    with pytest.raises(hyst.MissingExtraError, match="pip install torch"):
        evaluate(BANK)
    _function.cache_clear()
