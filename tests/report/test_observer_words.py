"""What the answer of an observer says of Q."""

from __future__ import annotations

import math

import numpy as np
import pytest

from hyst.report.observer_words import bandwidth_told, rejection_bandwidth


def test_bandwidth_of_a_second_order_filter_by_hand() -> None:
    # 1 - Q = s (s + 2 z w0) / (s^2 + 2 z w0 s + w0^2); with w0 = 1, z = sqrt(1/2) and x = w^2,
    # |1 - Q|^2 = x (x + 2) / (1 + x^2) is 1/2 at x^2 + 4 x - 1 = 0, x = sqrt(5) - 2.
    Q = np.array([1.0]), np.array([1.0, math.sqrt(2.0), 1.0])
    expected = math.sqrt(math.sqrt(5.0) - 2.0) / (2.0 * math.pi)
    # Bisection in double.
    assert rejection_bandwidth(*Q) == pytest.approx(expected, rel=1e-12)
    # In other units of time it scales along.
    fast = np.array([1e6]), np.array([1.0, 1e3 * math.sqrt(2.0), 1e6])
    assert rejection_bandwidth(*fast) == pytest.approx(1e3 * expected, rel=1e-12)
    assert bandwidth_told(*fast) == "77.33 Hz, where |1 - Q| first is 0.707"


def test_a_filter_that_never_lets_go() -> None:
    # Q = (s + 2) / (2 s + 2), so that |1 - Q| = |s / (2 s + 2)| < 1/2.
    assert rejection_bandwidth(np.array([1.0, 2.0]), np.array([2.0, 2.0])) == math.inf
    assert "at all frequencies" in bandwidth_told(np.array([1.0, 2.0]), np.array([2.0, 2.0]))
