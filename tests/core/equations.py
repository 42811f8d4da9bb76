"""The equations of the core in plain Python.

Each is written as printed, on Python floats, which are IEEE doubles rounded after every operation.
So the engine must agree with them to the last bit.
"""

from __future__ import annotations

import functools
import operator
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from hyst import _engine
from hyst.operators.stage import Stage

Step = Callable[[float], float]


def play(r: float) -> Step:
    z = 0.0

    def step(u: float) -> float:
        nonlocal z
        z = max(u - r, min(u + r, z))
        return z

    return step


def stop(r: float) -> Step:
    memory = play(r)
    return lambda u: u - memory(u)


def prandtl_ishlinskii(p0: float, p: list[float], r: list[float]) -> Step:
    plays = [play(threshold) for threshold in r]

    def step(u: float) -> float:
        return bank_sum(
            p0 * u, [weight * memory(u) for weight, memory in zip(p, plays, strict=True)]
        )

    return step


def bank_sum(first: float, products: list[float]) -> float:
    """Add the products of a bank in the order of hyst/bank.h."""
    fours = len(products) // 4 * 4 if len(products) >= 16 else 0
    sums = [functools.reduce(operator.add, products[j:fours:4], 0.0) for j in range(4)]
    y = first + ((sums[0] + sums[2]) + (sums[1] + sums[3])) if fours else first
    return functools.reduce(operator.add, products[fours:], y)


def dead_zone_term(u: float, rho: float) -> float:
    if rho > 0:
        return max(u - rho, 0.0)
    return min(u - rho, 0.0) if rho < 0 else u


def two_sided_dead_zone(weights: list[float], thresholds: list[float]) -> Step:
    pairs = list(zip(weights, thresholds, strict=True))

    def step(u: float) -> float:
        y = 0.0
        for weight, rho in pairs:
            y += weight * dead_zone_term(u, rho)
        return y

    return step


def direction_dead_zone(weights: list[float], thresholds: list[float]) -> Step:
    before = 0.0

    def step(u: float) -> float:
        nonlocal before
        y = 0.0
        for weight, eta in zip(weights, thresholds, strict=True):
            if u > before and u > eta:
                y += weight * (u - eta)
            elif u < before and u < -eta:
                y += weight * (u + eta)
            else:
                y += weight * 0.0
        before = u
        return y

    return step


@dataclass
class Pair:
    """The same chain twice: compiled, and as Python functions in the order the signal passes."""

    stages: list[Stage] = field(default_factory=list)
    steps: list[Step] = field(default_factory=list)

    def add(self, stage: Stage, step: Step) -> None:
        self.stages.append(stage)
        self.steps.append(step)

    @functools.cached_property
    def chain(self) -> _engine.Chain:
        return _engine.Chain(self.stages)

    def oracle(self, u: np.ndarray) -> np.ndarray:
        y = np.empty_like(u)
        for k, value in enumerate(u.tolist()):
            for step in self.steps:
                value = step(value)
            y[k] = value
        return y
