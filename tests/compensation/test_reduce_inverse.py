"""The best inverse with fewer plays: least bound of all, found globally."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

import hyst
from hyst.compensation import error_bound, reduce_inverse
from hyst.errors import InputError, NotInvertibleError
from hyst.models import GeneralizedPrandtlIshlinskii, ModifiedPrandtlIshlinskii
from reference.random_plays import random_map, random_plays

# S1 sec. 5.2.
PAPER = hyst.PrandtlIshlinskii(
    [0.0462, 0.069, 0.1029, 0.1535, 0.2291, 0.3417, 0.51, 0.761, 1.1, 1.7],
    np.arange(4.0, 41.0, 4.0),
    0.1,
)


def least_of_all_grids(exact: hyst.PrandtlIshlinskii, plays: int, y_max: float) -> float:
    """Exhaustive: every choice of thresholds on a fine grid, least absolute deviation on each run.

    Thresholds of the inverse are multiples of the grid, so that each cell has one value of phi and
    the least sum of absolute deviations on a run is the one from the median of its cells.
    """
    cell = 0.125
    middles = np.arange(0.5 * cell, y_max, cell)
    phi = exact.p0 + (middles[:, None] > exact.r) @ exact.p
    n = middles.size
    cost = np.zeros((n + 1, n + 1))
    for i, j in itertools.combinations(range(n + 1), 2):
        run = phi[i:j]
        cost[i, j] = cell * np.abs(run - np.median(run)).sum()
    cuts = itertools.combinations(range(1, n), plays)
    return min(sum(cost[a, b] for a, b in itertools.pairwise((0, *each, n))) for each in cuts)


@pytest.mark.parametrize("plays", [0, 1, 2, 3])
@pytest.mark.parametrize("seed", range(4))
def test_no_other_choice_is_better(plays: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    # Every other case falls throughout, as with positive weights: it takes another way.
    levels = rng.uniform(0.2, 3.0, 6)
    levels = -np.sort(-levels) if seed % 2 else levels
    starts = 0.125 * np.sort(rng.choice(np.arange(1, 24), 5, replace=False))
    exact = hyst.PrandtlIshlinskii(np.diff(levels), starts, float(levels[0]))
    model = exact.inverse()
    reduced = reduce_inverse(model, plays, 3.0)
    limit = error_bound(model, reduced, 3.0)
    assert len(reduced.parameters()) <= 1 + 2 * plays
    # Thresholds of the model and back, rounded.
    assert limit.bound == pytest.approx(least_of_all_grids(exact, plays, 3.0), abs=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_small_changes_of_thresholds_and_weights_do_not_improve_it(seed: int) -> None:
    rng = np.random.default_rng(seed)
    model = random_plays(rng, 8)
    reduced = reduce_inverse(model, 3, 9.0)
    least = error_bound(model, reduced, 9.0).bound
    theta = reduced.parameters().values
    for scale in np.repeat([1e-3, 1e-1, 1.0], 40):
        other = theta + scale * rng.normal(size=theta.size)
        other[4:] = np.sort(np.abs(other[4:]))
        assert error_bound(model, reduced.with_parameters(other), 9.0).bound >= least - 1e-12


@pytest.mark.parametrize("plays", [1, 2, 4, 6, 8])
def test_it_beats_leaving_plays_out_and_least_squares(plays: int) -> None:
    exact, y_max = PAPER.inverse(), 43.0
    best = error_bound(PAPER, reduce_inverse(PAPER, plays, y_max), y_max).bound
    left_out = hyst.PrandtlIshlinskii(exact.p[:plays], exact.r[:plays], exact.p0)
    r = np.linspace(0.0, y_max, plays + 2)[1:-1]
    u = np.linspace(0.0, y_max, 500)
    columns = np.column_stack([u, np.maximum(u[:, None] - r, 0.0)])
    weights = np.linalg.lstsq(columns, exact(u), rcond=None)[0]
    fitted = hyst.PrandtlIshlinskii(weights[1:], r, float(weights[0]))
    assert best < error_bound(PAPER, left_out, y_max).bound
    assert best < error_bound(PAPER, fitted, y_max).bound


def test_the_result_rises_and_runs() -> None:
    for plays in range(11):
        reduced = reduce_inverse(PAPER, plays, 43.0)
        assert reduced.is_invertible()
        assert reduced.traits().monotone


def test_enough_plays_leave_nothing() -> None:
    reduced = reduce_inverse(PAPER, 10, 43.0)
    assert error_bound(PAPER, reduced, 43.0).bound == 0.0
    # Thresholds of the inverse below 15 are 8, so the other two never move.
    assert len(reduce_inverse(PAPER, 10, 15.0).parameters()) == 1 + 2 * 7


@pytest.mark.parametrize("kind", [GeneralizedPrandtlIshlinskii, ModifiedPrandtlIshlinskii])
def test_maps_stay_exact(kind: type[hyst.Operator]) -> None:
    rng = np.random.default_rng(5)
    bend, plays = random_map(rng), random_plays(rng, 6)
    model = kind(*((bend, plays) if kind is GeneralizedPrandtlIshlinskii else (plays, bend)))
    bounds = [error_bound(model, reduce_inverse(model, k, 6.0), 6.0) for k in range(7)]
    assert [each.envelope_error for each in bounds] == [0.0] * 7
    assert [each.map_error for each in bounds] == [0.0] * 7
    plays_errors = [each.plays_error for each in bounds]
    assert plays_errors == sorted(plays_errors, reverse=True)
    assert bounds[-1].bound == pytest.approx(0.0, abs=1e-13)


@pytest.mark.parametrize("plays", [-1, 1.5, True, "3"])
def test_refusals_of_the_number_of_plays(plays: int) -> None:
    with pytest.raises(InputError, match="plays is"):
        reduce_inverse(PAPER, plays, 1.0)


def test_other_refusals() -> None:
    with pytest.raises(InputError, match="y_max is 0"):
        reduce_inverse(PAPER, 1, 0.0)
    with pytest.raises(InputError, match="y_max"):
        reduce_inverse(PAPER, 1, float("nan"))
    with pytest.raises(NotInvertibleError, match="p0 is -1"):
        reduce_inverse(hyst.PrandtlIshlinskii([2.0], [1.0], -1.0), 1, 1.0)


def test_it_is_the_same_either_way() -> None:
    """The order of levels that rise throughout is known; a dip of no width forces a search."""
    levels = np.array([3.0, 2.0, 1.5, 1.1, 0.4])
    exact = hyst.PrandtlIshlinskii(np.diff(levels), [0.3, 0.9, 1.4, 2.0], 3.0)
    dip = hyst.PrandtlIshlinskii(
        [-1.0, -0.5, -0.9, 0.5, -0.7], [0.3, 0.9, 1.4, np.nextafter(1.4, 2.0), 2.0], 3.0
    )
    for plays in range(4):
        plain = reduce_inverse(exact.inverse(), plays, 2.5)
        dipped = reduce_inverse(dip.inverse(), plays, 2.5)
        assert error_bound(exact.inverse(), plain, 2.5).bound == pytest.approx(
            error_bound(dip.inverse(), dipped, 2.5).bound, abs=1e-12
        )
