"""What operators say their constants must fulfil holds for their own."""

from __future__ import annotations

import numpy as np
import pytest

from reference.examples import EXAMPLES


@pytest.mark.parametrize("name", EXAMPLES)
def test_constants_that_can_be_inverted_fulfil_their_inequalities(name: str) -> None:
    operator = EXAMPLES[name]
    must, theta = operator.inequalities(), operator.parameters().values
    assert must.rows.shape == (must.least.size, theta.size)
    if operator.is_invertible():
        # To rounding; bounds of the least positive number count as 0.
        size = np.abs(must.rows) @ np.abs(theta)
        assert (must.rows @ theta >= must.least - 1e-12 * size - 1e-300).all()
