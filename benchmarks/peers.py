"""The play bank as others would write it, in NumPy, numba, jax; absent where not installed."""

from __future__ import annotations

import functools
import importlib.util
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Bank = Callable[..., Any]


def numpy_time_loop(u: Array, r: Array, p: Array, p0: float) -> Array:
    """One step of all plays at a time."""
    z, y = np.zeros(r.size), np.empty_like(u)
    for k in range(u.size):
        z = np.maximum(u[k] - r, np.minimum(u[k] + r, z))
        y[k] = p0 * u[k] + p @ z
    return y


def plain_loop(u: Array, r: Array, p: Array, p0: float) -> Array:
    """The double loop that numba compiles."""
    z, y = np.zeros(r.size), np.empty_like(u)
    for k in range(u.size):
        total = p0 * u[k]
        for i in range(r.size):
            z[i] = max(u[k] - r[i], min(u[k] + r[i], z[i]))
            total += p[i] * z[i]
        y[k] = total
    return y


def plain_loop_into(u: Array, r: Array, p: Array, p0: float, y: Array) -> None:
    """The same double loop into an array that is there."""
    z = np.zeros(r.size)
    for k in range(u.size):
        total = p0 * u[k]
        for i in range(r.size):
            z[i] = max(u[k] - r[i], min(u[k] + r[i], z[i]))
            total += p[i] * z[i]
        y[k] = total


def numba_loops(loop: Bank) -> dict[str, Bank]:
    """Give a loop compiled by numba, plain and with fastmath."""
    if importlib.util.find_spec("numba") is None:
        return {}
    import numba

    return {"numba": numba.njit(loop), "numba fastmath": numba.njit(loop, fastmath=True)}


def jax_scan() -> dict[str, Bank]:
    if importlib.util.find_spec("jax") is None:
        return {}
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", True)

    @jax.jit
    def scan(u: Any, r: Any, p: Any, p0: float) -> Any:
        def step(z: Any, sample: Any) -> tuple[Any, Any]:
            z = jnp.maximum(sample - r, jnp.minimum(sample + r, z))
            return z, p0 * sample + p @ z

        return jax.lax.scan(step, jnp.zeros_like(r), u)[1]

    return {"jax lax.scan": lambda *bank: scan(*bank).block_until_ready()}


@functools.cache
def compiled_into() -> dict[str, Bank]:
    """Give the peers that can write into an array that is there."""
    return numba_loops(plain_loop_into)


@functools.cache
def compiled() -> dict[str, Bank]:
    """Give the compiled peers as a user calls them."""
    return {**numba_loops(plain_loop), **jax_scan()}
