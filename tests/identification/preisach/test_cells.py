"""Cells of a grid: their order, areas, middles and the slopes of densities on them."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.optimize

import hyst
from hyst.identification.families.preisach.cells import Cells, adapted_cells, even_cells
from hyst.identification.fit.bounded_quadratic import least_within
from hyst.identification.reversal_curve_fit import everett_shares

UNEVEN = Cells(np.array([-1.0, -0.5, 0.25, 2.0]))


def test_areas_of_all_cells_are_the_half_plane() -> None:
    # A triangle of the range over the square of the range.
    assert UNEVEN.areas().sum() == pytest.approx(0.5, rel=1e-15)


def test_cells_are_in_the_order_of_the_model() -> None:
    weights = np.tril(np.arange(9.0).reshape(3, 3))
    model = hyst.Preisach(weights, UNEVEN.thresholds)
    np.testing.assert_array_equal(weights[UNEVEN.places], model.parameters().values[1:])


def test_the_middle_of_a_triangle_is_its_centroid() -> None:
    alpha, beta = even_cells(0.0, 3.0, 3).centres()
    # Cells (0, 0), (1, 0), (1, 1), ...
    np.testing.assert_allclose(alpha[:3], [2.0 / 3.0, 1.5, 5.0 / 3.0], rtol=1e-15)
    np.testing.assert_allclose(beta[:3], [1.0 / 3.0, 0.5, 4.0 / 3.0], rtol=1e-15)


@pytest.mark.parametrize("cells", [UNEVEN, even_cells(-2.0, 1.0, 7)])
def test_an_even_density_has_no_slope(cells: Cells) -> None:
    # Densities of about 1 and slopes of at most 10 times that: rounding.
    np.testing.assert_allclose(cells.differences() @ cells.areas(), 0.0, atol=1e-13)


@pytest.mark.parametrize("levels", [12, 24, 48])
def test_slopes_do_not_depend_on_the_grid(levels: int) -> None:
    """Density 2 (1 + alpha), thresholds from 0 to 1: the integral of 2^2 over the triangle is 2.

    In units in which a density of 1 has a mass of 1 it is half of that, so the square a fourth.
    """
    cells = even_cells(0.0, 1.0, levels)
    alpha, _ = cells.centres()
    squares = np.sum(np.square(cells.differences() @ (2.0 * (1.0 + alpha) * cells.areas())))
    # Triangles whose middles are off the grid and the rim count for a share of 1 / levels.
    assert squares == pytest.approx(0.5, rel=3.0 / levels)


def test_adapted_cells_are_narrow_where_the_mass_is() -> None:
    """All mass in cell (3, 0) of 4: half of 8 levels even, one a unit, half in the outer two."""
    cells = even_cells(0.0, 4.0, 4)
    weights = np.zeros(cells.count)
    weights[6] = 2.0  # row 3 begins with entry 6
    found = adapted_cells(cells, weights, 8).thresholds
    # Shares of the four units: 1/8 + 1/4, 1/8, 1/8, 1/8 + 1/4, in steps of 1/8.
    expected = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0, 2.0, 3.0, 10.0 / 3.0, 11.0 / 3.0, 4.0]
    np.testing.assert_allclose(found, expected, atol=1e-14)


def test_shares_between_thresholds_are_what_the_model_moves_by() -> None:
    """From saturation down to beta and up to alpha: twice the mass between."""
    weights = np.tril(np.random.default_rng(1).random((3, 3)))
    model = hyst.Preisach(weights, UNEVEN.thresholds)
    for beta, alpha in [(-0.8, 1.4), (0.1, 0.2), (-0.6, -0.55), (-1.0, 2.0), (0.3, 1.9)]:
        _, low, high = model([3.0, beta, alpha])
        shares = everett_shares(UNEVEN, np.array([alpha]), np.array([beta]))[0]
        assert 2.0 * shares @ weights[UNEVEN.places] == pytest.approx(high - low, abs=1e-13)


@pytest.mark.parametrize("seed", range(8))
def test_the_bounded_quadratic_meets_its_conditions(seed: int) -> None:
    """Karush, Kuhn and Tucker's conditions: for a convex problem they are enough."""
    rng = np.random.default_rng(seed)
    matrix, target = rng.normal(size=(60, 40)), rng.normal(size=60)
    lower, upper = np.full(40, -0.05), np.full(40, np.inf)
    lower[:3], upper[5:9] = -np.inf, 0.1
    normal, moment = matrix.T @ matrix, matrix.T @ target
    x = least_within(normal, moment, lower, upper, np.zeros(40))
    gradient = normal @ x - moment
    inside = (x > lower) & (x < upper)
    # The ridge of 1e-12 leaves a gradient of that share of the matrix's entries, about 60.
    assert np.abs(gradient[inside]).max() < 1e-9
    assert gradient[x == lower].min(initial=0.0) > -1e-9
    assert gradient[x == upper].max(initial=0.0) < 1e-9
    assert (x >= lower).all()
    assert (x <= upper).all()
    assert 0 < inside.sum() < 40


@pytest.mark.parametrize("seed", range(4))
def test_a_matrix_that_determines_little_still_ends_at_the_least(seed: int) -> None:
    """Columns that repeat others to rounding: many solutions, one least residual."""
    rng = np.random.default_rng(seed)
    few = np.abs(rng.normal(size=(60, 25)))
    columns = few @ np.abs(rng.normal(size=(25, 150)))
    columns = np.hstack([columns, columns * (1.0 + 1e-13 * rng.normal(size=columns.shape))])
    y = columns @ np.maximum(rng.normal(size=300), 0.0) + rng.normal(size=60)
    lower, upper = np.zeros(300), np.full(300, np.inf)
    x = least_within(columns.T @ columns, columns.T @ y, lower, upper, lower)
    least = scipy.optimize.nnls(columns, y)[1]
    # Both are residuals of matrices known to 1e-13 whose condition is beyond 1e12.
    assert np.linalg.norm(columns @ x - y) <= least * (1.0 + 1e-4)
    assert (x >= 0.0).all()
