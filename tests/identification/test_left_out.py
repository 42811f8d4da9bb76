"""Fits to all but some samples."""

import numpy as np
import pytest

import hyst
from hyst.identification.choice.fits_from_starts import first_fit
from hyst.identification.families.family import Family
from hyst.identification.fit.bounded_least_squares import minimize
from hyst.identification.fit.left_out import normal_equations_without, refitted
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import prepare


def overview_of(noise: float) -> Overview:
    true = hyst.PrandtlIshlinskii([0.5, 0.4, 0.3], [0.1, 0.3, 0.6], 1.0)
    time = np.arange(900) / 900.0
    u = (1.0 - 0.7 * time) * np.sin(40.0 * time)
    y = true(u) + noise * np.random.default_rng(3).standard_normal(u.size)
    return Overview(prepare(hyst.Record(u, y, dt=1e-3), "auto"), 0)


@pytest.mark.parametrize("outlying", [False, True])
def test_sums_without_a_block_are_those_of_the_other_rows(outlying: bool) -> None:
    overview = overview_of(0.01)
    fit = first_fit(hyst.families.PrandtlIshlinskii(plays=3), overview, 3)
    count = overview.input.size
    kept = np.arange(count) % 7 > 0 if outlying else None
    hidden = [np.arange(count) < count // 3, np.arange(count) % 2 == 0]
    root = np.linspace(0.5, 1.0, count)

    found = normal_equations_without(
        overview.data, fit.parametrization, fit.solution.theta, hidden, kept, root
    )

    whole = fit.problem(overview.data)
    residual, jacobian = whole.linearize(fit.solution.theta)
    for each, rows in zip(found, hidden, strict=True):
        left = ~rows if kept is None else kept & ~rows
        rest, slopes = (root * residual)[left], (root[:, None] * jacobian)[left]
        assert np.allclose(each.matrix, slopes.T @ slopes, rtol=1e-10, atol=1e-12)
        assert np.allclose(each.gradient, slopes.T @ rest, rtol=1e-10, atol=1e-12)
        assert each.cost == pytest.approx(float(rest @ rest))
        assert each.count == rest.size


@pytest.mark.parametrize(
    "family", [hyst.families.PrandtlIshlinskii(plays=3), hyst.families.Preisach(levels=8)]
)
def test_a_refit_is_the_minimum_of_what_is_left(family: Family) -> None:
    overview = overview_of(0.01)
    size = family.sizes()[0]
    fit = first_fit(family, overview, size)
    hidden = np.arange(overview.input.size) < 200
    problem = fit.problem(overview.data, ~hidden)
    normal = normal_equations_without(
        overview.data, fit.parametrization, fit.solution.theta, [hidden]
    )[0]

    theta = refitted(problem, fit.solution.theta, normal, 6)

    least = minimize(problem, fit.solution.theta, 200, 1e-9)
    variance = least.cost / normal.count
    assert problem.cost(theta) - least.cost < 0.1 * variance
