"""Operators as functions that PyTorch may differentiate."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from numpy.typing import ArrayLike

from hyst.errors import InputError, MissingExtraError
from hyst.operators import Operator
from hyst.operators.differentiable import Differentiable


def evaluate(
    model: Operator, theta: Any = None, *, state: ArrayLike | None = None
) -> Callable[[Any], Any]:
    """Give an operator as a function of PyTorch.

    ``y = f(u, theta)`` with the exact derivatives of the engine in reverse mode, by the input and,
    where ``theta`` is given, by the parameters. Batches have leading axes; transforms of
    ``torch.func`` and second derivatives are refused by PyTorch.

    At a kink the derivative is one-sided; see ``Operator.vjp``.

    Parameters
    ----------
    model
        The operator. Its own parameters hold where ``theta`` is left out.
    theta
        A tensor of parameters in the order of ``model.parameters()``, shape (..., m), within their
        bounds.
    state
        Before every record, shape (n,), not differentiated; the initial state if left out.

    Returns
    -------
    callable
        Of a tensor ``u``, shape (..., N), finite, whose leading axes are broadcast with those of
        ``theta``; gives y, shape (..., N). The engine computes in double on the processor; y has
        the type and device of ``u``.

    Raises
    ------
    InputError
        If ``model`` is no operator, or ``u``, ``theta`` or ``state`` cannot be used.
    MissingExtraError
        If PyTorch is not installed.
    """
    host = Differentiable(model, state)
    function = _function()

    def evaluated(u: Any) -> Any:
        for tensor, name in ((u, "u"), (theta, "theta")):
            _require_floating(tensor, name)
        return function.apply(host, u, theta)

    return evaluated


def _require_floating(tensor: Any, name: str) -> None:
    if tensor is None and name == "theta":
        return
    floating = getattr(tensor, "is_floating_point", None)
    if floating is None or not floating() or tensor.ndim < 1:
        what = (
            type(tensor).__name__ if floating is None else f"{tensor.dtype} of {tensor.ndim} axes"
        )
        raise InputError(f"{name} is {what}; give a tensor of real floating numbers, (..., N)")


# The one door: PyTorch takes seconds to import.
@functools.cache
def _function() -> Any:
    """Give the function of PyTorch that all operators share."""
    try:
        import torch
    except ImportError as missing:
        raise MissingExtraError(
            "hyst.torch needs PyTorch, which is not installed; see https://pytorch.org for the "
            "build that suits this machine, or pip install torch"
        ) from missing

    class Evaluation(torch.autograd.Function):  # type: ignore[misc]
        """One way through the engine, and back."""

        @staticmethod
        def forward(host: Differentiable, u: Any, theta: Any) -> Any:
            y = host.outputs(_array(u), None if theta is None else _array(theta))
            return torch.from_numpy(y).to(u)

        @staticmethod
        def setup_context(ctx: Any, inputs: tuple[Any, ...], output: Any) -> None:
            ctx.host = inputs[0]
            ctx.save_for_backward(*inputs[1:])

        @staticmethod
        @torch.autograd.function.once_differentiable  # type: ignore[untyped-decorator]
        def backward(ctx: Any, cotangent: Any) -> tuple[None, Any, Any]:
            u, theta = ctx.saved_tensors
            sets = None if theta is None else _array(theta)
            by_u, by_theta = ctx.host.cotangents(_array(u), _array(cotangent), sets)
            summed = torch.from_numpy(by_u).to(u).sum_to_size(u.shape)
            if theta is None:
                return None, summed, None
            return None, summed, torch.from_numpy(by_theta).to(theta).sum_to_size(theta.shape)

    return Evaluation


def _array(tensor: Any) -> Any:
    return tensor.detach().cpu().double().numpy()
