"""What records do not determine is projected out; the rest keeps its standard error."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_records import drive

import hyst
from hyst.identification.fit.block import blocks_of
from hyst.identification.result.covariance import ScoreSums
from hyst.identification.result.standard_errors import Spread, spread_of_estimates

SAMPLES = 4000


def regressors(seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    return rng.normal(size=(SAMPLES, 2)), 0.1 * rng.normal(size=SAMPLES)


def spread_of(
    jacobian: np.ndarray, residual: np.ndarray, theta: np.ndarray, gauges: np.ndarray | None = None
) -> Spread:
    blocks = blocks_of(jacobian, [SAMPLES])
    sums = ScoreSums.of(lambda: blocks, residual, [SAMPLES])
    return spread_of_estimates(sums, theta, gauges)


def test_columns_that_say_something_have_the_textbook_errors() -> None:
    matrix, noise = regressors(0)
    spread = spread_of(matrix * [1.0, 1e6], noise, np.array([1.0, 1e-6]))
    expected = 0.1 * np.sqrt(np.diag(np.linalg.inv(matrix.T @ matrix))) * [1.0, 1e-6]
    # 4000 samples know a standard deviation to about 1 %, the Bartlett window adds a few percent.
    np.testing.assert_allclose(spread.of(np.eye(2)), expected, rtol=0.1)
    assert spread.open_directions.shape == (2, 0)


def test_two_equal_columns_leave_their_sum_determined() -> None:
    matrix, noise = regressors(1)
    a, b = matrix.T
    jacobian = np.column_stack([a, b, a])
    spread = spread_of(jacobian, noise, np.ones(3))
    errors = spread.of(np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1]], dtype=float))
    assert np.isnan(errors[[0, 2]]).all()
    reduced = spread_of(matrix, noise, np.ones(2)).of(np.eye(2))
    np.testing.assert_allclose(errors[[3, 1]], reduced, rtol=1e-3)
    np.testing.assert_array_equal(np.flatnonzero(spread.disturbed(np.eye(3))[:, 0]), [0, 2])


def test_a_gauge_determines_what_the_records_do_not() -> None:
    """Of two equal columns the records know the sum; a gauge that holds the difference, halves."""
    matrix, noise = regressors(1)
    a, b = matrix.T
    jacobian, gauge = np.column_stack([a, b, a]), np.array([[1.0, 0.0, -1.0]])
    spread = spread_of(jacobian, noise, np.ones(3), gauge)
    assert spread.open_directions.shape == (3, 0)
    reduced = spread_of(matrix, noise, np.ones(2)).of(np.eye(2))
    expected = [reduced[0] / 2.0, reduced[1], reduced[0] / 2.0]
    # One free parameter less in N - m, and nothing else.
    np.testing.assert_allclose(spread.of(np.eye(3)), expected, rtol=1e-3)
    held = spread.of(np.array([[1.0, 0.0, -1.0]]))
    assert held[0] < 1e-9 * reduced[0]


def test_a_column_of_zeros_is_named_alone() -> None:
    matrix, noise = regressors(2)
    jacobian = np.column_stack([matrix[:, 0], np.zeros(SAMPLES)])
    spread = spread_of(jacobian, noise, np.ones(2))
    errors = spread.of(np.eye(2))
    assert np.isfinite(errors[0])
    assert np.isnan(errors[1])
    np.testing.assert_array_equal(spread.disturbed(np.eye(2)), [[False], [True]])


def test_a_direction_less_sure_than_the_model_is_large_is_not_determined() -> None:
    """Two columns that differ by a millionth of the noise: formally determined, in truth not."""
    matrix, noise = regressors(3)
    a, b = matrix.T
    jacobian = np.column_stack([a, a + 1e-5 * b])
    spread = spread_of(jacobian, noise, np.ones(2))
    errors = spread.of(np.array([[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]))
    assert np.isnan(errors[:2]).all()
    assert errors[2] == pytest.approx(0.1 / np.linalg.norm(a), rel=0.1)


def test_units_change_nothing_but_the_unit() -> None:
    matrix, noise = regressors(4)
    jacobian = np.column_stack([matrix, matrix[:, 0]])
    plain = spread_of(jacobian, noise, np.ones(3)).of(np.eye(3))
    scales = 2.0 ** np.array([40.0, -30.0, 7.0])
    scaled = spread_of(jacobian * scales, noise, 1.0 / scales).of(np.eye(3))
    np.testing.assert_array_equal(scaled, plain / scales)


def test_plays_that_cannot_be_told_apart_leave_p0_its_scatter() -> None:
    """Pairs of nearly equal radii: 0.1.0 stated an error of p0 6.7 times too small."""
    radii = [0.2, 0.200001, 0.4, 0.400001]
    true = hyst.PrandtlIshlinskii([0.3, 0.2, 0.2, 0.1], radii, p0=1.0)
    u = drive(2000)
    fits = []
    for seed in range(40):
        noise = 0.02 * np.random.default_rng(seed).normal(size=u.size)
        given = hyst.Record(u, true(u) + noise, 1e-3)
        fits.append(hyst.identify(given, family="pi", radii=radii, delay=0, weights="non-negative"))
    names = fits[0].parameter_names
    p0 = names.index("prandtl_ishlinskii.p0")
    scatter = np.std([fit.parameter_values[p0] for fit in fits], ddof=1)
    stated = np.sqrt(np.mean([fit.standard_errors[p0] ** 2 for fit in fits]))
    # 40 draws know a standard deviation to 11 %; three of those.
    assert 0.7 < scatter / stated < 1.35
    assert all(np.isnan(fit.standard_errors[1:5]).all() for fit in fits)
    assert any("do not tell apart" in sentence for sentence in fits[0].undetermined)


@pytest.mark.parametrize("delay", [0, "auto"])
def test_told_errors_of_plays_are_what_the_estimates_scatter_by(delay: int | str) -> None:
    """Weights, radii and offset, of records whose noise alone differs.

    20 runs know a scatter to 16 %. An estimated delay may be wrong, which what is told counts: that
    of the weight without memory, which resembles a delay, is half as much again.
    """
    truth = hyst.PrandtlIshlinskii([0.5, 0.3], [0.15, 0.5], 1.0)
    u = drive(1000)
    clean, values, told = truth(u), [], []
    for seed in range(20):
        y = clean + 0.01 * np.random.default_rng(seed).standard_normal(u.size)
        record = hyst.Record(u, y, 1e-3)
        found = hyst.identify(record, family="pi", plays=2, delay=delay, creep=None)
        values.append(found.parameter_values)
        told.append(found.standard_errors)
    ratio = np.median(told, axis=0) / np.std(values, axis=0, ddof=1)
    assert ratio.min() > 0.6
    assert ratio.max() < (1.6 if delay == 0 else 2.2)
