"""The Q-filters of S1 eq. 28: the formula, and filters that are none."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from hyst.control import (
    q_filter,
)
from hyst.errors import InputError

Array = np.ndarray[Any, np.dtype[Any]]


@pytest.mark.parametrize("order", [1, 2, 3, 5])
@pytest.mark.parametrize("kind", ["binomial", "butterworth", "own"])
def test_formula_of_the_paper(order: int, kind: str) -> None:
    own = {1: [2.0], 2: [1.5, 2.0], 3: [2.0, 2.5, 1.0], 5: [5.0, 11.0, 13.0, 8.0, 2.0]}[order]
    a = {
        "binomial": [float(math.comb(order, k)) for k in range(1, order + 1)],
        # Published: Butterworth polynomials.
        "butterworth": {
            1: [1.0],
            2: [math.sqrt(2.0), 1.0],
            3: [2.0, 2.0, 1.0],
            5: [3.2360680, 5.2360680, 5.2360680, 3.2360680, 1.0],
        }[order],
        "own": own,
    }[kind]
    tau, s = 3e-3, np.array([5j, 300j, 2e3j, 40.0 + 900.0j])
    for rho in range(1, order + 1):
        given: Any = own if kind == "own" else kind
        Q = q_filter(order, tau=tau, relative_degree=rho, coefficients=given)
        x = tau * s
        above = 1.0 + sum(a[k - 1] * x**k for k in range(1, order - rho + 1))
        below = 1.0 + sum(a[k - 1] * x**k for k in range(1, order + 1))
        # Published Butterworth coefficients have 8 digits.
        np.testing.assert_allclose(Q.response(s), above / below, rtol=1e-7)
        np.testing.assert_allclose(Q.system.response(s)[:, 0, 0], Q.response(s), rtol=1e-10)
        np.testing.assert_allclose(Q.as_control()(s), Q.response(s), rtol=1e-9)
        assert (Q.order, Q.relative_degree) == (order, rho)
        # 1 - Q starts with s^(m - rho + 1): a tenth of the frequency is that many decades less.
        w = np.array([1e-2, 1e-1]) / tau
        left = np.abs(1.0 - Q.response(1j * w))
        assert np.log10(left[1] / left[0]) == pytest.approx(order - rho + 1, abs=0.1)


def test_kept_zeros_are_zeros_of_the_filter() -> None:
    kept = [50.0, 20.0 + 80.0j, 20.0 - 80.0j]
    Q = q_filter(6, tau=0.01, relative_degree=2, kept_zeros=kept)
    np.testing.assert_allclose(np.abs(Q.response(np.array(kept))), 0.0, atol=1e-9)
    assert Q.response(np.zeros(1))[0] == pytest.approx(1.0, abs=1e-12)
    # One free coefficient is left, which takes the first power of s out of 1 - Q.
    left = np.abs(1.0 - Q.response(1j * np.array([1e-2, 1e-1])))
    assert left[1] / left[0] == pytest.approx(100.0, rel=1e-3)


@pytest.mark.parametrize(
    ("order", "options", "message"),
    [
        (0, {"tau": 1.0}, "order is 0"),
        (13, {"tau": 1.0}, "order is 13"),
        (2.5, {"tau": 1.0}, "order is 2.5"),
        (2, {"tau": 0.0}, "tau is 0"),
        (2, {"tau": -1.0}, "tau is -1"),
        (2, {"tau": math.nan}, "tau is nan"),
        (2, {"tau": 1.0, "relative_degree": 3}, "relative_degree is 3, above the order 2"),
        (2, {"tau": 1.0, "relative_degree": 0}, "relative_degree is 0"),
        (2, {"tau": 1.0, "coefficients": "bessel"}, "coefficients is 'bessel'; give one of"),
        (2, {"tau": 1.0, "coefficients": [1.0]}, "coefficients has 1 numbers; give 2"),
        (2, {"tau": 1.0, "coefficients": [1.0, -1.0]}, r"coefficients\[1\] is -1"),
        (3, {"tau": 1.0, "coefficients": [0.5, 0.5, 1.0]}, "make an unstable filter, pole at"),
        (2, {"tau": 1.0, "kept_zeros": [0.0]}, "a kept zero is 0, where Q must be 1"),
        (3, {"tau": 1.0, "relative_degree": 1, "kept_zeros": [1j]}, "has no conjugate"),
        (2, {"tau": 1.0, "kept_zeros": [5.0]}, "1 kept zeros and relative degree 2 need order 3"),
    ],
)
def test_filters_that_are_none(order: Any, options: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        q_filter(order, **options)
