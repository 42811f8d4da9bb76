"""The kernel's own derivative and the derivatives written by hand, held to each other.

Neither is derived from the other: one is the core's step compiled with numbers that carry tangents,
the others are formulas. Both are held to finite differences in test_jacobian.py.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from hyst import Affine, Operator, RambergOsgood
from reference.derivatives import WITHOUT_OWN, jacobian, off_their_bounds
from reference.examples import EXAMPLES

Array = NDArray[np.float64]

# What is written by hand does the very operations of the step, in its order.
SAME_OPERATIONS = {"affine", "play", "stop", "dead_zone", "direction_dead_zone", "pi"}
# The others do the same sums in another order: a rate-dependent bank gathers its plays first and
# multiplies by the rate then, a system adds the forcing by its own constant last, and any stage
# behind another one scales what comes in by one sum of slopes. A sum of twenty terms, each rounded
# to half an epsilon of the largest entry, is off by ten epsilon; feedback and further stages make
# it some more.
ROUNDINGS = 50.0 * np.finfo(np.float64).eps


def walk(samples: int = 300) -> Array:
    """A signal off every threshold, that turns at random and never rests."""
    return np.cumsum(np.random.default_rng(7).standard_normal(samples))


def kinds(operator: Operator) -> set[str]:
    return {stage.kind for stage in operator.stages()}


@pytest.mark.parametrize("operator", EXAMPLES.values(), ids=list(EXAMPLES))
def test_by_hand_and_by_kernel_agree(operator: Operator) -> None:
    u, columns = walk(), off_their_bounds(operator)
    by_hand = jacobian(operator, u, "auto")[:, columns]
    by_kernel = jacobian(operator, u, "kernel")[:, columns]
    same = len(operator.stages()) == 1 and kinds(operator) <= SAME_OPERATIONS
    bound = 0.0 if same else ROUNDINGS * np.abs(by_hand).max(initial=0.0)
    np.testing.assert_allclose(by_kernel, by_hand, rtol=0.0, atol=bound)


@pytest.mark.parametrize("kind", sorted(WITHOUT_OWN))
def test_a_kind_without_its_own_derivative_takes_the_kernels(kind: str) -> None:
    of_kind = [each for each in EXAMPLES.values() if kinds(each) == {kind}]
    assert of_kind
    for operator in of_kind:
        np.testing.assert_array_equal(
            jacobian(operator, walk(), "auto"), jacobian(operator, walk(), "kernel")
        )


def test_an_equation_solved_by_iteration_has_the_derivative_of_its_solution() -> None:
    # u with f(u) = w for f(x) = c1 x + c2 / (2 e) (2 x)^e, e = c3 + 1:  du = -f_theta / f'.
    c1, c2, c3 = 1.0, 0.5, 1.2
    w = np.linspace(0.1, 5.0, 50)
    inverse = RambergOsgood(c1, c2, c3).inverse()
    x, e = inverse(w), c3 + 1.0
    power = (2.0 * x) ** e / (2.0 * e)
    by_theta = np.stack([x, power, c2 * power * (np.log(2.0 * x) - 1.0 / e)], axis=1)
    expected = -by_theta / (c1 + c2 * (2.0 * x) ** c3)[:, None]
    # A dozen roundings, amplified by the logarithm's cancellation at most tenfold.
    np.testing.assert_allclose(jacobian(inverse, w, "kernel"), expected, rtol=3e-14)


def test_an_input_that_rests_has_its_own_derivative() -> None:
    # The step answers a rest with the output it has stored. From 0, y = f(u + offset): f'(0) = c1.
    operator = RambergOsgood(2.0, 0.5, 1.2) @ Affine(1.0, 0.0)
    by_offset = jacobian(operator, np.zeros(2), "kernel")[:, 1]
    assert by_offset.tolist() == [2.0, 2.0]
