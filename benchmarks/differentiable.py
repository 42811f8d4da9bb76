"""Plays inside a model of JAX: what gradients cost, and what they are worth.

Costs: value and gradient by input, weights and radii of a loss of ten plays, against `lax.scan`
compiled by JAX; processor time, in turn. Worth: a record of three plays, fitted by one optimizer
from one start through plays, and through relays, whose switching points have no gradient; and the
gradient by the radius of a play that starts at 0, where clipping has a kink at every sample.
"""

from __future__ import annotations

import importlib.util
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

import hyst
import hyst.jax
from benchmarks.timing import interleaved, report_times

Array = NDArray[np.float64]

SAMPLES = 100_000
PLAYS = 10


def main() -> None:
    if importlib.util.find_spec("jax") is None:
        print("JAX is not installed")
        return
    import jax

    jax.config.update("jax_enable_x64", True)
    print_costs(jax)
    print_fits(jax)


def scan_of_plays(jax: Any) -> Any:
    """The plays as one writes them for JAX; parameters p0, p, r."""
    jnp = jax.numpy

    def plays(u: Any, theta: Any) -> Any:
        p, r = theta[1:].reshape(2, -1)

        def step(z: Any, sample: Any) -> tuple[Any, Any]:
            z = jnp.maximum(sample - r, jnp.minimum(sample + r, z))
            return z, theta[0] * sample + p @ z

        return jax.lax.scan(step, jnp.zeros_like(r), u)[1]

    return plays


def print_costs(jax: Any) -> None:
    bank = hyst.PrandtlIshlinskii(np.full(PLAYS, 0.1), np.arange(1, 1 + PLAYS) / 11.0, 0.3)
    theta = bank.parameters().values
    ways = {
        "hyst.jax": lambda u, theta: hyst.jax.evaluate(bank, theta)(u),
        "lax.scan": scan_of_plays(jax),
    }
    records = {
        "smooth": np.sin(2.0 * np.pi * np.arange(SAMPLES) / 1000.37),
        "rough": np.random.default_rng(1).uniform(-1.0, 1.0, SAMPLES),
    }
    print(f"ns a sample, {PLAYS} plays: value, and value with gradients by input and parameters")
    for kind, u in records.items():
        for what in ("value", "gradient"):
            works = {}
            for name, way in ways.items():

                def loss(u: Any, theta: Any, way: Any = way) -> Any:
                    return jax.numpy.sum(way(u, theta) ** 2)

                made = loss if what == "value" else jax.value_and_grad(loss, argnums=(0, 1))
                compiled = jax.jit(made)
                works[name] = lambda compiled=compiled, u=u: jax.block_until_ready(
                    compiled(u, theta)
                )
            times = interleaved(works, seconds=4.0)
            over = report_times(
                f"lax.scan over hyst.jax, {what}, {kind}", times, "lax.scan", "hyst.jax"
            )
            each = ", ".join(
                f"{name} {1e9 * float(np.median(spent)) / SAMPLES:.0f}"
                for name, spent in times.items()
            )
            print(f"  {kind:7s} {what:9s} {each}; lax.scan over hyst.jax {over:.1f}")


def print_fits(jax: Any) -> None:
    """Three plays, found again from a start with other weights and radii."""
    jnp = jax.numpy
    true = hyst.PrandtlIshlinskii([0.5, 0.3, 0.4], [0.15, 0.4, 0.7], 0.2)
    start = np.array([0.5, 0.3, 0.3, 0.3, 0.05, 0.3, 0.9])
    t = np.arange(2000) / 2000.0
    u = np.sin(14.0 * np.pi * t) + 0.6 * np.sin(45.0 * np.pi * t + 1.0)
    y = true(u)

    def relays(u: Any, theta: Any) -> Any:
        """Each play by the sign of the input's change against its radius: a relay's memory."""
        p, r = theta[1:].reshape(2, -1)

        def step(state: Any, sample: Any) -> tuple[Any, Any]:
            side = jnp.where(sample > r, 1.0, jnp.where(sample < -r, -1.0, state))
            return side, theta[0] * sample + p @ side

        return jax.lax.scan(step, jnp.zeros_like(r), u)[1]

    ways = {
        "plays of hyst.jax": lambda u, theta: hyst.jax.evaluate(true, theta)(u),
        "plays as lax.scan": scan_of_plays(jax),
        "relays as lax.scan": relays,
    }
    print("\nL-BFGS-B from one start: rms error over the deviation of y, largest |gradient by r|")
    for name, way in ways.items():

        def loss(theta: Any, way: Any = way) -> Any:
            return jnp.mean((way(u, theta) - y) ** 2)

        gradient = jax.jit(jax.value_and_grad(loss))
        at_start = np.abs(np.asarray(gradient(start)[1])[4:]).max()
        found = minimize(
            lambda theta, gradient=gradient: tuple(np.asarray(each) for each in gradient(theta)),
            start,
            jac=True,
            bounds=[(None, None)] * 4 + [(0.0, None)] * 3,
            method="L-BFGS-B",
            options={"maxiter": 1000, "ftol": 1e-16, "gtol": 1e-12},
        )
        error = np.sqrt(found.fun) / np.std(y)
        if way is not relays:
            print(f"  {name:20s} {by_radius_of_zero(jax, way, u, y)}")
        radii = ", ".join(f"{each:.4f}" for each in found.x[4:])
        print(f"  {name:20s} {error:9.2e} {at_start:9.2e}   radii {radii}   {found.nit} steps")


def by_radius_of_zero(jax: Any, way: Any, u: Array, y: Array) -> str:
    """Give the derivative by the radius of a play of radius 0, and its difference quotient."""
    theta, step = np.array([0.2, 0.5, 0.3, 0.4, 0.0, 0.4, 0.7]), 1e-7

    def loss(theta: Any) -> Any:
        return jax.numpy.mean((way(u, theta) - y) ** 2)

    found = float(jax.grad(loss)(theta)[4])
    moved = theta + step * (np.arange(7) == 4)
    quotient = (float(loss(moved)) - float(loss(theta))) / step
    return f"by a radius of 0: {found:.6f}, difference quotient {quotient:.6f}"


if __name__ == "__main__":
    main()
