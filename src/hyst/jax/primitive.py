"""Operators as functions that JAX may differentiate, vectorise and compile."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable
from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike

from hyst.errors import InputError, MissingExtraError
from hyst.operators import Operator
from hyst.operators.differentiable import Differentiable


def evaluate(
    model: Operator, theta: Any = None, *, state: ArrayLike | None = None
) -> Callable[[Any], Any]:
    """Give an operator as a function of JAX.

    ``y = f(u, theta)`` with the exact derivatives of the engine in reverse mode, by the input and,
    where ``theta`` is given, by the parameters. It may stand under ``jax.grad``, ``jit``, ``vmap``
    (records, parameters or both; a batch of records of one set goes through the engine at once) and
    inside ``lax.scan``. Forward mode and second derivatives are refused.

    At a kink the derivative is one-sided; see ``Operator.vjp``.

    Parameters
    ----------
    model
        The operator. Its own parameters hold where ``theta`` is left out.
    theta
        Parameters in the order of ``model.parameters()``, shape (m,), within their bounds.
    state
        Before every record, shape (n,), not differentiated; the initial state if left out.

    Returns
    -------
    callable
        Of ``u``, shape (N,) or (batch, N), N >= 1, finite; gives y in the shape of ``u``. It can be
        pickled where ``theta`` can. The engine computes in double; y has the type of ``u``, which
        is single precision unless ``jax_enable_x64`` is set, and gradients are rounded to it too.

    Raises
    ------
    InputError
        If ``model`` is no operator, or ``theta`` or ``state`` does not fit it. What depends on
        values alone (a NaN in ``u``, a radius below 0) is found when they are there; JAX hands it
        on as an error of its own that ends with the same sentence.
    MissingExtraError
        If JAX is not installed.

    Examples
    --------
    >>> import hyst, numpy as np
    >>> import jax
    >>> u = np.array([0.0, 1.0, 0.25, 1.0], dtype=np.float32)
    >>> play = hyst.Play(0.25)
    >>> y = evaluate(play)(u)
    >>> print(y)
    [0.   0.75 0.5  0.75]
    >>> loss = lambda theta: (evaluate(play, theta)(u) ** 2).sum()
    >>> print(jax.grad(loss)(np.array([0.25], dtype=np.float32)))
    [-2.]
    """
    Differentiable(model, state)  # refuses what cannot be used
    given = None if state is None else tuple(np.asarray(state, dtype=np.float64).tolist())
    _door()
    return functools.partial(_called, model, given, theta)


def _door() -> Any:
    """Import JAX, which takes a second: only here, and only when it is used."""
    try:
        return importlib.import_module("jax")
    except ImportError as missing:
        raise MissingExtraError(
            "hyst.jax needs JAX, which is not installed; pip install 'hyst[jax]'"
        ) from missing


# Found anew at each call rather than kept, so that what ``evaluate`` gives can be pickled.
def _called(model: Operator, state: tuple[float, ...] | None, theta: Any, u: Any) -> Any:
    jax, function = _door(), _function(model, state)
    jnp = jax.numpy
    signal = _floating(jnp, u, "u")
    if signal.ndim not in (1, 2):
        raise InputError(f"u has shape {signal.shape}; give one record (N,) or a batch (batch, N)")
    if signal.shape[-1] == 0:
        raise InputError("u is empty; give at least one sample")
    parameters = None if theta is None else _floating(jnp, theta, "theta")
    if parameters is not None and parameters.ndim != 1:
        raise InputError(
            f"theta has shape {parameters.shape}; give one vector (m,), and use jax.vmap for many"
        )
    if signal.ndim == 2:
        function = jax.vmap(function, in_axes=(0, None))
    return function(signal, parameters)


def _floating(jnp: Any, values: Any, name: str) -> Any:
    """Give an array of floating numbers of at least single precision."""
    array = jnp.asarray(values)
    if jnp.issubdtype(array.dtype, jnp.complexfloating):
        raise InputError(f"{name} has dtype {array.dtype}; give real numbers")
    return array.astype(jnp.promote_types(jnp.result_type(array, float), jnp.float32))


# Kept for operators used last: a new function would be compiled anew by JAX at every call.
@functools.lru_cache(maxsize=64)
def _function(model: Operator, state: tuple[float, ...] | None) -> Any:
    """Give ``f(u, theta)`` with its derivative; theta may be None."""
    jax = _door()
    host = Differentiable(model, state)
    count = host.parameters.size

    def outputs(u: Any, theta: Any) -> Any:
        return host.outputs(u, theta).astype(u.dtype)

    def cotangents(u: Any, cotangent: Any, theta: Any) -> Any:
        by_u, by_theta = host.cotangents(u, cotangent, theta)
        return by_u.astype(u.dtype), None if theta is None else by_theta.astype(theta.dtype)

    def refusing(rule: Any) -> Any:
        guarded = jax.custom_jvp(rule)
        guarded.defjvp(_refuse_second)
        return guarded

    def like(array: Any) -> Any:
        return jax.ShapeDtypeStruct(array.shape, array.dtype)

    def forward(u: Any, theta: Any) -> Any:
        if theta is not None and theta.shape != (count,):
            raise InputError(f"theta has shape {theta.shape}; the operator has {count} parameters")
        return jax.pure_callback(outputs, like(u), u, theta, vmap_method="expand_dims")

    # What a first derivative computes with would be differentiated for a second one.
    @refusing
    def forward_of_first(u: Any, theta: Any) -> Any:
        return forward(u, theta)

    @refusing
    def backward(u: Any, cotangent: Any, theta: Any) -> Any:
        shapes = like(u), None if theta is None else like(theta)
        return jax.pure_callback(cotangents, shapes, u, cotangent, theta, vmap_method="expand_dims")

    function = jax.custom_vjp(forward)
    function.defvjp(
        lambda u, theta: (forward_of_first(u, theta), (u, theta)),
        lambda kept, cotangent: backward(kept[0], cotangent, kept[1]),
    )
    return function


def _refuse_second(primals: Any, tangents: Any) -> NoReturn:
    raise InputError(
        "hyst gives first derivatives only; use a method that needs no second ones, or build the "
        "Hessian of a sum of squares from Operator.jacobian (Gauss-Newton)"
    )
