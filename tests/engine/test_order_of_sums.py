"""Wherever a bank is stepped or evaluated, its plays are summed in the order of hyst/bank.h."""

from __future__ import annotations

import math

import numpy as np
import pytest
from engine_cases import same_bits
from numpy.typing import NDArray

from hyst import (
    CreepingPlays,
    DeadZone,
    PrandtlIshlinskii,
    RateDependentPrandtlIshlinskii,
    TwoEnvelopePrandtlIshlinskii,
)

Array = NDArray[np.float64]
Bank = PrandtlIshlinskii | RateDependentPrandtlIshlinskii

BETA, DT = 0.02, 1e-2
SIZES = [1, 2, 3, 4, 15, 16, 17, 18, 19, 31, 100]


def in_order(first: Array, products: Array) -> Array:
    """Sum products, shape (N, n), row by row: written from the header's words, in NumPy."""
    n = products.shape[1]
    y, left = first.copy(), 0
    if n >= 16:
        left = n - n % 4
        s = np.zeros((4, y.size))
        for i in range(left):
            s[i % 4] = s[i % 4] + products[:, i]
        y = y + ((s[0] + s[2]) + (s[1] + s[3]))
    for i in range(left, n):
        y = y + products[:, i]
    return y


def plays(low: Array, high: Array, r: Array) -> Array:
    """Give the play outputs at every sample, shape (N, n), from no memory."""
    z, rows = np.zeros(r.size), []
    for below, above in zip(low.tolist(), high.tolist(), strict=True):
        z = np.maximum(below - r, np.minimum(above + r, z))
        rows.append(z)
    return np.array(rows)


def bank_of(n: int, rated: bool) -> tuple[Bank, Array, Array]:
    """Give a bank whose sums round, a record, and the bank's output by the equations."""
    rng = np.random.default_rng([n, rated])
    p = rng.normal(size=n) * 10.0 ** rng.integers(-6, 6, n)  # so that the order tells
    r = np.sort(rng.uniform(0.0, 2.0, n))
    u = np.round(rng.normal(size=700) * 64.0) / 64.0
    widening = np.zeros_like(u)
    if rated:
        # DT is no power of two, so growth = beta / dt is rounded here as it is there.
        widening[1:] = (0.0 + BETA / DT) * np.abs(np.diff(u))
    z = plays(u - widening, u + widening, r)
    model: Bank = PrandtlIshlinskii(p, r, p0=0.3)
    if rated:
        model = RateDependentPrandtlIshlinskii(p, r, BETA, DT, p0=0.3)
    return model, u, in_order(0.3 * u, z * p)


@pytest.mark.parametrize("rated", [False, True], ids=["pi", "rate-dependent"])
@pytest.mark.parametrize("n", SIZES)
def test_engines_and_steps_sum_in_one_order(instruction_set: str, n: int, rated: bool) -> None:
    model, u, expected = bank_of(n, rated)
    for engine in ("loop", "lanes"):
        y, _ = model.run(u, model.initial_state(), engine=engine)
        assert same_bits(y, expected), engine
    step = model.stepper()
    assert same_bits(np.array([step(each) for each in u.tolist()]), expected)


@pytest.mark.parametrize("n", [19, 100])
def test_the_order_is_not_that_of_one_sum(n: int) -> None:
    model, u, expected = bank_of(n, False)
    products = model.p * plays(u, u, model.r)
    one_by_one = 0.3 * u
    for i in range(n):
        one_by_one = one_by_one + products[:, i]
    assert not same_bits(expected, one_by_one)
    # Both are within n roundings of the exact sum.
    exact = np.array([math.fsum(row) for row in np.column_stack([0.3 * u, products]).tolist()])
    bound = n * np.finfo(float).eps * (np.abs(products).sum(axis=1).max() + 0.3 * np.abs(u).max())
    assert np.abs(expected - exact).max() <= bound
    assert np.abs(one_by_one - exact).max() <= bound


@pytest.mark.parametrize("n", [15, 16, 19, 31])
def test_banks_inside_other_operators_sum_alike(n: int) -> None:
    bank, u, _ = bank_of(n, False)
    p = np.abs(bank.p)
    expected = in_order(0.3 * u, p * plays(u, u, bank.r))
    # Lags of weight 0 add 0, and envelopes that are the identity change nothing.
    creeping = CreepingPlays(p, bank.r, 0.3, np.zeros((n, 1)), [0.1], dt=0.01)
    identity = DeadZone([1.0], [0.0])
    between = TwoEnvelopePrandtlIshlinskii(p, bank.r, identity, identity, 0.3)
    assert same_bits(creeping(u), expected)
    assert same_bits(between(u), expected)
