"""Non-negative least squares ends where SciPy's active set does not."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.optimize

import hyst
from hyst.identification.fit.non_negative import non_negative


def kkt_violation(matrix: np.ndarray, target: np.ndarray, x: np.ndarray) -> float:
    """How far from the conditions of Karush, Kuhn and Tucker, in parts of the gradient's scale."""
    gradient = matrix.T @ (matrix @ x - target)
    scale = np.abs(matrix.T @ target).max()
    at_zero = np.minimum(gradient[x == 0.0], 0.0)
    return float(
        max(np.abs(gradient[x > 0.0]).max(initial=0.0), np.abs(at_zero).max(initial=0.0)) / scale
    )


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("error", [RuntimeError, np.linalg.LinAlgError])
def test_the_other_method_gives_the_same(
    seed: int, error: type[Exception], monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = np.random.default_rng(seed)
    matrix, target = rng.normal(size=(30, 8)), rng.normal(size=30)
    expected, norm = non_negative(matrix, target)
    assert kkt_violation(matrix, target, expected) < 1e-12

    def fails(*_: object, **__: object) -> None:
        raise error("Matrix is singular.")

    monkeypatch.setattr(scipy.optimize, "nnls", fails)
    found, other = non_negative(matrix, target)
    np.testing.assert_allclose(found, expected, atol=1e-9)
    assert other == pytest.approx(norm)


def test_many_equal_records_end_in_a_model() -> None:
    """A thousand records of one drive: 0.1.0 ended in an error of the solver."""
    t = np.arange(500) / 500
    u = np.sin(2.0 * np.pi * 2.5 * t)
    true = hyst.PrandtlIshlinskii([0.5, 0.3, 0.2], [0.1, 0.3, 0.5], p0=1.0)
    rng = np.random.default_rng(0)
    records = [hyst.Record(u, true(u) + 0.01 * rng.normal(size=u.size), 1e-3) for _ in range(200)]
    found = hyst.identify(records, family="pi", plays=3, delay=0)
    assert found.metrics["training"].rms == pytest.approx(0.01, rel=0.02)
