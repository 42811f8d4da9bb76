"""The kernel's own derivative on every instruction set and with every number of tangents."""

from __future__ import annotations

import numpy as np
import pytest

from hyst import DeadZone, LinearDynamics, Operator, PrandtlIshlinskii, RambergOsgood, _engine
from hyst.operators.stage import Stage
from reference.derivatives import jacobian


def bank(plays: int) -> PrandtlIshlinskii:
    rng = np.random.default_rng(plays)
    return PrandtlIshlinskii(rng.normal(size=plays), np.linspace(0.1, 2.0, plays), 0.5)


@pytest.mark.parametrize("plays", [0, 1, 2, 3, 4, 7, 8, 9, 12, 16, 23])
def test_any_number_of_columns(instruction_set: str, plays: int) -> None:
    # 2 n + 1 columns: full passes of 4, 8 and 16, and all rests. The same operations by hand.
    u = np.random.default_rng(1).normal(size=200)
    expected = jacobian(bank(plays), u, "auto")
    np.testing.assert_array_equal(jacobian(bank(plays), u, "kernel"), expected)


@pytest.mark.parametrize("terms", [1, 2, 5, 8, 11])
def test_columns_that_come_in_and_own_ones_share_a_pass(instruction_set: str, terms: int) -> None:
    rng = np.random.default_rng(terms)
    envelope = DeadZone(rng.normal(size=terms), rng.normal(size=terms))
    u = rng.normal(size=200)
    expected = jacobian(bank(5) @ envelope, u, "auto")
    # The same sums, the terms of a sample in the same order: by hand as by kernel.
    np.testing.assert_array_equal(jacobian(bank(5) @ envelope, u, "kernel"), expected)


@pytest.mark.parametrize(
    "operator",
    [
        LinearDynamics.from_transfer_function([0.5, 0.1], [1.0, -1.2, 0.5], dt=0.01) @ bank(3),
        RambergOsgood(1.0, 0.5, 1.2) @ bank(3),
        RambergOsgood(1.0, 0.5, 1.2).inverse(),
    ],
)
def test_all_instruction_sets_give_the_same_bits(instruction_set: str, operator: Operator) -> None:
    u = np.cumsum(np.random.default_rng(2).normal(size=200))
    here = jacobian(operator, u, "kernel")
    _engine.use_instruction_set("baseline")
    np.testing.assert_array_equal(here, jacobian(operator, u, "kernel"))


def test_unknown_derivatives_are_refused() -> None:
    chain = _engine.Chain([Stage("play", (0.5,))])
    with pytest.raises(ValueError, match="auto or kernel"):
        chain.jacobian(np.zeros(1), np.zeros(3), np.zeros((3, 1)), "own")
