"""Random stages and records that are hard on the engines, and how to run them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.operators.stage import Stage

Array = NDArray[np.float64]

# Numbers whose sums round, cancel, tie or lose their sign.
AWKWARD = np.array([0.0, -0.0, 1.0, -1.0, 0.5, 0.1, 1e-17, 1e-300, -1e-300, 2.0**52, -(2.0**53)])


@dataclass(frozen=True)
class Case:
    chain: _engine.Chain
    state: Array
    u: Array
    size: float  # bound of the terms that are summed for y


def _thresholds(rng: np.random.Generator, n: int) -> Array:
    way = rng.integers(5)
    if way == 0:
        return np.sort(np.round(rng.random(n) * 16) / 16)  # exact ties, duplicates, zeros
    if way == 1:
        return np.sort(np.round(rng.random(n) * 20) / 20)  # ties that rounding breaks
    if way == 2:
        return np.sort(np.abs(rng.choice(AWKWARD, n)))
    return np.sort(rng.random(n) * rng.choice([0.01, 1.0, 3.0]))


def _record(rng: np.random.Generator, samples: int) -> Array:
    way = rng.integers(6)
    if way == 0:
        return np.cumsum(rng.normal(size=samples)) * rng.choice([0.01, 0.1, 0.5])
    if way == 1:
        return np.round(rng.uniform(-1.5, 1.5, samples) * 16) / 16
    if way == 2:
        return np.repeat(np.round(rng.normal(size=samples) * 20) / 20, 3)[:samples]  # plateaus
    if way == 3:
        return rng.choice(AWKWARD, samples)
    if way == 4:
        return np.linspace(-1.0, rng.uniform(-1.0, 1.0), samples)  # nothing may be settled
    return rng.uniform(-1.5, 1.5, samples)


def _memory(rng: np.random.Generator, r: Array) -> Array:
    way = rng.integers(4)
    if way == 0:
        return rng.normal(size=r.size)  # no input can have left it
    if way == 1:
        return rng.choice(AWKWARD, r.size)
    if way == 2:
        e = rng.normal()
        return e - rng.choice([-1.0, 1.0]) * r  # one movement, from anywhere
    return np.zeros(r.size)


def bank(p0: float, p: list[float], r: list[float]) -> Stage:
    return Stage("pi", (p0, *p, *r))


def rated_bank(p: Array, r: Array, beta: float, powers: list[float]) -> Stage:
    """Plays whose thresholds grow by beta, powers and one ramp of the rate."""
    return Stage(
        "rate_dependent_pi",
        (0.3, *p.tolist(), *r.tolist(), beta, *powers, 0.2),
        fixed={"knees": (0.1,)},
        choices={"plays": p.size, "powers": len(powers)},
        dt=0.5,
    )


def random_case(rng: np.random.Generator) -> Case:
    n, samples = int(rng.integers(1, 25)), int(rng.integers(1, 400))
    r, u, p = _thresholds(rng, n), _record(rng, samples), rng.normal(size=n)
    state = _memory(rng, r)
    kind = rng.integers(8)
    if kind == 0:
        stage = rated_bank(p, r, 0.3, [0.1] if rng.random() < 0.5 else [])
        state = np.concatenate([state, [0.4, float(rng.integers(2))]])
    elif kind == 1:
        stage = Stage("play" if rng.random() < 0.5 else "stop", (float(r[-1]),))
        state = state[-1:].copy()
    else:
        stage = bank(0.3, p.tolist(), r.tolist())
    biggest = np.abs(u).max() + np.abs(state).max() + r[-1]
    return Case(_engine.Chain([stage]), state, u, float((1.0 + np.abs(p).sum()) * biggest))


def run(case: Case, engine: str, threads: int = 1) -> tuple[Array, Array]:
    """Give y and the state after the record."""
    state, y = case.state.reshape(1, -1).copy(), np.empty((1, case.u.size))
    assert case.chain.run(state, case.u.reshape(1, -1), y, engine, threads) == -1
    return y[0], state[0]


def same_bits(a: Array, b: Array) -> bool:
    return bool((a.view(np.uint64) == b.view(np.uint64)).all())
